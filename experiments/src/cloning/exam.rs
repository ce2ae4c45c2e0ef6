//! Examinations: what networks do in tests of the conditions that they were trained in, none of which a lesson was from.
//!
//! Beside each stands the expert who taught it, and `cruise`, who keeps its lane, told the truth about it, and brakes for
//! nobody: where the latter passes as well, passing proves nothing of a network's brakes.

use super::{Course, FOLLOW, LOOP, STOP, trials};
use crate::sampling::write_csv;
use crate::{Done, print};
use indicatif::ProgressBar;
use paracosm::oracles::Verdict;
use paracosm::{StudyBuilder, Trial};
use std::path::Path;

/// How many tests a network is examined on.
pub const EXAMINED: usize = 100;

/// Where their tests begin in the sequence: no round of any course does so.
const SEED: u64 = 1000;

/// The drivers beside the network.
const OTHERS: [&str; 2] = ["expert", "cruise"];

/// The tests of a course's examination.
pub fn tests(course: &Course) -> Result<StudyBuilder, paracosm::Error> {
    course.study(SEED, EXAMINED)
}

/// How many of the tests pass.
pub fn passing(trials: &[Trial]) -> usize {
    trials.iter().filter(|trial| trial.verdict == Verdict::Pass).count()
}

/// Examines the networks that come with the software, and writes a table of each to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let mut text = format!("{:<12}{:>8}{:>8}{:>8}  of {EXAMINED} tests\n", "network", "passes", OTHERS[0], OTHERS[1]);
    for course in [&FOLLOW, &STOP, &LOOP] {
        let mut driven = vec![("cnn", trials(&course.drives(tests(course)?).build()?, bar)?)];
        for name in OTHERS {
            driven.push((name, trials(&tests(course)?.driver(name).build()?, bar)?));
        }
        table(&out.join(format!("exam-{}.csv", course.name)), &driven)?;
        let counts: String = driven.iter().map(|(_, trials)| format!("{:>8}", passing(trials))).collect();
        text += &format!("{:<12}{counts}\n", course.name);
    }
    bar.finish_and_clear();
    print(&text)
}

/// A row for each test of each driver.
fn table(path: &Path, driven: &[(&str, Vec<Trial>)]) -> Done {
    let parameters = driven[0].1[0].test.iter().map(|(name, _)| name.to_string());
    let columns = ["driver", "verdict", "violated", "travelled"].map(str::to_owned);
    let mut rows = vec![parameters.chain(columns).collect()];
    for (driver, trials) in driven {
        rows.extend(trials.iter().map(|trial| {
            let violated: Vec<&str> = trial.violated().collect();
            let travelled = trial.measured.as_ref().map(|measured| measured.travelled.to_string()).unwrap_or_default();
            let became = [(*driver).to_owned(), trial.verdict.to_string(), violated.join(" "), travelled];
            trial.test.iter().map(|(_, value)| value.to_string()).chain(became).collect()
        }));
    }
    write_csv(path, &rows)
}
