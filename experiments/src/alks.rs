//! Runs the drivers through the parameter spaces of UN R157 (ALKS): every valid combination of the published values.
//!
//! The scenarios are those of github.com/asam-oss/OSC-ALKS-scenarios, which are not part of this repository. A violation that
//! none of the models of the regulation avoids counts as unpreventable. The study also asks how many of the failing combinations
//! a covering array has among its tests, and whether it has any.

use crate::sampling::write_csv;
use crate::{Done, logged, print};
use indicatif::ProgressBar;
use paracosm::generators::{DiscreteFamily, Strategy};
use paracosm::oracles::Verdict;
use paracosm::space::Values;
use paracosm::{Log, Sampling, Study};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The drivers on trial.
const DRIVERS: [&str; 6] = ["cc", "rss", "fsm", "reg157", "planner", "aeb"];
/// The drivers that decide which violations are preventable: the models of the regulation.
const REFERENCES: [&str; 3] = ["cc", "fsm", "reg157"];
/// The strengths of the covering arrays.
const STRENGTHS: [usize; 2] = [2, 3];
/// The folder of the scenarios, from the folder of this crate.
const FOLDER: &str = "../../shared/standards/alks/logical_scenarios";
/// The ending of the names of logical scenarios.
const LOGICAL: &str = "_variation.xosc";

/// Runs the study and writes `alks.csv` to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let header = ["scenario", "driver", "combinations", "valid"].map(str::to_owned).into_iter();
    let header = header.chain(Verdict::ALL.map(|verdict| verdict.to_string()));
    let of_arrays = STRENGTHS.map(|k| [format!("tests_{k}"), format!("fail_{k}")]);
    let mut rows: Vec<Vec<String>> = vec![header.chain(of_arrays.into_iter().flatten()).collect()];
    for file in files()? {
        for driver in DRIVERS {
            rows.push(row(&file, driver, bar)?);
            print(&format!("{}\n", rows[rows.len() - 1].join(" ")))?;
        }
    }
    bar.finish_and_clear();
    write_csv(&out.join("alks.csv"), &rows)
}

/// Returns the files of the logical scenarios.
fn files() -> Result<Vec<PathBuf>, Box<dyn std::error::Error + Send + Sync>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(FOLDER);
    let entries = std::fs::read_dir(&folder)
        .map_err(|error| format!("{} with the scenarios of UN R157 cannot be read: {error}", folder.display()))?;
    let mut files = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, std::io::Error>>()?;
    files.retain(|file| file.to_string_lossy().ends_with(LOGICAL));
    files.sort();
    Ok(files)
}

/// Returns the row of a driver in a scenario.
fn row(file: &Path, driver: &str, bar: &ProgressBar) -> Result<Vec<String>, Box<dyn std::error::Error + Send + Sync>> {
    let of_all = study(file, driver, DiscreteFamily::Cross, None)?;
    let sizes: Vec<usize> = of_all.space().levels();
    let all: usize = sizes.iter().product();
    let valid = of_all.space().rules()?.tests().unwrap_or_default();
    bar.inc_length(valid as u64);
    let log = logged(&of_all, bar)?;
    let count = |verdict: Verdict| log.trials().iter().filter(|trial| trial.verdict == verdict).count().to_string();
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let name = name.trim_start_matches("alks_scenario_").trim_end_matches(LOGICAL).to_owned();
    let mut row = vec![name, driver.to_owned(), all.to_string(), log.trials().len().to_string()];
    row.extend(Verdict::ALL.map(count));
    for k in STRENGTHS {
        if k > sizes.len() {
            row.extend([String::new(), String::new()]);
            continue;
        }
        let failing = failing(&log);
        let array = study(file, driver, DiscreteFamily::Ipog, Some(k))?;
        let tests: Vec<Values> =
            array.generator(&[])?.ask(usize::from(u16::MAX)).iter().map(|point| array.space().decode(point)).collect();
        let found = tests.iter().filter(|test| failing.contains(&key(test))).count();
        row.extend([tests.len().to_string(), found.to_string()]);
    }
    Ok(row)
}

/// Makes the study of a driver in a scenario whose discrete values have the rows of a family.
fn study(file: &Path, driver: &str, discrete: DiscreteFamily, k: Option<usize>) -> Result<Study, paracosm::Error> {
    let program = paracosm::catalogue().find(&file.to_string_lossy())?;
    let sampling = Sampling { strategy: Strategy::RANDOM, discrete, k, budget: 1 << 20, ..Sampling::default() };
    let study = Study::of(program).driver(driver).sampling(sampling);
    REFERENCES.iter().fold(study, |study, reference| study.reference(reference)).build()
}

/// Returns the tests that fail, each as a text.
fn failing(log: &Log) -> BTreeSet<String> {
    log.trials().iter().filter(|trial| trial.is_failure()).map(|trial| key(&trial.test)).collect()
}

fn key(test: &Values) -> String {
    test.iter().map(|(name, value)| format!("{name} {value};")).collect()
}
