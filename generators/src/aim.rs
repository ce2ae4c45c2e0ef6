//! The measures that the strategy `greedy` can make small.

use crate::GeneratorError;
use paracosm_space::nearest;
use std::str::FromStr;

/// The measure that the strategy `greedy` makes small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aim {
    /// The dispersion, which is the volume of the largest empty box, separately for each row of discrete values.
    Dispersion,
    /// The k-wise dispersion, which is the volume of the largest hole in the space of any k parameters. Discrete and
    /// continuous parameters count; no family of rows is used then.
    KwiseDispersion,
}

impl Aim {
    /// All measures that the strategy `greedy` can make small.
    pub const ALL: [Self; 2] = [Self::Dispersion, Self::KwiseDispersion];

    /// Returns the name of the measure that `greedy` makes small.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dispersion => "dispersion",
            Self::KwiseDispersion => "k-wise-dispersion",
        }
    }
}

impl FromStr for Aim {
    type Err = GeneratorError;

    fn from_str(name: &str) -> Result<Self, GeneratorError> {
        Self::ALL.into_iter().find(|aim| aim.name() == name).ok_or_else(|| GeneratorError::UnknownAim {
            name: name.to_owned(),
            nearest: nearest(name, Self::ALL.map(Self::name)),
        })
    }
}
