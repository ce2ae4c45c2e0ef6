//! Errors of the construction of a covering array.

use paracosm_space::plural;
use thiserror::Error;

/// The reason why a covering array cannot be constructed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CoveringError {
    /// k is 0 or more than the number of parameters.
    #[error("k is {k}, expected a number from 1 to {parameters}, the number of discrete parameters")]
    Strength {
        /// The requested k.
        k: usize,
        /// The number of discrete parameters.
        parameters: usize,
    },
    /// A parameter has no level, so that no test exists.
    #[error("parameter {0} has no level, expected at least one")]
    NoLevel(usize),
    /// The strength of a group is 0 or more than the number of its parameters.
    #[error("group {group} has strength {strength}, expected 1 to {parameters}, the number of the group's parameters")]
    GroupStrength {
        /// The position of the group, from 0.
        group: usize,
        /// The requested strength of the group.
        strength: usize,
        /// The number of parameters of the group.
        parameters: usize,
    },
    /// A group names a parameter that does not exist, or names a parameter twice.
    #[error("group {group} names parameter {found}, expected different parameters below {parameters}")]
    GroupMember {
        /// The position of the group, from 0.
        group: usize,
        /// The position of the parameter.
        found: usize,
        /// The number of parameters.
        parameters: usize,
    },
    /// An existing test has too many or too few levels.
    #[error("test {index} has {}, expected {expected}", plural(*found, "level"))]
    Ragged {
        /// The position of the test, from 0.
        index: usize,
        /// The number of levels of the test.
        found: usize,
        /// The number of parameters.
        expected: usize,
    },
    /// An existing test has a level that the parameter does not have.
    #[error("test {index}, parameter {parameter}: found level {found}, expected a level below {levels}")]
    Level {
        /// The position of the test, from 0.
        index: usize,
        /// The position of the parameter, from 0.
        parameter: usize,
        /// The level of the test.
        found: usize,
        /// The number of levels of the parameter.
        levels: usize,
    },
    /// The deadline passed before the array was complete.
    #[error("the covering array was not complete at the deadline; allow more time or lower the strength")]
    OutOfTime,
    /// The array needs more tests than can be run.
    #[error("the covering array needs at least {rows} tests, more than {}; lower the strength", Self::MOST_ROWS)]
    TooLarge {
        /// The lower bound on the number of tests.
        rows: u128,
    },
}

impl CoveringError {
    /// The greatest lower bound for which an array is constructed.
    pub const MOST_ROWS: u128 = 10_000_000;
}
