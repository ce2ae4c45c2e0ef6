//! Notes on generated tests: the guarantee of random rows, the part of a covering array that the budget covers, and
//! the (k, epsilon) that was reached. Everything but the guarantee is measured.

use super::array::combinations;
use crate::cli::output::{bracket, digits, plural};
use crate::coverage::kwise::KwiseError;
use crate::coverage::kwise_dispersion::row_dispersion;
use crate::coverage::valid::Validity;
use crate::coverage::{Bracket, Deadline};
use paracosm_analysis::estimate::Discrete;
use paracosm_analysis::{Coverage, Limit, Promise};
use paracosm_campaign::{Error, TestSet};
use paracosm_coverage::Measure;
use std::collections::BTreeSet;
use std::time::Duration;

/// Tests that were generated in addition to existing tests, with the epsilon that all tests reach.
pub(super) struct Reached {
    /// All tests, with the existing tests before the new tests.
    pub tests: TestSet,
    pub existing: usize,
    /// The largest dispersion among the rows of discrete values; `None` in a space without continuous parameters.
    pub epsilon: Option<Bracket>,
}

impl Reached {
    /// Measures the largest dispersion among the rows of tests within a time limit.
    ///
    /// # Errors
    /// No test can keep the constraints of the space.
    pub fn of(tests: TestSet, existing: usize, limit: Duration) -> Result<Self, Error> {
        let dims = tests.space.dims();
        let rules = tests.space.rules()?;
        let validity = Validity::of(&tests.space, &rules);
        let measured = || row_dispersion(dims, validity.as_ref(), &tests.points, Deadline::after(limit));
        let epsilon = (dims > 0).then(measured);
        Ok(Self { tests, existing, epsilon })
    }

    /// Describes the guarantee of random rows, and the measured coverage of the tests.
    pub fn kept(&self, promise: &Promise) -> Result<String, Error> {
        let added = &self.tests.points[self.existing..];
        let rows: BTreeSet<&Vec<usize>> = added.iter().map(|test| &test.discrete).collect();
        let measured = match self.discrete(Some(promise.k)) {
            Ok(found) => found.map(|found| format!("{} of {} covered", found.covered, found.valid)),
            Err(error) => match error.reason() {
                Some(KwiseError::TooMany { .. }) => Some(format!("nothing: {error}")),
                _ => return Err(error),
            },
        };
        let (drawn, different) = (promise.rows, rows.len());
        let measured = measured.expect("there are discrete parameters");
        Ok(format!(
            "{}, {different} of them different; guaranteed: {}; measured: {measured}",
            plural(drawn as usize, "random row"),
            promise.words()
        ))
    }

    /// Describes the part of a covering array that the tests cover; `None` if the tests contain all rows of the array.
    pub fn cut_short(&self, rows: &[Vec<usize>]) -> Result<Option<String>, Error> {
        let tested: BTreeSet<&Vec<usize>> = self.tests.points.iter().map(|test| &test.discrete).collect();
        let used = rows.iter().filter(|row| tested.contains(row)).count();
        if used == rows.len() {
            return Ok(None);
        }
        let covered = |found: Discrete| {
            let Discrete { k, covered, valid, .. } = found;
            format!("{used} of the {}: {covered} of {valid} {}", plural(rows.len(), "row"), combinations(k))
        };
        Ok(self.discrete(self.tests.k)?.map(covered))
    }

    /// Describes the (k, epsilon)-coverage of the tests in words.
    pub fn words(&self) -> Result<String, Error> {
        let Some(rows) = self.epsilon else { return Ok("no continuous parameter to measure".to_owned()) };
        let epsilon = if rows.is_exact() { digits(rows.upper) } else { format!("at most {}", digits(rows.upper)) };
        if self.tests.space.levels().is_empty() {
            return Ok(format!("dispersion {epsilon}: measured"));
        }
        Ok(match self.discrete(self.tests.k)? {
            Some(discrete) if discrete.covered == discrete.valid => {
                format!("({}, {epsilon})-covering: measured", discrete.k)
            }
            Some(discrete) => {
                format!("not {}-wise complete; the dispersion over the covered rows is {epsilon}", discrete.k)
            }
            None => format!("dispersion {epsilon} over the rows: measured"),
        })
    }

    /// Returns a sentence with the reason why the tests do not reach epsilon; `None` if the tests reach epsilon. `end`
    /// names the limit that ended the search.
    pub fn missed(&self, epsilon: f64, end: &str) -> Option<String> {
        let rows = self.epsilon.filter(|rows| rows.upper > epsilon)?;
        Some(match rows.lower > epsilon {
            true => format!("{end} ended the search before epsilon {epsilon} was reached"),
            false => {
                format!("{end} ended the search; whether epsilon {epsilon} is reached is unknown: {}", bracket(&rows))
            }
        })
    }

    fn discrete(&self, k: Option<usize>) -> Result<Option<Discrete>, Error> {
        Ok(Coverage::of(&self.tests, &[Measure::K_WISE], k, Limit::Work(0))?.discrete.flatten())
    }
}
