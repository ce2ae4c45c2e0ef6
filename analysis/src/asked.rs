//! Checks of what a user asks of a comparison or a bench.

use paracosm_campaign::{Error, Reason};
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// With how many pairs tests and intervals have enough power; fewer are remarked upon.
pub const ENOUGH_SEEDS: usize = 30;

/// What makes no sense in a comparison or a bench.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ListFlaw {
    /// A list is empty.
    #[error("the list of {of} is empty")]
    Empty {
        /// What is listed.
        of: &'static str,
    },
    /// A list names something twice.
    #[error("{name} is twice among the {of}")]
    Twice {
        /// What is listed.
        of: &'static str,
        /// What is named twice.
        name: String,
    },
    /// There are too few seeds to compare.
    #[error("the number of seeds is {seeds}, expected at least 2, or better {ENOUGH_SEEDS}")]
    FewSeeds {
        /// How many there are.
        seeds: usize,
    },
    /// A seed is too large.
    #[error("{seeds} seeds from {first} on go beyond {}", u64::MAX)]
    LargeSeeds {
        /// How many there are.
        seeds: usize,
        /// The first.
        first: u64,
    },
}

/// A place that a study cannot be written to.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PlaceFlaw {
    /// It has something in it.
    #[error("{} is not empty: write elsewhere", path.display())]
    NotEmpty {
        /// The folder.
        path: PathBuf,
    },
    /// It is a file.
    #[error("{} is a file, expected a folder to write to", path.display())]
    File {
        /// The file.
        path: PathBuf,
    },
}

impl Reason for ListFlaw {}
impl Reason for PlaceFlaw {}

/// Checks a list that a user gave.
///
/// # Errors
/// It is empty, or names something twice.
pub fn each_once(of: &'static str, names: impl Iterator<Item = String>) -> Result<(), ListFlaw> {
    let names: Vec<String> = names.collect();
    if names.is_empty() {
        return Err(ListFlaw::Empty { of });
    }
    let twice = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name));
    twice.map_or(Ok(()), |(_, name)| Err(ListFlaw::Twice { of, name: name.clone() }))
}

/// Checks that there are seeds enough to compare, and that none is too large.
///
/// # Errors
/// There are fewer than two, or one is above 2^64 - 1.
pub fn check_seeds(seeds: usize, first: u64) -> Result<(), ListFlaw> {
    if seeds < 2 {
        return Err(ListFlaw::FewSeeds { seeds });
    }
    match first.checked_add(seeds as u64 - 1) {
        Some(_) => Ok(()),
        None => Err(ListFlaw::LargeSeeds { seeds, first }),
    }
}

/// What a reader should know where there are few seeds.
pub fn few_seeds(seeds: usize) -> Option<String> {
    (seeds < ENOUGH_SEEDS).then(|| format!("{seeds} seeds are few; from {ENOUGH_SEEDS} on the tests have enough power"))
}

/// Makes a folder for a study, if need be.
///
/// # Errors
/// It cannot be made, or has something in it.
pub fn new_folder(path: &Path) -> Result<(), Error> {
    make_folder(path)?;
    let mut there = fs::read_dir(path).map_err(Error::io("read", path))?;
    match there.next() {
        None => Ok(()),
        Some(_) => Err(PlaceFlaw::NotEmpty { path: path.to_owned() }.into()),
    }
}

/// Makes a folder, if need be.
///
/// # Errors
/// It cannot be made.
pub fn make_folder(path: &Path) -> Result<(), Error> {
    if path.exists() && !path.is_dir() {
        return Err(PlaceFlaw::File { path: path.to_owned() }.into());
    }
    fs::create_dir_all(path).map_err(Error::io("create", path))
}
