//! Which values of discrete parameters are behind the failures of a campaign, by name.
//!
//! Only tests that failed or passed are evidence; what broke, was impossible or decided nothing is left out.

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

/// How many suspects are listed at most.
const MOST_LISTED: usize = 20;

/// Combinations of so many values are looked at, or of more where the tests were to cover more together.
const USUAL_SIZE: usize = 3;

/// How many combinations of one size are looked at, counted for each failing test: some seconds of looking.
const MOST_LOOKED_AT: f64 = 1e8;

/// A combination of values that only failing tests have, and of which no part is such a combination.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NamedSuspect {
    /// The values.
    pub values: Values,
    /// How many tests have them; all of them failed.
    pub failures: usize,
    /// How suspect the values are on their own, from 0 to 1.
    pub suspicion: f64,
}

/// What a campaign says about the combinations of discrete values behind its failures.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuspectReport {
    /// How many values a combination has at most: three, or as many as the tests were to cover together; fewer where
    /// there are too many combinations to look at.
    pub size: usize,
    /// How many suspects there are.
    pub found: u64,
    /// The first of them, 20 at most: the smallest first, among these those that explain most failures.
    pub ranked: Vec<NamedSuspect>,
    /// Few suspects that together explain all failures but the unexplained ones.
    pub explanation: Vec<NamedSuspect>,
    /// The indices of the failing trials that have no suspect combination.
    pub unexplained: Vec<usize>,
}

impl SuspectReport {
    /// The suspects of a campaign; `None` where there is nothing to tell apart: no discrete parameter, no failing test
    /// or no passing one.
    ///
    /// # Errors
    /// A trial is none of the study's space, or its constraints cannot be kept.
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

    /// Of how many values combinations are looked at: as many as were to be covered together, or three, unless the
    /// failing tests have too many combinations of them.
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

    /// The values of (parameter, level) pairs.
    fn named(&self, values: &[(usize, usize)]) -> Values {
        let discrete: Vec<Coordinate> = self.space.discrete().collect();
        values.iter().map(|&(coordinate, level)| named_level(&discrete, coordinate, level)).collect()
    }
}

#[cfg(test)]
mod planted;
#[cfg(test)]
mod tests;
