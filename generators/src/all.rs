//! The list of all strategies, in the order in which they are shown.

use crate::{GeneratorError, Strategy, adaptive, sequence};
use paracosm_space::nearest;
use std::str::FromStr;

/// The purpose of a set of tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// The tests cover the space.
    Cover,
    /// The tests cover the space together with existing tests.
    Complete,
    /// The tests find a first failure with as few tests as possible.
    FirstFailure,
}

impl Strategy {
    /// Returns the default strategy for tests with the given purpose.
    pub const fn usual(purpose: Purpose) -> Self {
        match purpose {
            Purpose::Cover => Self::HALTON,
            Purpose::Complete => Self::GREEDY,
            Purpose::FirstFailure => Self::AUTO,
        }
    }

    /// Iterates over all strategies of this crate, in the order in which lists show the strategies.
    pub fn all() -> impl Iterator<Item = Self> {
        sequence::ALL.iter().chain(&[Self::BEST, Self::GREEDY, Self::GREEDY_PERIODIC]).chain(adaptive::ALL).copied()
    }
}

impl FromStr for Strategy {
    type Err = GeneratorError;

    fn from_str(name: &str) -> Result<Self, GeneratorError> {
        Self::all().chain([Self::GIVEN, Self::OWN]).find(|strategy| strategy.name() == name).ok_or_else(|| {
            GeneratorError::UnknownStrategy {
                name: name.to_owned(),
                nearest: nearest(name, Self::all().map(Self::name)),
            }
        })
    }
}
