//! How the tests of a study are chosen.

use crate::Reason;
use paracosm_coverage::Deadline;
use paracosm_generators::{Aim, DiscreteFamily, Purpose, Request, Strategy};
use paracosm_space::{Point, Space};
use std::fmt;
use thiserror::Error;

/// How many tests an adaptive strategy is asked for at a time where nothing is said.
const ADAPTIVE_BATCH: usize = 16;

/// How many tests are chosen, and how.
///
/// ```
/// use paracosm_campaign::Sampling;
/// use paracosm_generators::Strategy;
///
/// let sampling = Sampling { strategy: "sobol".parse()?, budget: 64, ..Sampling::default() };
/// assert_eq!(sampling.to_string(), "sobol");
/// # Ok::<(), paracosm_generators::GeneratorError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Sampling {
    /// The strategy that proposes tests.
    pub strategy: Strategy,
    /// The rows by which discrete parameters are covered.
    pub discrete: DiscreteFamily,
    /// How many parameters are covered together; `None` is two.
    pub k: Option<usize>,
    /// The campaign ends when no row of discrete values has an empty box above this volume, or the budget is spent; the next
    /// test goes to the row with the largest.
    pub epsilon: Option<f64>,
    /// The measure that the strategy `greedy` makes small; `None` is the usual one.
    pub aim: Option<Aim>,
    /// The index of a sequence's first point; `None` is the usual one.
    pub skip: Option<u64>,
    /// The source of all chance; `None` is the plain set where a strategy has one, and seed 0 elsewhere.
    pub seed: Option<u64>,
    /// How many tests the strategy is asked for at a time, which changes the tests of an adaptive one. `None` is 16 for an
    /// adaptive strategy, and as many as fit in memory for others.
    pub batch: Option<usize>,
    /// How many tests are run at most.
    pub budget: usize,
    /// Whether the first test that violates a requirement, in the order of their indices, ends the campaign.
    pub stop_at_first: bool,
}

impl Default for Sampling {
    /// The strategy `halton`, 500 tests.
    fn default() -> Self {
        Self {
            strategy: Strategy::usual(Purpose::Cover),
            discrete: DiscreteFamily::default(),
            k: None,
            epsilon: None,
            aim: None,
            skip: None,
            seed: None,
            batch: None,
            budget: 500,
            stop_at_first: false,
        }
    }
}

/// The strategy, with its seed if it has one.
impl fmt::Display for Sampling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.seed {
            Some(seed) => write!(f, "{} (seed {seed})", self.strategy),
            None => write!(f, "{}", self.strategy),
        }
    }
}

/// Why tests cannot be chosen so.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SamplingFlaw {
    /// No test is wanted.
    #[error("the budget is 0, expected at least 1 test")]
    NoBudget,
    /// No test is asked for at a time.
    #[error("the batch is 0, expected at least 1 test")]
    NoBatch,
}

impl Reason for SamplingFlaw {}

impl Sampling {
    /// Checks what holds for all strategies.
    pub(super) fn check(&self) -> Result<(), SamplingFlaw> {
        match self {
            Self { budget: 0, .. } => Err(SamplingFlaw::NoBudget),
            Self { batch: Some(0), .. } => Err(SamplingFlaw::NoBatch),
            _ => Ok(()),
        }
    }

    /// How many tests the strategy is asked for at a time, where that matters.
    pub fn batch_size(&self) -> Option<usize> {
        self.batch.or_else(|| self.strategy.is_adaptive().then_some(ADAPTIVE_BATCH))
    }

    /// The request for a generator of tests of this space, beside existing tests.
    pub fn request<'a>(&self, space: &'a Space, existing: &'a [Point]) -> Request<'a> {
        Request {
            space,
            budget: self.budget,
            seed: self.seed,
            skip: self.skip,
            discrete: self.discrete,
            k: self.k,
            epsilon: self.epsilon,
            // A campaign has to propose the same tests when it is resumed.
            deadline: Deadline::never(),
            groups: &[],
            rows: None,
            aim: self.aim,
            existing,
        }
    }
}
