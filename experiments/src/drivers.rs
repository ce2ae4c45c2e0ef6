//! Runs every driver that comes with the software and uses no camera through the same Halton tests of every scenario, and
//! counts the verdicts. `experiments/drivers.md` shows the failures as a table, with the reason for each large number.
//! The images of a driver with a camera would take hours.

use crate::sampling::write_csv;
use crate::{Done, logged, print, scenario};
use indicatif::ProgressBar;
use paracosm::engine::driver;
use paracosm::generators::Strategy;
use paracosm::oracles::Verdict;
use paracosm::{Log, Trial};
use std::collections::BTreeMap;
use std::path::Path;

/// The tests of each driver in each scenario.
pub const TESTS: usize = 200;
const VERDICTS: [Verdict; 5] = [Verdict::Pass, Verdict::Fail, Verdict::Inconclusive, Verdict::Invalid, Verdict::Error];

/// Runs the study and writes `drivers.csv` to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let scenarios: Vec<&str> = paracosm::scenarios::ALL.iter().map(|program| program.name()).collect();
    let drivers: Vec<_> = driver::ALL.iter().filter(|driver| is_tested(driver)).collect();
    bar.set_length((scenarios.len() * drivers.len() * TESTS) as u64);
    let header =
        ["driver", "scenario"].map(str::to_owned).into_iter().chain(VERDICTS.map(|verdict| verdict.to_string()));
    let header = header.chain(["preventable", "violated"].map(str::to_owned));
    let mut rows: Vec<Vec<String>> = vec![header.collect()];
    for name in scenarios {
        let mut logs = Vec::new();
        for driver in &drivers {
            let study = scenario(name)?.driver(driver.name).strategy(Strategy::HALTON).budget(TESTS).build()?;
            logs.push((driver.name, logged(&study, bar)?));
        }
        rows.extend(logs.iter().map(|(driver, log)| row(driver, name, log, &logs)));
    }
    bar.finish_and_clear();
    write_csv(&out.join("drivers.csv"), &rows)?;
    let lines =
        rows.iter().skip(1).map(|row| format!("{:<12} {:<20} {:>3} fail  {}\n", row[0], row[1], row[3], row[8]));
    print(&lines.collect::<String>())
}

/// Returns `true` if the study tests a driver: it drives the car itself, without images, which would take hours.
fn is_tested(driver: &driver::Descriptor) -> bool {
    let mut built = driver.build(&[]).expect("the default settings of a driver are in their ranges");
    built.takes_over() && built.equipment().cameras.all.is_empty()
}

/// Returns the row of a driver in a scenario. A failing test is preventable if another driver passes it.
fn row(driver: &str, scenario: &str, log: &Log, all: &[(&str, Log)]) -> Vec<String> {
    let trials = log.trials();
    let count = |verdict: Verdict| trials.iter().filter(|trial| trial.verdict == verdict).count().to_string();
    let passed = |index: usize| all.iter().any(|(_, log)| log.trials()[index].verdict == Verdict::Pass);
    let failures: Vec<&Trial> = trials.iter().filter(|trial| trial.verdict == Verdict::Fail).collect();
    let preventable = failures.iter().filter(|trial| passed(trial.index)).count();
    let mut violated = BTreeMap::<&str, usize>::new();
    for requirement in failures.iter().flat_map(|trial| trial.violated()) {
        *violated.entry(requirement).or_default() += 1;
    }
    let violated: Vec<String> = violated.iter().map(|(requirement, count)| format!("{requirement} {count}")).collect();
    let ends = [preventable.to_string(), violated.join("; ")];
    [driver, scenario].map(str::to_owned).into_iter().chain(VERDICTS.map(count)).chain(ends).collect()
}
