//! How the discrete parameters are covered: the families of rows by name.

use crate::GeneratorError;
use paracosm_space::nearest;
use std::str::FromStr;

/// How the discrete parameters are covered.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum DiscreteFamily {
    /// A covering array by IPOG: all valid combinations of values of any k parameters are among its rows, which are few.
    #[default]
    Ipog,
    /// As many uniformly random rows as Proposition 3.2 of the paper asks for: all combinations of values of any
    /// k parameters are among them with probability at least `1 - delta`. Under constraints rows are drawn from those
    /// that keep them, and there are as many as the union bound asks for with every combination's own probability.
    Random {
        /// The probability, between 0 and 1, that one is missing.
        delta: f64,
    },
    /// Every valid combination of all parameters, the last one changing fastest.
    Cross,
}

impl DiscreteFamily {
    const NAMES: [&'static str; 3] = ["ipog", "random", "cross"];

    /// The probability with which a random family may miss a combination, where nothing is said.
    pub const DELTA: f64 = 0.05;

    /// The name by which users ask for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ipog => Self::NAMES[0],
            Self::Random { .. } => Self::NAMES[1],
            Self::Cross => Self::NAMES[2],
        }
    }

    /// The same family with this probability that it misses a combination, if one is given.
    ///
    /// # Errors
    /// One is given, and the family is not random or it is no probability between 0 and 1.
    pub fn with_delta(self, delta: Option<f64>) -> Result<Self, GeneratorError> {
        match (self, delta) {
            (family, None) => Ok(family),
            (Self::Random { .. }, Some(delta)) if delta > 0.0 && delta < 1.0 => Ok(Self::Random { delta }),
            (Self::Random { .. }, Some(delta)) => Err(GeneratorError::Delta(delta)),
            (family, Some(_)) => Err(GeneratorError::NoDelta { family: family.name() }),
        }
    }
}

impl FromStr for DiscreteFamily {
    type Err = GeneratorError;

    fn from_str(name: &str) -> Result<Self, GeneratorError> {
        match name {
            "ipog" => Ok(Self::Ipog),
            "random" => Ok(Self::Random { delta: Self::DELTA }),
            "cross" => Ok(Self::Cross),
            _ => Err(GeneratorError::UnknownFamily { name: name.to_owned(), nearest: nearest(name, Self::NAMES) }),
        }
    }
}
