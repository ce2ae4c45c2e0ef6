//! The choice of a study's tests: strategy, budget, seed and other options.

use crate::Reason;
use paracosm_coverage::Deadline;
use paracosm_generators::{Aim, DiscreteFamily, Generator, OwnStrategy, Purpose, Request, Strategy};
use paracosm_space::{Point, Space};
use std::fmt;
use thiserror::Error;

/// The default number of tests that an adaptive strategy is asked for at a time.
const ADAPTIVE_BATCH: usize = 16;

/// The options that determine the tests of a study, with the strategy, the budget and the seed.
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
    /// The strategy of the program, for [`Strategy::OWN`].
    pub own: Option<OwnStrategy>,
    /// The method that makes the rows of discrete values, for example a covering array.
    pub discrete: DiscreteFamily,
    /// The number of parameters whose combinations of values are covered; `None` means two.
    pub k: Option<usize>,
    /// The largest allowed volume of an empty box between the tests of any row of discrete values. The campaign ends
    /// when no row has a larger box, or the budget is spent; the next test goes to the row with the largest empty box.
    pub epsilon: Option<f64>,
    /// The measure that the strategy `greedy` minimises; `None` means the default.
    pub aim: Option<Aim>,
    /// The index of the first point that the strategy takes from its sequence of points; `None` means the default.
    pub skip: Option<u64>,
    /// The seed of all randomness; `None` means a set of points without randomness if possible, otherwise seed 0.
    pub seed: Option<u64>,
    /// The number of tests that the strategy proposes at a time. The number changes the tests of an adaptive strategy.
    /// `None` means 16 for an adaptive strategy, and as many as fit in memory for others.
    pub batch: Option<usize>,
    /// The budget, which is the greatest number of tests.
    pub budget: usize,
    /// True if the first test that violates a requirement, in the order of the indices, ends the campaign.
    pub stop_at_first: bool,
}

impl Default for Sampling {
    /// Returns the strategy `halton` with 500 tests.
    fn default() -> Self {
        Self {
            strategy: Strategy::usual(Purpose::Cover),
            own: None,
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

/// Writes the strategy, with its seed if it has one.
impl fmt::Display for Sampling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.seed {
            Some(seed) => write!(f, "{} (seed {seed})", self.strategy_name()),
            None => write!(f, "{}", self.strategy_name()),
        }
    }
}

/// The reason why the options that determine the tests are invalid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SamplingFlaw {
    /// The budget is 0 tests.
    #[error("the budget is 0, expected at least 1 test")]
    NoBudget,
    /// The number of tests that the strategy proposes at a time is 0.
    #[error("the batch is 0, expected at least 1 test")]
    NoBatch,
}

impl Reason for SamplingFlaw {}

impl Sampling {
    /// Checks the options that all strategies share.
    pub(super) fn check(&self) -> Result<(), SamplingFlaw> {
        match self {
            Self { budget: 0, .. } => Err(SamplingFlaw::NoBudget),
            Self { batch: Some(0), .. } => Err(SamplingFlaw::NoBatch),
            _ => Ok(()),
        }
    }

    /// Returns the name of the strategy, or of the strategy of the program.
    pub fn strategy_name(&self) -> &str {
        self.own.as_ref().map_or(self.strategy.name(), OwnStrategy::name)
    }

    /// Returns the number of tests that the strategy proposes at a time; `None` if the study does not set the number.
    pub fn batch_size(&self) -> Option<usize> {
        self.batch.or_else(|| self.strategy.is_adaptive().then_some(ADAPTIVE_BATCH))
    }

    /// Returns the next greater number of parameters whose combinations the tests can cover; `None` if they have all combinations of the
    /// values of a space, or if something else than these combinations sets their number.
    pub fn stronger(&self, space: &Space) -> Option<usize> {
        let is_array = self.discrete == DiscreteFamily::Ipog && self.epsilon.is_none() && !self.strategy.is_adaptive();
        let k = self.request(space, &[]).discrete_strength().ok()?;
        (is_array && space.dims() == 0 && k < space.levels().len()).then_some(k + 1)
    }

    /// Returns the request from which a strategy makes a generator of tests in a space, in addition to existing tests.
    pub fn request<'a>(&'a self, space: &'a Space, existing: &'a [Point]) -> Request<'a> {
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
            own: self.own.as_ref(),
            rows: None,
            aim: self.aim,
            existing,
        }
    }
}

/// The generator of a study without an open parameter, which has one test.
pub(super) struct OneTest {
    pub is_asked: bool,
}

impl Generator for OneTest {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let is_new = n > 0 && !std::mem::replace(&mut self.is_asked, true);
        is_new.then(|| Point { continuous: Vec::new(), discrete: Vec::new() }).into_iter().collect()
    }
}
