//! What `greedy` is to make small.

use crate::GeneratorError;
use paracosm_space::nearest;
use std::str::FromStr;

/// What greedy tests are to make small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aim {
    /// The largest empty box over all continuous parameters, for every row of the discrete family on its own.
    Dispersion,
    /// The largest dispersion that any k parameters show, discrete and continuous ones: there are no rows then.
    KwiseDispersion,
}

impl Aim {
    /// Everything that can be aimed at.
    pub const ALL: [Self; 2] = [Self::Dispersion, Self::KwiseDispersion];

    /// The name of the measure.
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
