//! Writes and reads the results of a run as one line of `runs.csv`.

use paracosm_campaign::{Error, Reason};
use paracosm_generators::Strategy;
use std::path::Path;
use std::str::FromStr;
use thiserror::Error;

/// The results of a run of a strategy on a target, in numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The name of the target on which the strategy ran.
    pub scenario: String,
    /// The strategy that proposed the tests of the run.
    pub strategy: Strategy,
    /// The seed of the run.
    pub seed: u64,
    /// The number of different tests of the run. The number is below the budget if the strategy had no more tests, or
    /// if a test of a function failed.
    pub tests: usize,
    /// The number of tests up to and including the first failing test; `None` if no test failed.
    pub first_failure: Option<usize>,
    /// The number of failing tests of the run.
    pub failures: usize,
    /// The number of tests of the run that ended in an error, and so have no verdict.
    pub errors: usize,
    /// The number of failure modes of the run; `None` if the target is a function, which has no failure modes.
    pub modes: Option<usize>,
    /// The share of the map's failing tests that are predicted to fail; `None` without a map or a failing test in it.
    pub recall: Option<f64>,
    /// The share of failing tests among the tests predicted to fail; `None` without a map or a predicted failure.
    pub precision: Option<f64>,
    /// The volume of the largest box without a test; `None` without a reference map or an exactly known volume.
    pub dispersion: Option<f64>,
}

/// A flaw in a line of the file `runs.csv` of a bench.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RowFlaw {
    /// The header of the file differs from the header that this version writes.
    #[error("found a header that this version does not write: was the file written by another version?")]
    Header,
    /// The row has a different target, strategy or seed than the run that belongs on the line.
    #[error(
        "the row has another scenario, strategy or seed than the run that belongs on this line: was the file edited?"
    )]
    Foreign,
    /// The row of the file has too few or too many fields.
    #[error("found {found} as the number of fields, expected {}", Row::COLUMNS.len())]
    Fields {
        /// The number of fields of the row.
        found: usize,
    },
    /// A field of the row should be a number but is not a number.
    #[error("found `{found}` as {column}, expected a number")]
    NoNumber {
        /// The text of the field that is not a number.
        found: String,
        /// The name of the column with the field that is not a number.
        column: &'static str,
    },
}

impl Reason for RowFlaw {}

impl Row {
    /// Returns `true` if the run found no failure and ended before the budget for lack of further tests.
    pub fn is_exhausted(&self, budget: usize) -> bool {
        self.first_failure.is_none() && self.tests < budget
    }

    /// The names of the columns of `runs.csv`.
    pub const COLUMNS: [&str; 11] = [
        "scenario",
        "strategy",
        "seed",
        "tests",
        "first_failure",
        "failures",
        "errors",
        "modes",
        "recall",
        "precision",
        "dispersion",
    ];

    /// Returns the fields in the order of the columns. A field without a value is empty.
    pub(super) fn fields(&self) -> Vec<String> {
        vec![
            self.scenario.clone(),
            self.strategy.to_string(),
            self.seed.to_string(),
            self.tests.to_string(),
            maybe(self.first_failure),
            self.failures.to_string(),
            self.errors.to_string(),
            maybe(self.modes),
            maybe(self.recall),
            maybe(self.precision),
            maybe(self.dispersion),
        ]
    }

    /// Reads a row from the fields of a line of a file.
    pub(super) fn parse(path: &Path, line: usize, fields: &csv::StringRecord) -> Result<Self, Error> {
        let wrong = |column: usize, text: &str| {
            let flaw = RowFlaw::NoNumber { found: text.to_owned(), column: Self::COLUMNS[column] };
            Error::in_file(path, line, flaw)
        };
        if fields.len() != Self::COLUMNS.len() {
            return Err(Error::in_file(path, line, RowFlaw::Fields { found: fields.len() }));
        }
        fn number<T: FromStr>(text: &str) -> Option<T> {
            text.parse().ok()
        }
        let count = |column: usize| number(&fields[column]).ok_or_else(|| wrong(column, &fields[column]));
        let some = |column: usize| if fields[column].is_empty() { Ok(None) } else { count(column).map(Some) };
        let share = |column: usize| match &fields[column] {
            "" => Ok(None),
            text => number(text).map(Some).ok_or_else(|| wrong(column, text)),
        };
        Ok(Self {
            scenario: fields[0].to_owned(),
            strategy: fields[1].parse()?,
            seed: number(&fields[2]).ok_or_else(|| wrong(2, &fields[2]))?,
            tests: count(3)?,
            first_failure: some(4)?,
            failures: count(5)?,
            errors: count(6)?,
            modes: some(7)?,
            recall: share(8)?,
            precision: share(9)?,
            dispersion: share(10)?,
        })
    }
}

/// Returns the value as text, or an empty field.
fn maybe(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}
