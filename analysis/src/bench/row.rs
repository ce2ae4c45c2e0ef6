//! What is written of a run: one line of `runs.csv`.

use paracosm_campaign::{Error, Reason};
use paracosm_generators::Strategy;
use std::path::Path;
use std::str::FromStr;
use thiserror::Error;

/// A run in numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The name of its target.
    pub scenario: String,
    /// The strategy.
    pub strategy: Strategy,
    /// The seed.
    pub seed: u64,
    /// How many different tests were run: the budget, as many as the strategy had, or of a function up to the first failure.
    pub tests: usize,
    /// After how many tests the first one failed, itself among them; `None` if none did.
    pub first_failure: Option<usize>,
    /// How many tests failed.
    pub failures: usize,
    /// In how many modes, where failures have modes.
    pub modes: Option<usize>,
    /// Which share of where tests fail is told to fail, against a reference map.
    pub recall: Option<f64>,
    /// Which share of what is told to fail does fail; `None`, too, where nothing is told to fail.
    pub precision: Option<f64>,
    /// The volume of the largest empty box, where there is a map and it is known exactly.
    pub dispersion: Option<f64>,
}

/// What is wrong with a line of a file of rows.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RowFlaw {
    /// Another version has written it.
    #[error("found another header than this version writes")]
    Header,
    /// It is the row of another run.
    #[error("the row is not that of the run in its place; was the file edited?")]
    Foreign,
    /// It has too few or too many fields.
    #[error("found {found} fields, expected {}", Row::COLUMNS.len())]
    Fields {
        /// How many it has.
        found: usize,
    },
    /// A field is no number.
    #[error("found `{found}` as {column}, expected a number")]
    NoNumber {
        /// What stands there.
        found: String,
        /// The column.
        column: &'static str,
    },
}

impl Reason for RowFlaw {}

impl Row {
    /// Whether the strategy had nothing more to propose before the budget was spent, and no failure by then.
    pub fn is_exhausted(&self, budget: usize) -> bool {
        self.first_failure.is_none() && self.tests < budget
    }

    /// The names of the columns.
    pub const COLUMNS: [&str; 10] = [
        "scenario",
        "strategy",
        "seed",
        "tests",
        "first_failure",
        "failures",
        "modes",
        "recall",
        "precision",
        "dispersion",
    ];

    /// The fields, in the order of the columns; empty where there is no value.
    pub(super) fn fields(&self) -> Vec<String> {
        vec![
            self.scenario.clone(),
            self.strategy.to_string(),
            self.seed.to_string(),
            self.tests.to_string(),
            maybe(self.first_failure),
            self.failures.to_string(),
            maybe(self.modes),
            maybe(self.recall),
            maybe(self.precision),
            maybe(self.dispersion),
        ]
    }

    /// Reads the fields of a line of a file.
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
            modes: some(6)?,
            recall: share(7)?,
            precision: share(8)?,
            dispersion: share(9)?,
        })
    }
}

/// A value, or an empty field.
fn maybe(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}
