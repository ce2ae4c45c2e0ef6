//! Puts test suites on trial: the grids that UN R157 and Euro NCAP state, and suites of many strategies.
//!
//! The scenarios of UN R157 are those of github.com/asam-oss/OSC-ALKS-scenarios, and the scenarios of Euro NCAP are those of
//! github.com/vectorgrp/OSC-NCAP-scenarios. They are not part of this repository. Without them, the study of strategies has
//! the scenarios that come with the software, and the study of stated grids has none.

mod graded;
mod stated;
mod statistics;
mod strategies;

pub use stated::run as run_stated;
pub use strategies::run as run_strategies;

use crate::Done;
use paracosm::{Error, StudyBuilder};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};

/// The driver whose defects are on trial.
const DRIVER: &str = "planner";
/// The number of random tests in which each defect is on before. Some tests of the regulation last an hour, so they are few.
const SCREEN: usize = 16;
/// The folders of logical scenarios, from the folder of this crate, with the part of a name that a logical scenario has.
const FOLDERS: [(&str, &str); 3] = [
    ("alks/logical_scenarios", "_variation."),
    ("ncap/OpenSCENARIO/NCAP/AEB_C2C_2023/Variations", "_Variation_"),
    ("ncap/OpenSCENARIO/NCAP/AEB_VRU_2023/Variations", "_Variation_"),
];
const STANDARDS: &str = "../../shared/standards";

/// Returns the files of the logical scenarios, in the order of their names. It is empty if they do not lie beside the repository.
fn files() -> Vec<PathBuf> {
    let of_folder = |(folder, part): (&str, &str)| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(STANDARDS).join(folder);
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        files.retain(|file| file.to_string_lossy().contains(part));
        files.sort();
        files
    };
    FOLDERS.into_iter().flat_map(of_folder).collect()
}

/// Returns the short name of a logical scenario, such as `4_4_1_cut_in_no_collision`.
fn name_of(file: &Path) -> String {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let words = ["alks_scenario_", "_variation", "_Variation", "NCAP_", "_2023"];
    words.iter().fold(name.into_owned(), |name, word| name.replace(word, ""))
}

/// Begins the study of a scenario with the driver on trial.
fn study(name: &str) -> Result<StudyBuilder, Error> {
    Ok(paracosm::Study::of(paracosm::catalogue().find(name)?).driver(DRIVER))
}

/// Returns the rows of a CSV file, if it is there. After a cut, a study goes on behind the scenarios that its file has.
fn known_rows<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, csv::Error> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    csv::Reader::from_path(path)?.deserialize().collect()
}

/// Writes rows to a CSV file.
fn write_rows<T: Serialize>(path: &Path, rows: &[T]) -> Done {
    crate::write(path, as_csv(rows)?)
}

/// Returns rows as the contents of a CSV file.
fn as_csv<T: Serialize>(rows: &[T]) -> Result<Vec<u8>, Box<dyn std::error::Error + Send + Sync>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| table.serialize(row))?;
    Ok(table.into_inner()?)
}
