//! Examines networks, all seeds of a course, in tests of the conditions that they were trained in. No lesson came from these tests.
//!
//! The tests are also run with the expert who taught the network, and with `cruise`, which knows the true position of
//! its lane, keeps in it, and never brakes for anybody. If `cruise` passes as well, a pass says nothing about a
//! network's braking.

use super::{Course, FOLLOW, LOOP, STOP, driven, trials};
use crate::sampling::write_csv;
use crate::{Done, print};
use indicatif::ProgressBar;
use paracosm::oracles::Verdict;
use paracosm::{StudyBuilder, Trial};
use std::path::Path;

/// The number of tests in an examination.
pub const EXAMINED: usize = 100;

/// The seed of the examination's tests, which no round of a course uses.
const SEED: u64 = 1000;

/// The drivers with which the network is compared.
const OTHERS: [&str; 2] = ["expert", "cruise"];

/// Returns the study with the tests of a course's examination.
pub fn tests(course: &Course) -> Result<StudyBuilder, paracosm::Error> {
    course.study(SEED, EXAMINED)
}

/// Returns the number of tests that pass.
pub fn passing(trials: &[Trial]) -> usize {
    trials.iter().filter(|trial| trial.verdict == Verdict::Pass).count()
}

/// Examines the networks that come with the software, and writes a table for each network to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let mut text = format!("{:<12}{:<12}passes of {EXAMINED} tests\n", "course", "driver");
    for course in [&FOLLOW, &STOP, &LOOP] {
        let mut examined = Vec::new();
        for (seed, network) in course.networks() {
            examined.push(("cnn", seed.to_string(), trials(&driven(tests(course)?, network).build()?, bar)?));
        }
        for name in OTHERS {
            examined.push((name, String::new(), trials(&tests(course)?.driver(name).build()?, bar)?));
        }
        table(&out.join(format!("exam-{}.csv", course.name)), &examined)?;
        for (driver, seed, trials) in &examined {
            text += &format!("{:<12}{:<12}{}\n", course.name, format!("{driver} {seed}"), passing(trials));
        }
    }
    bar.finish_and_clear();
    print(&text)
}

/// Writes a table with a row for each test of each driver. Networks have seeds.
fn table(path: &Path, examined: &[(&str, String, Vec<Trial>)]) -> Done {
    let parameters = examined[0].2[0].test.iter().map(|(name, _)| name.to_string());
    let columns = ["driver", "seed", "verdict", "violated", "travelled"].map(str::to_owned);
    let mut rows = vec![parameters.chain(columns).collect()];
    for (driver, seed, trials) in examined {
        rows.extend(trials.iter().map(|trial| {
            let violated: Vec<&str> = trial.violated().collect();
            let travelled = trial.measured.as_ref().map(|measured| measured.travelled.to_string()).unwrap_or_default();
            let became = [(*driver).to_owned(), seed.clone(), trial.verdict.to_string(), violated.join(" "), travelled];
            trial.test.iter().map(|(_, value)| value.to_string()).chain(became).collect()
        }));
    }
    write_csv(path, &rows)
}
