//! Checks the lists, seeds and folders that a user gives to a comparison or a bench.

use paracosm_campaign::{Error, Reason};
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The number of seeds (pairs) from which statistical tests and intervals have enough power. Fewer seeds cause a
/// remark.
pub const ENOUGH_SEEDS: usize = 30;

/// A flaw in a list or in the seeds that a user gave to a comparison or a bench.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ListFlaw {
    /// A list is empty.
    #[error("the list of {of} is empty")]
    Empty {
        /// The kind of things that the list names, in the plural.
        of: &'static str,
    },
    /// A list names the same thing twice.
    #[error("{name} is twice in the list of {of}, expected once")]
    Twice {
        /// The kind of things that the list names, in the plural.
        of: &'static str,
        /// The name that the list has twice.
        name: String,
    },
    /// There are too few seeds to compare.
    #[error("the number of seeds is {seeds}, expected at least 2, or better {ENOUGH_SEEDS}")]
    FewSeeds {
        /// The number of seeds.
        seeds: usize,
    },
    /// The last seed would be above 2^64 - 1.
    #[error(
        "{seeds} seeds from the first seed {first} on exceed the greatest seed, {}: choose a smaller first seed",
        u64::MAX
    )]
    LargeSeeds {
        /// The number of seeds.
        seeds: usize,
        /// The first seed.
        first: u64,
    },
}

/// A reason why a study cannot be written to a path.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PlaceFlaw {
    /// The folder is not empty.
    #[error("{} is not empty, expected an empty or a new folder: choose another folder", path.display())]
    NotEmpty {
        /// The folder.
        path: PathBuf,
    },
    /// The path is that of a file.
    #[error("{} is a file, expected a folder to write to", path.display())]
    File {
        /// The file.
        path: PathBuf,
    },
}

impl Reason for ListFlaw {}
impl Reason for PlaceFlaw {}

/// Checks that a list that a user gave is not empty and names nothing twice. `of` says in an error what the list
/// names.
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

/// Checks that there are enough seeds to compare, and that no seed is too large.
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

/// Makes a folder for a study if it does not exist, and checks that it is empty.
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

/// Makes a folder if it does not exist.
///
/// # Errors
/// The folder cannot be made, or the path is that of a file.
pub fn make_folder(path: &Path) -> Result<(), Error> {
    if path.exists() && !path.is_dir() {
        return Err(PlaceFlaw::File { path: path.to_owned() }.into());
    }
    fs::create_dir_all(path).map_err(Error::io("create", path))
}
