//! The reasons why a file holds no tests of a space.

use crate::Reason;
use paracosm_space::{ParameterError, SpaceError, Value, plural};
use std::path::PathBuf;
use thiserror::Error;

/// The most numbers (some gigabytes of tests) that are kept in memory; larger sets are refused.
pub(super) const MOST_NUMBERS: usize = 50_000_000;

/// The error that a set of tests does not fit in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{} of {} do not fit in memory: at most {MOST_NUMBERS} numbers", plural(*tests, "test"), plural(*parameters, "parameter"))]
pub struct TooManyTests {
    /// The number of tests in the set.
    pub tests: usize,
    /// The number of parameters of each test.
    pub parameters: usize,
}

/// The error in the header of a CSV file of tests.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum HeaderFlaw {
    /// The CSV file is empty and has no header.
    #[error("the file is empty, expected a header with the names of the columns, or numbers")]
    Empty,
    /// Two columns have the name of the same coordinate.
    #[error("two columns are called `{name}`: remove one of them")]
    Twice {
        /// The name of the columns.
        name: String,
    },
    /// The first line has the numbers of the columns in place of names.
    #[error(
        "the first line `{line}` seems to have the numbers of the columns: write the names of the columns there, or leave it out; numbers of a \
         test may be written as 0.0"
    )]
    ColumnNumbers {
        /// The first line of numbers.
        line: String,
    },
    /// A comment before the numbers names a coordinate of the space, but not each column.
    #[error(
        "a comment names the columns `{found}`, expected a name for each of {}, among them {}", plural(*columns, "column"), expected.join(", ")
    )]
    Comment {
        /// The words of the comment.
        found: String,
        /// The number of columns of the file.
        columns: usize,
        /// The names of the coordinates of the space.
        expected: Vec<String>,
    },
    /// The file has numbers without a header, and the number of columns is not the number of coordinates of the space.
    #[error(
        "found {} without names, expected {}, in this order: {}", plural(*found, "column"), expected.len(), expected.join(", ")
    )]
    Columns {
        /// The number of columns of the file.
        found: usize,
        /// The names of the coordinates of the space.
        expected: Vec<String>,
    },
    /// The columns of the CSV file are separated by semicolons.
    #[error("the columns seem to be separated by `;`, expected `,`")]
    Semicolons,
    /// The file has no column for a coordinate of the space.
    #[error(
        "no column is called `{name}`{}; the columns are {found}",
        nearest.as_ref().map(|column| format!(" (is it `{column}`?)")).unwrap_or_default()
    )]
    NoColumn {
        /// The name of the missing column.
        name: String,
        /// The most similar name of a column; `None` if no name is similar.
        nearest: Option<String>,
        /// The names of all columns.
        found: String,
    },
}

/// The reason why a test in a CSV file is invalid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CellFlaw {
    /// A cell of the test is empty.
    #[error(
        "found an empty cell, expected a value{}",
        if *is_mixed { "; tests to complete may have empty cells only if no parameter is continuous" } else { "" }
    )]
    Open {
        /// True if the space has both continuous and discrete parameters.
        is_mixed: bool,
    },
    /// A cell of the test holds a word in place of a number.
    #[error("found `{found}`, expected a number")]
    NoNumber {
        /// The value that was found in place of a number.
        found: Value,
    },
    /// A value of the test differs from the fixed value of the parameter.
    #[error("found {found}, but `{name}` is fixed at {value}; --open {name} lets it vary")]
    Fixed {
        /// The value that was found in the file.
        found: Value,
        /// The name of the parameter.
        name: String,
        /// The fixed value of the parameter.
        value: Value,
    },
    /// The parameter does not accept the value.
    #[error(transparent)]
    Parameter(ParameterError),
    /// The values of the test are not a valid test of the space.
    #[error(transparent)]
    Space(SpaceError),
}

/// The error that a test in a CSV file is invalid, with the name of the column.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "{}{flaw}{}",
    column.as_ref().map(|column| format!("column `{column}`: ")).unwrap_or_default(),
    if *is_made_up { "; name the space of the tests with --space SPACE.toml" } else { "" }
)]
pub struct WrongCell {
    /// The name of the column with the error; `None` if the error is not in a single column.
    pub column: Option<String>,
    /// The reason why the test is invalid.
    pub flaw: CellFlaw,
    /// True if no space was given, so that the columns were read as coordinates.
    pub is_made_up: bool,
}

/// The error that a path leads to a folder instead of a file of tests.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{} is a folder, expected a CSV; a campaign has its tests in {}", path.display(), path.join("trials.csv").display()
)]
pub struct IsFolder {
    /// The path of the folder.
    pub path: PathBuf,
}

impl Reason for TooManyTests {}
impl Reason for HeaderFlaw {}
impl Reason for WrongCell {}
impl Reason for IsFolder {}
