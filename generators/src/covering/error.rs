//! Errors of the construction of a covering array.

use paracosm_space::plural;
use thiserror::Error;

/// The reason why a covering array cannot be constructed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CoveringError {
    /// The strength k is 0 or exceeds the number of discrete parameters.
    #[error("k is {k}, expected a number from 1 to {parameters}, the number of discrete parameters")]
    Strength {
        /// The requested strength k, which is the number of parameters in a combination.
        k: usize,
        /// The number of discrete parameters.
        parameters: usize,
    },
    /// The parameter at the given position has no level, so that no test exists.
    #[error("parameter {0} has no level, expected at least one")]
    NoLevel(usize),
    /// The strength of a group of parameters is 0 or exceeds the number of parameters in the group.
    #[error("group {group} has strength {strength}, expected 1 to {parameters}, the number of the group's parameters")]
    GroupStrength {
        /// The position of the wrong group among the groups, from 0.
        group: usize,
        /// The requested strength of the group.
        strength: usize,
        /// The number of parameters in the group.
        parameters: usize,
    },
    /// A group of parameters names a parameter that does not exist, or names a parameter twice.
    #[error("group {group} names parameter {found}, expected different parameters below {parameters}")]
    GroupMember {
        /// The position of the wrong group among the groups, from 0.
        group: usize,
        /// The position of the parameter that does not exist or occurs twice in the group.
        found: usize,
        /// The number of discrete parameters.
        parameters: usize,
    },
    /// The number of levels of an existing test differs from the number of parameters.
    #[error("test {index} has {}, expected {expected}", plural(*found, "level"))]
    Ragged {
        /// The position of the wrong test among the existing tests, from 0.
        index: usize,
        /// The number of levels of the wrong test.
        found: usize,
        /// The number of parameters, which is the expected number of levels.
        expected: usize,
    },
    /// An existing test has a level that does not exist for its parameter.
    #[error("test {index}, parameter {parameter}: found level {found}, expected a level below {levels}")]
    Level {
        /// The position of the wrong test among the existing tests, from 0.
        index: usize,
        /// The position of the parameter with the wrong level, from 0.
        parameter: usize,
        /// The wrong level in the test, which the parameter does not have.
        found: usize,
        /// The number of levels of the parameter.
        levels: usize,
    },
    /// The deadline passed before the covering array was complete.
    #[error("the covering array was not complete at the deadline; allow more time or lower the strength")]
    OutOfTime,
    /// The covering array needs more than [`CoveringError::MOST_ROWS`] tests.
    #[error("the covering array needs at least {rows} tests, more than {}; lower the strength", Self::MOST_ROWS)]
    TooLarge {
        /// The lower bound on the number of tests in the covering array.
        rows: u128,
    },
}

impl CoveringError {
    /// The limit for the lower bound on the number of tests; no covering array with a larger bound is constructed.
    pub const MOST_ROWS: u128 = 10_000_000;
}
