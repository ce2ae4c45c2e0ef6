//! The paper's Figure 10b: round a loop of T-intersections, always right, in more and more fog.
//!
//! A network that was taught without fog drives until it runs into something, or for 200 s. Below the time to that stands
//! how it steers in low, medium and high fog.

use crate::cloning::LOOP;
use crate::{Done, print, write};
use indicatif::ProgressBar;
use paracosm::coverage::{Value, Values};
use paracosm::{Axis, Lines, Picture, Study, Trial, Worker};
use std::path::Path;

/// So many tests, from no fog to the thickest.
const TESTS: usize = 21;
/// Seconds after which a test is over.
const TIME_OUT: f64 = 200.0;
/// The fogs whose steering is shown.
const SHOWN: [(&str, f64); 4] = [("no fog", 0.0), ("low, 0.3", 0.3), ("medium, 0.6", 0.6), ("high, 0.8", 0.8)];
/// How many seconds of it.
const SECONDS: f64 = 40.0;
/// The speed in m/s.
const SPEED: f64 = 8.0;

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let study = LOOP.drives(Study::of("t-loop")?)?.open("fog", None)?;
    let study = study.set("speed", Value::Number(SPEED))?.set("friction", Value::Number(0.8))?;
    let fogs: Vec<f64> = (0..TESTS).map(|i| i as f64 / (TESTS - 1) as f64).collect();
    let test = |fog: f64| -> Values { [("fog".to_owned(), Value::Number(fog))].into_iter().collect() };
    let tests: Vec<Values> = fogs.iter().map(|fog| test(*fog)).collect();
    bar.set_length((TESTS + SHOWN.len()) as u64);
    let mut trials: Vec<Trial> = Vec::new();
    paracosm::Campaign::new(&study)?.run_tests(&tests, 0, |trial| {
        bar.inc(1);
        trials.push(trial.clone());
        Ok(())
    })?;
    let dt = study.subject.scenario()?.dt();
    let time = |trial: &Trial| if trial.violates("no-collision") { trial.ticks as f64 * dt } else { TIME_OUT };
    let times: Vec<(f64, f64)> = fogs.iter().zip(&trials).map(|(fog, trial)| (*fog, time(trial))).collect();

    let mut worker = Worker::new(&study)?;
    let mut curves = Vec::new();
    let mut steering = vec!["fog,time,steering,speed".to_owned()];
    for (name, fog) in SHOWN {
        let (trial, trace) = worker.run(0, &test(fog));
        bar.inc(1);
        let trace = trace.ok_or_else(|| trial.error.clone().unwrap_or_default())?;
        let signal = |name: &str| -> Vec<f64> { trace.signal(name).into_iter().flatten().step_by(10).collect() };
        let time = |i: usize| 10.0 * i as f64 * trace.dt();
        let points: Vec<(f64, f64)> =
            signal("car.steering").into_iter().enumerate().map(|(i, turned)| (time(i), turned)).collect();
        for ((at, turned), speed) in points.iter().zip(signal("car.speed")) {
            steering.push(format!("{fog},{at:.2},{turned},{speed}"));
        }
        curves.push((name.to_owned(), points.into_iter().filter(|point| point.0 <= SECONDS).collect()));
    }
    bar.finish_and_clear();

    let axis = |label: &str, range| Axis { label: label.to_owned(), range };
    let above = Lines {
        title: "Figure 10b: round the loop in fog".to_owned(),
        note: format!("until the first collision, or {TIME_OUT} s; trained without fog"),
        x: axis("fog", (0.0, 1.0)),
        y: axis("time to the first collision [s]", (0.0, TIME_OUT)),
        curves: vec![("the cloned driver".to_owned(), times.clone())],
    };
    let below = Lines {
        title: "How it steers".to_owned(),
        note: "share of the wheels' full turn, positive to the left; a curve ends where the car runs into something"
            .to_owned(),
        x: axis("time [s]", (0.0, SECONDS)),
        y: axis("steering", (-1.0, 1.0)),
        curves,
    };
    let picture = Picture::of_lines(vec![above, below]);
    write(&out.join("fig10b.svg"), picture.svg()?)?;
    write(&out.join("fig10b.png"), picture.png()?)?;
    let mut table = vec!["fog,seconds_to_collision,collided,travelled".to_owned()];
    for ((fog, seconds), trial) in times.iter().zip(&trials) {
        let travelled = trial.metric("travelled").map_or_else(String::new, ToString::to_string);
        table.push(format!("{fog},{seconds},{},{travelled}", trial.violates("no-collision")));
    }
    let table = table.join("\n") + "\n";
    write(&out.join("fig10b.csv"), &table)?;
    write(&out.join("steering.csv"), steering.join("\n") + "\n")?;
    print(&table)
}
