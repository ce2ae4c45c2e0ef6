//! The paper's Figure 10a: networks that were taught to follow a slow leader in broad daylight drive in fog and at other
//! light.
//!
//! In the paper, the shade is the distance that the car covers in 15 s, and a cross is a collision. Here a cross is a
//! test that violates any requirement, and the table says which requirement. The leader is slow and steady, so that the
//! tests differ only in what the networks see.

use crate::cloning::{FOLLOW, driven};
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
    let mut rows = vec!["seed,fog,light,travelled,collided,verdict,violated".to_owned()];
    let mut text = format!("{:<8}{:>8}{:>12}  of {TESTS} tests\n", "seed", "fail", "collide");
    for (seed, network) in FOLLOW.networks() {
        let study = driven(scenario("follow-leader")?, network).open("fog").open("light");
        let log = logged(&study.fix("leader_speed", LEADER).budget(TESTS).build()?, bar)?;
        for trial in log.trials() {
            let [fog, light] = ["fog", "light"].map(|name| number(trial, name));
            let (covered, collided) = (travelled(trial), trial.violates("no-collision"));
            let violated: Vec<&str> = trial.violated().collect();
            rows.push(format!("{seed},{fog},{light},{covered},{collided},{},{}", trial.verdict, violated.join(" ")));
        }
        let count = |of: fn(&Trial) -> bool| log.trials().iter().filter(|trial| of(trial)).count();
        let (failing, collided) = (count(Trial::is_failure), count(|trial| trial.violates("no-collision")));
        text += &format!("{seed:<8}{failing:>8}{collided:>12}\n");
    }
    bar.finish_and_clear();
    write(&out.join("fig10a.csv"), rows.join("\n") + "\n")?;
    print(&text)
}

fn number(trial: &Trial, name: &str) -> f64 {
    trial.test.get(name).and_then(Value::number).expect("the study varies it")
}

/// Returns the distance that the car covered, in metres.
fn travelled(trial: &Trial) -> f64 {
    trial.measured.as_ref().map_or(f64::NAN, |measured| measured.travelled)
}
