//! Errors of building a generator; each message says what was found and what was expected.

use crate::covering::CoveringError;
use paracosm_space::plural;
use paracosm_space::{SpaceError, did_you_mean};
use thiserror::Error;

/// The reason why a generator cannot be built.
#[derive(Debug, PartialEq, Error)]
pub enum GeneratorError {
    /// No strategy has the given name.
    #[error("no strategy is called `{name}`{}", did_you_mean(.nearest))]
    UnknownStrategy {
        /// The name that no strategy has.
        name: String,
        /// The name of a strategy that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// No discrete family has the given name.
    #[error("no discrete family is called `{name}`{}; the families are ipog, random and cross", did_you_mean(.nearest))]
    UnknownFamily {
        /// The name that no family has.
        name: String,
        /// The name of a family that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// The space has no parameter.
    #[error("the space has no parameters; a generator needs at least one")]
    EmptySpace,
    /// The budget is 0.
    #[error("the budget is 0 tests; a budget must be at least 1")]
    NoBudget,
    /// A start index was given for a strategy that has no order.
    #[error("`{strategy}` is not a sequence and cannot skip points; use one of {sequences}, or do not skip")]
    NoSequence {
        /// The name of the strategy.
        strategy: &'static str,
        /// The names of the strategies that can skip.
        sequences: String,
    },
    /// The strategy is not made for this number of continuous coordinates.
    #[error("`{strategy}` is made for {made_for} continuous coordinates; the space has {dims}; use {instead}")]
    Dimensions {
        /// The name of the strategy.
        strategy: &'static str,
        /// The number of coordinates that the strategy is made for, in words.
        made_for: String,
        /// The number of coordinates of the space.
        dims: usize,
        /// A strategy that is made for this number of coordinates.
        instead: &'static str,
    },
    /// An index is so large that a double cannot tell it from others.
    #[error("`{strategy}` has {len} points, but the request needs index {last}; lower the budget or the skip")]
    IndexLimit {
        /// The name of the strategy.
        strategy: &'static str,
        /// The number of points of the strategy.
        len: u64,
        /// The last index that the request needs.
        last: u64,
    },
    /// A Latin hypercube, which is kept in memory as a whole, does not fit.
    #[error(
        "a Latin hypercube of {points} points in {dims} dimensions has more than 10,000,000 coordinates, the most that \
         are kept in memory; use halton"
    )]
    LhsLimit {
        /// The number of points that the request needs.
        points: u64,
        /// The number of dimensions.
        dims: usize,
    },
    /// The epsilon is not above 0 and below 1.
    #[error("epsilon is {0}; the volume of an empty box must be above 0 and below 1")]
    Epsilon(f64),
    /// An epsilon leaves the number of tests open, but the strategy makes a set for a given number.
    #[error("`{strategy}` must know the number of tests beforehand, but epsilon leaves it open; use halton or greedy")]
    Sized {
        /// The name of the strategy.
        strategy: &'static str,
    },
    /// An epsilon asks for rows without large holes, but the strategy goes where tests fail.
    #[error(
        "`{strategy}` goes where tests fail and leaves holes elsewhere; epsilon forbids holes: use halton or greedy"
    )]
    NoEpsilon {
        /// The name of the strategy.
        strategy: &'static str,
    },
    /// The strategy does not look at existing tests.
    #[error("`{strategy}` does not look at existing tests and cannot extend them; use greedy")]
    NoExtension {
        /// The name of the strategy.
        strategy: &'static str,
    },
    /// An aim was given for a strategy that does not aim at a measure.
    #[error("`{strategy}` cannot aim at a measure; use greedy, or give no measure to aim at")]
    NoAim {
        /// The name of the strategy.
        strategy: &'static str,
    },
    /// No measure that `greedy` can aim at has the given name.
    #[error("greedy cannot aim at `{name}`{}; it can aim at dispersion and k-wise-dispersion", did_you_mean(.nearest))]
    UnknownAim {
        /// The name that no such measure has.
        name: String,
        /// The name of a measure that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// An existing test does not belong to the space.
    #[error("existing test {index} does not belong to the space; give each parameter of the space a valid value")]
    Foreign {
        /// The position of the test, from 0.
        index: usize,
    },
    /// There are more choices of k parameters than `greedy` can handle.
    #[error("there are more than {most} choices of {k} parameters with their values; use a smaller k")]
    Views {
        /// The strength k.
        k: usize,
        /// The greatest number of choices that `greedy` handles.
        most: usize,
    },
    /// The strength is out of range for a request in which all parameters count.
    #[error("k is {k}, but the space has {}; expected k from 1 to that number", plural(*parameters, "parameter"))]
    AllStrength {
        /// The strength k.
        k: usize,
        /// The number of parameters.
        parameters: usize,
    },
    /// The strength is out of range for the discrete parameters.
    #[error("k is {k}, expected a number from 1 to the number of discrete parameters, which is {parameters}")]
    Strength {
        /// The strength k.
        k: usize,
        /// The number of discrete parameters.
        parameters: usize,
    },
    /// Constraints make it impossible to compute the probability of a combination in random rows.
    #[error(
        "the constraints join too many parameters to compute a combination's probability, so a random family would \
         guarantee nothing; use ipog"
    )]
    RandomUnderConstraints,
    /// A covering array cannot be constructed.
    #[error(transparent)]
    Covering(#[from] CoveringError),
    /// The constraints of the space contradict each other, or cannot be decided.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// The delta is not a probability above 0 and below 1.
    #[error("delta is {0}; the probability of missing a combination must be above 0 and below 1")]
    Delta(f64),
    /// A delta was given for a family that misses no combination.
    #[error("only the family random has a delta, because it may miss combinations; `{family}` needs no delta")]
    NoDelta {
        /// The name of the family.
        family: &'static str,
    },
    /// The family has too many rows to run.
    #[error("the discrete family has {rows} rows, more than 10,000,000; {advice}")]
    FamilyTooLarge {
        /// The number of rows, in words.
        rows: String,
        /// Advice on how to get fewer rows.
        advice: &'static str,
    },
}
