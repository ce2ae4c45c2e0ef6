//! The one list of strategies, in the order in which they are shown.

use crate::{GeneratorError, Strategy, adaptive, sequence};
use paracosm_space::nearest;
use std::str::FromStr;

/// The purpose of some tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// To cover the space.
    Cover,
    /// To cover the space beside tests that exist.
    Complete,
    /// To find a failure with few tests.
    FirstFailure,
}

impl Strategy {
    /// The strategy for a purpose, if nobody names one.
    pub const fn usual(purpose: Purpose) -> Self {
        match purpose {
            Purpose::Cover => Self::HALTON,
            Purpose::Complete => Self::GREEDY,
            Purpose::FirstFailure => Self::AUTO,
        }
    }

    /// All strategies that come with the software.
    pub fn all() -> impl Iterator<Item = Self> {
        sequence::ALL.iter().chain(&[Self::GREEDY]).chain(adaptive::ALL).copied()
    }
}

impl FromStr for Strategy {
    type Err = GeneratorError;

    fn from_str(name: &str) -> Result<Self, GeneratorError> {
        Self::all().find(|strategy| strategy.name() == name).ok_or_else(|| GeneratorError::UnknownStrategy {
            name: name.to_owned(),
            nearest: nearest(name, Self::all().map(Self::name)),
        })
    }
}
