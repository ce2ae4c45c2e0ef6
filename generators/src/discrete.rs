//! The families of rows that cover the discrete parameters, by name.

use crate::GeneratorError;
use paracosm_space::nearest;
use std::str::FromStr;

/// The method that makes the rows of discrete values, which together cover the discrete parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum DiscreteFamily {
    /// A covering array by the IPOG algorithm, whose few rows contain all valid combinations of values of any k
    /// parameters.
    #[default]
    Ipog,
    /// Uniformly random rows, as many as Proposition 3.2 of the paper requires. With probability at least `1 - delta`
    /// the rows contain all combinations of values of any k parameters. Under constraints, rows are drawn from the rows
    /// that satisfy them, and their number is that of the union bound with every combination's own probability.
    Random {
        /// The greatest probability, between 0 and 1, that the rows miss a valid combination.
        delta: f64,
    },
    /// All valid combinations of values of all discrete parameters. The last parameter changes fastest.
    Cross,
}

impl DiscreteFamily {
    const NAMES: [&'static str; 3] = ["ipog", "random", "cross"];

    /// The default probability that a family of random rows misses a valid combination.
    pub const DELTA: f64 = 0.05;

    /// Returns the name by which users ask for the family.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ipog => Self::NAMES[0],
            Self::Random { .. } => Self::NAMES[1],
            Self::Cross => Self::NAMES[2],
        }
    }

    /// Returns the family with `delta` as the probability that the random rows miss a combination; the family is
    /// unchanged if `delta` is `None`.
    ///
    /// # Errors
    /// A `delta` is given, but the family is not random, or `delta` is not a probability between 0 and 1.
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
