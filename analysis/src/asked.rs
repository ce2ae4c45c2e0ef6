//! Checks the lists, seeds and folders that a user gives to a comparison or a bench.

use paracosm_campaign::files::create_folder;
use paracosm_campaign::{Error, Reason};
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The least number of seeds (one pair of results each) that gives statistical tests and intervals enough power. Fewer
/// seeds cause a remark.
pub const ENOUGH_SEEDS: usize = 30;

/// A flaw in a list or in the seeds that a user gave to a comparison or a bench of strategies.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ListFlaw {
    /// A list that the user gave is empty.
    #[error("the list of {of} is empty")]
    Empty {
        /// The kind of the list's entries, in the plural, such as `strategies`.
        of: &'static str,
    },
    /// A list that the user gave has the same entry twice.
    #[error("{name} is twice in the list of {of}, expected once")]
    Twice {
        /// The kind of the list's entries, in the plural, such as `strategies`.
        of: &'static str,
        /// The entry that the list has twice.
        name: String,
    },
    /// The number of seeds is below 2, the least number for a comparison.
    #[error("the number of seeds is {seeds}, expected at least 2, or better {ENOUGH_SEEDS}")]
    FewSeeds {
        /// The number of seeds that the user gave.
        seeds: usize,
    },
    /// The last of the consecutive seeds would be above 2^64 - 1.
    #[error(
        "{seeds} seeds from the first seed {first} on exceed the greatest seed, {}: choose a smaller first seed",
        u64::MAX
    )]
    LargeSeeds {
        /// The number of seeds that the user gave.
        seeds: usize,
        /// The first of the consecutive seeds that the user gave.
        first: u64,
    },
}

/// A reason why the results of a study cannot be written to a path.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PlaceFlaw {
    /// The folder for the study is not empty.
    #[error("{} is not empty, expected an empty or a new folder: choose another folder", path.display())]
    NotEmpty {
        /// The path of the folder that is not empty.
        path: PathBuf,
    },
    /// The path belongs to a file and not to a folder.
    #[error("{} is a file, expected a folder to write to", path.display())]
    File {
        /// The path of the file that is in place of a folder.
        path: PathBuf,
    },
}

impl Reason for ListFlaw {}
impl Reason for PlaceFlaw {}

/// Checks that a list is not empty and has no entry twice. `of` names the kind of the entries in an error.
///
/// # Errors
/// The list is empty, or names something twice.
pub fn each_once(of: &'static str, names: impl Iterator<Item = String>) -> Result<(), ListFlaw> {
    let names: Vec<String> = names.collect();
    if names.is_empty() {
        return Err(ListFlaw::Empty { of });
    }
    let twice = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name));
    twice.map_or(Ok(()), |(_, name)| Err(ListFlaw::Twice { of, name: name.clone() }))
}

/// Checks that a comparison has at least two seeds, and that no seed is above 2^64 - 1.
///
/// # Errors
/// There are fewer than two seeds, or the last seed is above 2^64 - 1.
pub fn check_seeds(seeds: usize, first: u64) -> Result<(), ListFlaw> {
    if seeds < 2 {
        return Err(ListFlaw::FewSeeds { seeds });
    }
    match first.checked_add(seeds as u64 - 1) {
        Some(_) => Ok(()),
        None => Err(ListFlaw::LargeSeeds { seeds, first }),
    }
}

/// Returns a remark for the reader if there are fewer seeds than [`ENOUGH_SEEDS`].
pub fn few_seeds(seeds: usize) -> Option<String> {
    (seeds < ENOUGH_SEEDS)
        .then(|| format!("{seeds} seeds are few: the statistical tests have enough power from {ENOUGH_SEEDS} seeds on"))
}

/// Makes a new folder for a study, or checks that an existing folder is empty.
///
/// # Errors
/// The folder cannot be made or read, or is not empty, or the path is that of a file.
pub fn new_folder(path: &Path) -> Result<(), Error> {
    make_folder(path)?;
    let mut there = fs::read_dir(path).map_err(Error::io("read", path))?;
    match there.next() {
        None => Ok(()),
        Some(_) => Err(PlaceFlaw::NotEmpty { path: path.to_owned() }.into()),
    }
}

/// Makes a folder unless the folder exists.
///
/// # Errors
/// The folder cannot be made, or the path is that of a file.
pub fn make_folder(path: &Path) -> Result<(), Error> {
    if path.exists() && !path.is_dir() {
        return Err(PlaceFlaw::File { path: path.to_owned() }.into());
    }
    create_folder(path)
}
