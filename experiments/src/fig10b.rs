//! The paper's Figure 10b: driving round a loop of T-intersections with right turns only, in more and more fog.
//!
//! Networks that were taught without fog drive until they run into something, or for 200 s. The study also notes when a
//! network left its way or stood still for too long, because it may do either without a collision, and how it steers in
//! low, medium and high fog.

use crate::cloning::{LOOP, driven};
use crate::{Done, print, scenario, write};
use indicatif::ProgressBar;
use paracosm::Study;
use paracosm::campaign::{Problem, Worker};
use paracosm::oracles::{Trace, Verdict};
use paracosm::space::{Value, Values};
use rayon::prelude::*;
use std::path::Path;
use std::sync::Arc;
use thiserror::Error;

/// The number of tests, from no fog to the thickest fog.
const TESTS: usize = 21;
/// Seconds after which a test is over.
const TIME_OUT: f64 = 200.0;
/// The fogs for which the steering is written: none, low, medium and high.
const SHOWN: [f64; 4] = [0.0, 0.2, 0.35, 0.8];
/// The number of seconds for which the steering is written.
const SECONDS: f64 = 20.0;
/// The speed of the car in m/s.
const SPEED: f64 = 8.0;
/// The number of ticks between two lines of the table of steering.
const STRIDE: usize = 10;
/// The distance in metres that the car may be off its way, as in the scenario.
const OFF: f64 = 2.0;
/// The seconds that the car may stand still, as in the scenario.
const STANDING: f64 = 10.0;

/// The result of a test in fog.
struct Drive {
    fog: f64,
    verdict: Verdict,
    /// The time until the car collided, in seconds. `departure` is the time until the car left its way, `standstill`
    /// until the car had stood still for too long. Each is the time-out if the event never occurred.
    collision: f64,
    departure: f64,
    standstill: f64,
    travelled: f64,
    /// The time, the steering and the speed.
    steering: Vec<[f64; 3]>,
}

/// The reason why a test has no result.
#[derive(Debug, Error)]
enum Undriven {
    /// No worker could be made to run the test.
    #[error(transparent)]
    Worker(Arc<paracosm::Error>),
    /// The test gave no trace (record of its signals).
    #[error("{}", .0.as_ref().map_or("", |problem| &problem.message))]
    Test(Option<Problem>),
}

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let header = "seed,fog,verdict,seconds_to_collision,seconds_to_departure,seconds_to_standstill,travelled";
    let mut rows = vec![header.to_owned()];
    let mut over_time = vec!["seed,fog,time,steering,speed".to_owned()];
    for (seed, network) in LOOP.networks() {
        let study =
            driven(scenario("t-loop")?, network).open("fog").fix("speed", SPEED).fix("friction", 0.8).build()?;
        for Drive { fog, verdict, collision, departure, standstill, travelled, steering } in drives(&study, bar)? {
            rows.push(format!("{seed},{fog},{verdict},{collision:.2},{departure:.2},{standstill:.2},{travelled:.1}"));
            let early = steering.iter().filter(|[time, ..]| *time <= SECONDS && shown(fog));
            over_time
                .extend(early.map(|[time, turned, speed]| format!("{seed},{fog},{time:.2},{turned:.4},{speed:.3}")));
        }
    }
    bar.finish_and_clear();
    let table = rows.join("\n") + "\n";
    write(&out.join("fig10b.csv"), &table)?;
    write(&out.join("fig10b-steering.csv"), over_time.join("\n") + "\n")?;
    print(&table)
}

/// Drives in each density of fog.
fn drives(study: &Study, bar: &ProgressBar) -> Result<Vec<Drive>, Undriven> {
    let driving = (0..TESTS).into_par_iter().map_init(
        || Worker::new(study).map_err(Arc::new),
        |worker, i| {
            let worker = worker.as_mut().map_err(|error| Undriven::Worker(Arc::clone(error)))?;
            let drive = drive(worker, i, i as f64 / (TESTS - 1) as f64);
            bar.inc(1);
            drive
        },
    );
    driving.collect()
}

fn shown(fog: f64) -> bool {
    SHOWN.iter().any(|shown| (shown - fog).abs() < 1e-9)
}

fn drive(worker: &mut Worker<'_>, index: usize, fog: f64) -> Result<Drive, Undriven> {
    let test: Values = [("fog".to_owned(), Value::Number(fog))].into_iter().collect();
    let (trial, trace) = worker.run(index, &test);
    let trace = trace.ok_or_else(|| Undriven::Test(trial.problem.clone()))?;
    let signal = |name: &str| -> Vec<f64> { trace.signal(name).into_iter().flatten().collect() };
    let first = |name: &str, above: f64| {
        let tick = signal(name).iter().position(|value| *value > above);
        tick.map_or(TIME_OUT, |tick| time(&trace, tick))
    };
    let (departure, standstill) = (first("abs(car.way_offset)", OFF), first("car.standing_time", STANDING));
    let collision = if trial.violates("no-collision") { time(&trace, trial.ticks) } else { TIME_OUT };
    let steering = signal("car.steering").into_iter().zip(signal("car.speed")).enumerate().step_by(STRIDE);
    let steering = steering.map(|(tick, (turned, speed))| [time(&trace, tick), turned, speed]).collect();
    let travelled = signal("car.travelled").last().copied().unwrap_or(f64::NAN);
    Ok(Drive { fog, verdict: trial.verdict, collision, departure, standstill, travelled, steering })
}

fn time(trace: &Trace, tick: usize) -> f64 {
    tick as f64 * trace.dt()
}
