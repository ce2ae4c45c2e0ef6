//! Finds the values of discrete parameters that are behind the failures of a campaign, and reports them by name.
//!
//! Only tests that failed or passed are evidence. Tests with another verdict (`error`, `invalid`, `inconclusive`) are
//! left out.

mod locate;
mod location;
mod search;

pub use locate::{LocatedReport, Unexplained};
pub use location::{Conclusion, Location, TestOfLocation};

use crate::estimate::named_level;
use paracosm_campaign::{Error, Log};
use paracosm_coverage::suspects::{self, JudgedTest, suspects};
use paracosm_oracles::Verdict;
use paracosm_space::rules::Rules;
use paracosm_space::{Coordinate, Point, Space, Values};
use serde::Serialize;

/// The greatest number of suspects that are listed.
const MOST_LISTED: usize = 20;

/// The greatest number of values in a combination, unless the tests were made to cover more values together.
const USUAL_SIZE: usize = 3;

/// The greatest number of combinations of one size, counted for each failing test, that are examined. This takes some
/// seconds.
const MOST_LOOKED_AT: f64 = 1e8;

/// A suspect, which is a smallest combination of values that only failing tests have.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NamedSuspect {
    /// The discrete values of the suspect combination.
    pub values: Values,
    /// The number of tests that have all values of the combination. All these tests failed.
    pub failures: usize,
    /// The mean over the combination's values of the estimated share of failed tests among the tests with the value.
    pub suspicion: f64,
}

/// The suspects of a campaign, which are combinations of discrete values that only failing tests have.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuspectReport {
    /// The greatest number of values in an examined combination. It is three, or the strength that the tests were made
    /// for if that is greater; fewer if there are too many combinations to examine.
    pub size: usize,
    /// The number of suspects that were found.
    pub found: u64,
    /// The suspects with the highest ranks, 20 at most. The smallest come first, and among equally small suspects those
    /// that explain most failures.
    pub ranked: Vec<NamedSuspect>,
    /// A few suspects of which each failing test has at least one, except the tests in `unexplained`.
    pub explanation: Vec<NamedSuspect>,
    /// The indices of the failing trials without a suspect combination.
    pub unexplained: Vec<usize>,
}

impl SuspectReport {
    /// Finds the suspects of a campaign; `None` if there are no discrete parameters, no failing tests or no passing
    /// tests.
    ///
    /// # Errors
    /// A trial does not fit into the study's space, or its constraints cannot be satisfied.
    pub fn of(log: &Log) -> Result<Option<Self>, Error> {
        let evidence = Evidence::of(log)?;
        if !evidence.tells_apart() {
            return Ok(None);
        }
        let size = evidence.size(log.study().sampling().k);
        let found = suspects(&evidence.rules, &evidence.tests, size, MOST_LISTED)?;
        let named = |suspect: suspects::Suspect| NamedSuspect {
            values: evidence.named(&suspect.values),
            failures: suspect.failures,
            suspicion: suspect.suspicion,
        };
        Ok(Some(Self {
            size,
            found: found.found,
            ranked: found.ranked.into_iter().map(named).collect(),
            explanation: found.explanation.into_iter().map(named).collect(),
            unexplained: found.unexplained.into_iter().map(|test| evidence.indices[test]).collect(),
        }))
    }
}

/// The trials that failed or passed, as tests of the discrete parameters.
struct Evidence<'a> {
    space: &'a Space,
    rules: Rules,
    tests: Vec<JudgedTest>,
    points: Vec<Point>,
    indices: Vec<usize>,
}

impl<'a> Evidence<'a> {
    fn of(log: &'a Log) -> Result<Self, Error> {
        let (study, trials) = (log.study(), log.trials());
        let space = study.space();
        let rules = space.rules()?;
        let mut evidence = Self { space, rules, tests: Vec::new(), points: Vec::new(), indices: Vec::new() };
        for trial in trials.iter().filter(|trial| matches!(trial.verdict, Verdict::Fail | Verdict::Pass)) {
            let point = space.encode(&trial.test)?;
            if evidence.rules.allows(&point.discrete) {
                evidence.tests.push(JudgedTest { levels: point.discrete.clone(), failed: trial.is_failure() });
                evidence.points.push(point);
                evidence.indices.push(trial.index);
            }
        }
        Ok(evidence)
    }

    fn tells_apart(&self) -> bool {
        let failures = self.tests.iter().filter(|test| test.failed).count();
        !self.rules.levels().is_empty() && 0 < failures && failures < self.tests.len()
    }

    /// Returns the greatest number of values in a combination. It is the strength of the tests, and at least three;
    /// it is smaller if the failing tests have too many combinations of that size.
    fn size(&self, strength: Option<usize>) -> usize {
        let parameters = self.rules.levels().len();
        let failures = self.tests.iter().filter(|test| test.failed).count();
        let mut combinations = failures as f64;
        let affordable = (1..=parameters).take_while(|&size| {
            combinations *= (parameters - size + 1) as f64 / size as f64;
            size == 1 || combinations <= MOST_LOOKED_AT
        });
        affordable.last().unwrap_or(1).min(strength.unwrap_or(USUAL_SIZE).max(USUAL_SIZE))
    }

    /// Returns the names and values of (parameter, level) pairs.
    fn named(&self, values: &[(usize, usize)]) -> Values {
        let discrete: Vec<Coordinate> = self.space.discrete().collect();
        values.iter().map(|&(coordinate, level)| named_level(&discrete, coordinate, level)).collect()
    }
}

#[cfg(test)]
mod planted;
#[cfg(test)]
mod tests;
