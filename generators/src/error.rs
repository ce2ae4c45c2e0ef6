//! Why a generator cannot be built; every message says what was found and what would have been right.

use crate::covering::CoveringError;
use paracosm_space::{SpaceError, did_you_mean};
use thiserror::Error;

/// Why a generator cannot be built.
#[derive(Debug, PartialEq, Error)]
pub enum GeneratorError {
    /// No strategy has that name.
    #[error("no strategy is called `{name}`{}", did_you_mean(.nearest))]
    UnknownStrategy {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// No discrete family has that name.
    #[error("no discrete family is called `{name}`{}; there are ipog, random and cross", did_you_mean(.nearest))]
    UnknownFamily {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// There is nothing to vary.
    #[error("the space has no parameters; a generator needs at least one")]
    EmptySpace,
    /// No test is wanted.
    #[error("the budget is 0 tests; a budget must be at least 1")]
    NoBudget,
    /// A start index for a strategy that has no order.
    #[error("`{strategy}` is no sequence and cannot skip; the sequences are {sequences}")]
    NoSequence {
        /// The strategy's name.
        strategy: &'static str,
        /// The names of those that can.
        sequences: String,
    },
    /// A number of continuous coordinates that the strategy is not made for.
    #[error("`{strategy}` is made for {made_for} continuous coordinates; the space has {dims}; use {instead}")]
    Dimensions {
        /// The strategy's name.
        strategy: &'static str,
        /// How many it is made for, in words.
        made_for: String,
        /// How many there are.
        dims: usize,
        /// A strategy that is made for as many.
        instead: &'static str,
    },
    /// Indices that a double no longer tells apart.
    #[error("`{strategy}` has indices below {len}; asked for index {last}; ask for fewer or skip fewer")]
    IndexLimit {
        /// The strategy's name.
        strategy: &'static str,
        /// How many points it has.
        len: u64,
        /// The last index asked for.
        last: u64,
    },
    /// A Latin hypercube that does not fit in memory, where it is kept whole.
    #[error(
        "a Latin hypercube is kept in memory, at most 10,000,000 coordinates; asked for {points} points in {dims} \
         dimensions; use halton"
    )]
    LhsLimit {
        /// How many points were asked for.
        points: u64,
        /// In how many dimensions.
        dims: usize,
    },
    /// A dispersion that cannot be reached or need not be.
    #[error("epsilon is {0}; the volume of an empty box must be above 0 and below 1")]
    Epsilon(f64),
    /// A set made for its size, where the size is to be found.
    #[error(
        "`{strategy}` makes its set for a number of tests, but epsilon asks for as many as it takes; use halton or greedy"
    )]
    Sized {
        /// The strategy's name.
        strategy: &'static str,
    },
    /// Rows without large holes, from a strategy that goes where tests fail.
    #[error(
        "`{strategy}` goes where tests fail and leaves holes elsewhere; epsilon asks for none: use halton or greedy"
    )]
    NoEpsilon {
        /// The strategy's name.
        strategy: &'static str,
    },
    /// A strategy that does not look at what is there.
    #[error("`{strategy}` does not look at existing tests and cannot extend them; use greedy")]
    NoExtension {
        /// The strategy's name.
        strategy: &'static str,
    },
    /// A measure for a strategy that does not look at any.
    #[error("`{strategy}` aims at no measure; greedy does")]
    NoAim {
        /// The strategy's name.
        strategy: &'static str,
    },
    /// No measure that can be aimed at has that name.
    #[error("greedy cannot aim at `{name}`{}; it can at dispersion and k-wise-dispersion", did_you_mean(.nearest))]
    UnknownAim {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// An existing test of another space.
    #[error("existing test {index} is none of the space")]
    Foreign {
        /// The test's position, from 0.
        index: usize,
    },
    /// More choices of k parameters than greedy can look after.
    #[error("there are more than {most} choices of {k} parameters with their values; use a smaller k")]
    Views {
        /// The strength.
        k: usize,
        /// How many there may be.
        most: usize,
    },
    /// A strength that the space cannot have, where all parameters count.
    #[error("k is {k}, but the space has {parameters} parameters; k must be from 1 to their number")]
    AllStrength {
        /// The strength.
        k: usize,
        /// The number of parameters.
        parameters: usize,
    },
    /// A strength that the space cannot have.
    #[error("k is {k}, but the space has {parameters} discrete parameters; k must be from 1 to their number")]
    Strength {
        /// The strength.
        k: usize,
        /// The number of discrete parameters.
        parameters: usize,
    },
    /// Random rows where nobody knows how probable a combination is.
    #[error(
        "the constraints join too many parameters to tell how probable a combination is, and a random family would \
         promise nothing; use ipog"
    )]
    RandomUnderConstraints,
    /// A covering array that cannot be.
    #[error(transparent)]
    Covering(#[from] CoveringError),
    /// Constraints that no test keeps.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// A probability of failure that is none.
    #[error("delta is {0}; a probability of failure must be above 0 and below 1")]
    Delta(f64),
    /// A probability of failure for a family that cannot fail.
    #[error("delta is the probability that random rows miss a combination; `{family}` misses none, use random")]
    NoDelta {
        /// The family's name.
        family: &'static str,
    },
    /// A family too large to run.
    #[error("the discrete family has {rows} rows, more than 10,000,000; {advice}")]
    FamilyTooLarge {
        /// How many rows, in words.
        rows: String,
        /// What gives fewer.
        advice: &'static str,
    },
}
