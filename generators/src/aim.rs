//! The measures that the strategy `greedy` can make small.

use crate::GeneratorError;
use paracosm_space::nearest;
use std::str::FromStr;

/// The measure that greedy tests make small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aim {
    /// The largest empty box over all continuous parameters, for each row of the discrete family separately.
    Dispersion,
    /// The largest dispersion that any k parameters show, discrete and continuous ones; no family of rows is used
    /// then.
    KwiseDispersion,
}

impl Aim {
    /// All measures that `greedy` can aim at.
    pub const ALL: [Self; 2] = [Self::Dispersion, Self::KwiseDispersion];

    /// Returns the name of the measure.
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
