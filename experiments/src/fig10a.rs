//! The paper's Figure 10a: a network that was taught to follow a slow leader in broad daylight drives in fog and at
//! other light.
//!
//! In the paper, the shade is the distance that the car covers in 15 s, and a cross is a collision. Here a cross is a
//! test that violates any requirement, and the table says which requirement. The leader is slow and steady, so that the
//! tests differ only in what the network sees.

use crate::cloning::exam::{self, EXAMINED};
use crate::cloning::{FOLLOW, trials};
use crate::{Done, logged, print, scenario, write};
use indicatif::ProgressBar;
use paracosm::Trial;
use paracosm::space::Value;
use std::path::Path;

/// The number of tests over fog and light.
const TESTS: usize = 200;
/// The speed of the leader in m/s.
const LEADER: f64 = 6.0;

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let passed = exam::passing(&trials(&FOLLOW.drives(exam::tests(&FOLLOW)?).build()?, bar)?);

    let study = FOLLOW.drives(scenario("follow-leader")?).open("fog").open("light");
    let study = study.fix("leader_speed", LEADER).budget(TESTS).build()?;
    let log = logged(&study, bar)?;
    let trials = log.trials();
    bar.finish_and_clear();
    let collided: Vec<bool> = trials.iter().map(|trial| trial.violates("no-collision")).collect();
    let covered: Vec<f64> = trials.iter().map(travelled).collect();

    let mut rows = vec!["fog,light,travelled,collided,verdict,violated".to_owned()];
    for ((trial, covered), collided) in trials.iter().zip(&covered).zip(&collided) {
        let [fog, light] = ["fog", "light"].map(|name| number(trial, name));
        let violated: Vec<&str> = trial.requirements().filter(|id| trial.violates(id)).collect();
        rows.push(format!("{fog},{light},{covered},{collided},{},{}", trial.verdict, violated.join(" ")));
    }
    write(&out.join("fig10a.csv"), rows.join("\n") + "\n")?;
    let mut text = format!("training conditions: {passed} of {EXAMINED} pass\n");
    text += &format!("{:<26}{:>6}{:>12}{:>16}\n", "tests", "", "collisions", "mean distance");
    for (name, of) in REGIONS {
        let within: Vec<usize> =
            (0..trials.len()).filter(|&i| of(number(&trials[i], "fog"), number(&trials[i], "light"))).collect();
        let crashes = within.iter().filter(|i| collided[**i]).count();
        let mean = within.iter().map(|i| covered[*i]).sum::<f64>() / within.len() as f64;
        text += &format!("{name:<26}{:>6}{crashes:>12}{mean:>14.1} m\n", within.len());
    }
    print(&text)
}

/// A part of the tests: the name of the part, and a function that says whether a fog and a light belong to it.
type Region = (&'static str, fn(f64, f64) -> bool);

const REGIONS: [Region; 5] = [
    ("light >= 0.8, fog < 0.2", |fog, light| light >= 0.8 && fog < 0.2),
    ("light >= 0.8, fog >= 0.6", |fog, light| light >= 0.8 && fog >= 0.6),
    ("light < 0.5, fog < 0.2", |fog, light| light < 0.5 && fog < 0.2),
    ("fog >= 0.6", |fog, _| fog >= 0.6),
    ("all", |_, _| true),
];

fn number(trial: &Trial, name: &str) -> f64 {
    trial.test.get(name).and_then(Value::number).expect("the study varies it")
}

/// Returns the distance that the car covered, in metres.
fn travelled(trial: &Trial) -> f64 {
    trial.measured.as_ref().map_or(f64::NAN, |measured| measured.travelled)
}
