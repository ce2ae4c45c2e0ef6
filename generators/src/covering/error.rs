//! Why a covering array cannot be constructed.

use paracosm_space::plural;
use thiserror::Error;

/// Why a covering array cannot be constructed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CoveringError {
    /// There are no sets of k parameters.
    #[error("k is {k}, expected 1 to {parameters}, the number of discrete parameters")]
    Strength {
        /// The k asked for.
        k: usize,
        /// The number of parameters.
        parameters: usize,
    },
    /// A parameter that no test can have.
    #[error("parameter {0} has no level")]
    NoLevel(usize),
    /// There are no sets of so many parameters in a group.
    #[error("group {group} has strength {strength}, expected 1 to {parameters}, the number of its parameters")]
    GroupStrength {
        /// The group's position, from 0.
        group: usize,
        /// The strength asked for.
        strength: usize,
        /// The number of parameters of the group.
        parameters: usize,
    },
    /// A group with a parameter that does not exist, or with one twice.
    #[error("group {group} names parameter {found}, expected each once, below {parameters}")]
    GroupMember {
        /// The group's position, from 0.
        group: usize,
        /// The position of the parameter.
        found: usize,
        /// The number of parameters.
        parameters: usize,
    },
    /// An existing test with too many or too few levels.
    #[error("test {index} has {}, expected {expected}", plural(*found, "level"))]
    Ragged {
        /// The test's position, from 0.
        index: usize,
        /// How many levels it has.
        found: usize,
        /// The number of parameters.
        expected: usize,
    },
    /// A level that the parameter does not have.
    #[error("test {index}, parameter {parameter}: level {found}, expected one below {levels}")]
    Level {
        /// The test's position, from 0.
        index: usize,
        /// The parameter's position, from 0.
        parameter: usize,
        /// The level found.
        found: usize,
        /// How many levels the parameter has.
        levels: usize,
    },
    /// The construction was given up.
    #[error("the covering array was not complete in time")]
    OutOfTime,
    /// More tests than can be run.
    #[error("at least {rows} tests are needed, more than {}; lower the strength", Self::MOST_ROWS)]
    TooLarge {
        /// The lower bound.
        rows: u128,
    },
}

impl CoveringError {
    /// The largest lower bound of an array that is constructed.
    pub const MOST_ROWS: u128 = 10_000_000;
}
