//! Distributions of parameters. Probabilities of failure refer to them.
//!
//! Coverage and strategies ignore the distributions, since every part of a domain is worth testing. If a probability
//! is asked for, the inverse of the distribution function turns a uniform number into a value. One source of uniform
//! numbers, random or quasi-random, therefore serves all distributions.

mod beta;
mod normal;

pub use beta::{beta_cdf, beta_quantile};
pub use normal::{normal_cdf, normal_quantile};

use crate::names::{did_you_mean, nearest};
use crate::plural;
use crate::{Domain, Record, Value};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The names of all distributions, with the numbers that they take, in words.
const NAMES: [(&str, &str); 5] = [
    ("uniform", "no numbers"),
    ("beta", "two numbers above 0 (its shapes)"),
    ("normal", "two numbers (its mean and its standard deviation)"),
    ("triangular", "one number (its mode)"),
    ("weights", "a number for each value of a choice"),
];

/// The range of the shapes of a beta distribution. Shapes outside this range are a mistake.
const SHAPES: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// The least share of a normal distribution that has to lie in the interval. With less, the distribution says nothing
/// about the interval.
const LEAST_MASS: f64 = 1e-9;

/// The greatest standard deviation of a normal distribution, in widths of the interval. A wider distribution is
/// uniform up to rounding.
const WIDEST: f64 = 100.0;

/// The reason why a text is not a distribution, or why a distribution does not fit a domain.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum DistributionError {
    /// No distribution has the given name.
    #[error("no distribution is called `{name}`{}; the distributions are {}", did_you_mean(.nearest), NAMES.map(|(name, _)| name).join(", "))]
    Unknown {
        /// The given name, which is not the name of a distribution.
        name: String,
        /// The most similar name of a distribution, if a name is similar enough.
        nearest: Option<&'static str>,
    },
    /// A distribution is given too many or too few numbers.
    #[error("the distribution {name} takes {takes}, found {found}")]
    Numbers {
        /// The name of the distribution.
        name: &'static str,
        /// The numbers that the distribution takes, in words.
        takes: &'static str,
        /// The count of the numbers that are given to the distribution.
        found: usize,
    },
    /// A word stands in the place of a number.
    #[error("found `{found}` in {within}, expected a number")]
    NoNumber {
        /// The word that stands in the place of a number.
        found: String,
        /// The text or the entry that contains the word.
        within: String,
    },
    /// An entry of a file names no distribution, or several distributions.
    #[error("found no distribution or several, expected exactly one, such as {{ beta = [2.0, 5.0] }}")]
    NotOne,
    /// A distribution has a number that is not finite.
    #[error("distribution {distribution}: found {number}, expected finite numbers")]
    Infinite {
        /// The distribution that is refused.
        distribution: Distribution,
        /// The number that is not finite.
        number: f64,
    },
    /// The number of weights differs from the number of values of a choice.
    #[error("found {}, expected {expected}: a weight for each value", plural(*found, "weight"))]
    WeightCount {
        /// The number of weights that are given.
        found: usize,
        /// The number of values of the choice.
        expected: usize,
    },
    /// A weight is below 0, or no weight is above 0, or the sum of the weights is not finite.
    #[error("distribution {0}: expected weights of at least 0, with a finite sum above 0")]
    Weights(Distribution),
    /// A choice has a distribution that is only for intervals.
    #[error("found the distribution {0}, expected uniform or weights for the values of a choice")]
    ForInterval(Distribution),
    /// An interval has weights, which are only for choices.
    #[error("found weights for an interval, expected uniform, beta, normal or triangular; weights are for a choice")]
    ForChoice,
    /// A shape of a beta distribution is out of range.
    #[error("distribution {distribution}: expected shapes from {} to {}", SHAPES.start(), SHAPES.end())]
    Shapes {
        /// The distribution that is refused.
        distribution: Distribution,
    },
    /// The standard deviation of a normal distribution is out of range.
    #[error("distribution {distribution}: expected a standard deviation above 0 and at most {most}")]
    Deviation {
        /// The distribution that is refused.
        distribution: Distribution,
        /// The greatest standard deviation that the interval allows.
        most: f64,
    },
    /// Nearly all of a normal distribution lies outside of the interval.
    #[error(
        "distribution {distribution}: almost nothing of it lies in [{lo}, {hi}]; move the mean closer to the interval"
    )]
    Outside {
        /// The distribution that is refused.
        distribution: Distribution,
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
    /// The mode of a triangular distribution lies outside of the interval.
    #[error("distribution {distribution}: expected a mode in [{lo}, {hi}]")]
    Mode {
        /// The distribution that is refused.
        distribution: Distribution,
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
}

/// The probability distribution of a parameter's values over the parameter's domain. Each coordinate of a signal has
/// this distribution on its own.
///
/// As a text, a distribution is written `uniform`, `beta:2,5`, `normal:1.4,0.3`, `triangular:1.4` or
/// `weights:0.7,0.2,0.1`. In files it is written like `{ beta = [2.0, 5.0] }`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Entry", into = "Entry")]
pub enum Distribution {
    /// The uniform distribution over the parameter's domain. In an interval the probability is proportional to the
    /// length; in a choice all values are equally probable.
    #[default]
    Uniform,
    /// The beta distribution with the given two shapes, stretched from `[0,1]` to the interval of the parameter.
    Beta(f64, f64),
    /// The normal distribution with the given mean and standard deviation, restricted to the interval of the parameter.
    /// Both numbers are in the parameter's unit. The distribution is that of a normal number under the condition that
    /// it lies in the interval.
    Normal(f64, f64),
    /// The triangular distribution with the given mode, in the parameter's unit. The density rises from the lower end
    /// of the interval to the mode and falls to the upper end.
    Triangular(f64),
    /// The distribution of a choice with the given weight for each value. The probability of a value is proportional to
    /// its weight.
    Weights(Vec<f64>),
}

impl Distribution {
    /// Checks that the distribution fits this domain.
    pub(crate) fn check(&self, domain: &Domain) -> Result<(), DistributionError> {
        let numbers = self.numbers();
        let distribution = || self.clone();
        if let Some(&number) = numbers.iter().find(|number| !number.is_finite()) {
            return Err(DistributionError::Infinite { distribution: distribution(), number });
        }
        let wrong = match (self, domain) {
            (Self::Uniform, _) => return Ok(()),
            (Self::Weights(weights), Domain::Choice(levels)) => {
                let sum: f64 = weights.iter().sum();
                if weights.len() != levels.len() {
                    DistributionError::WeightCount { found: weights.len(), expected: levels.len() }
                } else if weights.iter().any(|weight| *weight < 0.0) || !(sum > 0.0 && sum.is_finite()) {
                    DistributionError::Weights(distribution())
                } else {
                    return Ok(());
                }
            }
            (_, Domain::Choice(_)) => DistributionError::ForInterval(distribution()),
            (Self::Weights(_), Domain::Interval { .. }) => DistributionError::ForChoice,
            (Self::Beta(a, b), Domain::Interval { .. }) => {
                if SHAPES.contains(a) && SHAPES.contains(b) {
                    return Ok(());
                }
                DistributionError::Shapes { distribution: distribution() }
            }
            (Self::Normal(mean, sd), &Domain::Interval { lo, hi }) => {
                let most = WIDEST * (hi - lo);
                if !(*sd > 0.0 && *sd <= most) {
                    DistributionError::Deviation { distribution: distribution(), most }
                } else if normal::Truncated::new(*mean, *sd, lo, hi).mass() < LEAST_MASS {
                    DistributionError::Outside { distribution: distribution(), lo, hi }
                } else {
                    return Ok(());
                }
            }
            (Self::Triangular(mode), &Domain::Interval { lo, hi }) => {
                if (lo..=hi).contains(mode) {
                    return Ok(());
                }
                DistributionError::Mode { distribution: distribution(), lo, hi }
            }
        };
        Err(wrong)
    }

    /// Returns the quantile of the distribution as a coordinate in `[0,1]` of the interval: a share `u` of the
    /// distribution lies below it.
    ///
    /// # Panics
    /// The distribution is only for choices.
    pub(crate) fn quantile(&self, lo: f64, hi: f64, u: f64) -> f64 {
        // Rounding must not keep tests away from the ends of the interval.
        if u <= 0.0 || u >= 1.0 {
            return u.clamp(0.0, 1.0);
        }
        match self {
            Self::Uniform => u,
            Self::Beta(a, b) => beta_quantile(*a, *b, u),
            Self::Normal(mean, sd) => normal::Truncated::new(*mean, *sd, lo, hi).quantile(u),
            Self::Triangular(mode) => {
                let mode = (mode - lo) / (hi - lo);
                if u < mode { (u * mode).sqrt() } else { 1.0 - ((1.0 - u) * (1.0 - mode)).sqrt() }
            }
            Self::Weights(_) => panic!("weights are for a choice"),
        }
    }

    /// Returns the level of a choice with `levels` values up to which a share `u` of the distribution lies. The level
    /// never has the weight 0.
    ///
    /// # Panics
    /// The distribution is only for intervals.
    pub(crate) fn level(&self, levels: usize, u: f64) -> usize {
        match self {
            Self::Uniform => ((u * levels as f64) as usize).min(levels - 1),
            Self::Weights(weights) => {
                let mut left = u * weights.iter().sum::<f64>();
                let mut found = 0;
                for (level, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
                    found = level;
                    if left < *weight {
                        break;
                    }
                    left -= weight;
                }
                found
            }
            _ => panic!("{self} is for an interval"),
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Beta(..) => "beta",
            Self::Normal(..) => "normal",
            Self::Triangular(_) => "triangular",
            Self::Weights(_) => "weights",
        }
    }

    fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Uniform => Vec::new(),
            Self::Beta(a, b) | Self::Normal(a, b) => vec![*a, *b],
            Self::Triangular(mode) => vec![*mode],
            Self::Weights(weights) => weights.clone(),
        }
    }

    /// Returns the distribution of this name with these numbers.
    fn named(name: &str, numbers: &[f64]) -> Result<Self, DistributionError> {
        match (name, numbers) {
            ("uniform", []) => Ok(Self::Uniform),
            ("beta", &[a, b]) => Ok(Self::Beta(a, b)),
            ("normal", &[mean, sd]) => Ok(Self::Normal(mean, sd)),
            ("triangular", &[mode]) => Ok(Self::Triangular(mode)),
            ("weights", [_, ..]) => Ok(Self::Weights(numbers.to_vec())),
            _ => Err(match NAMES.iter().find(|(known, _)| *known == name) {
                Some(&(name, takes)) => DistributionError::Numbers { name, takes, found: numbers.len() },
                None => {
                    let nearest = nearest(name, NAMES.map(|(name, _)| name));
                    DistributionError::Unknown { name: name.to_owned(), nearest }
                }
            }),
        }
    }
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())?;
        let numbers: Vec<String> = self.numbers().iter().map(f64::to_string).collect();
        if numbers.is_empty() { Ok(()) } else { write!(f, "({})", numbers.join(", ")) }
    }
}

impl FromStr for Distribution {
    type Err = DistributionError;

    fn from_str(text: &str) -> Result<Self, DistributionError> {
        let (name, numbers) = text.split_once(':').unwrap_or((text, ""));
        let numbers = numbers.split(',').filter(|_| !numbers.is_empty()).map(|number| {
            let wrong = |_| DistributionError::NoNumber { found: number.to_owned(), within: format!("`{text}`") };
            number.trim().parse().map_err(wrong)
        });
        Self::named(name.trim(), &numbers.collect::<Result<Vec<f64>, DistributionError>>()?)
    }
}

/// A distribution as it is written in files: a name, or a name with the numbers that the distribution takes.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "a distribution such as \"uniform\" or { beta = [2.0, 5.0] }")]
enum Entry {
    Name(String),
    With(Record<Value>),
}

impl TryFrom<Entry> for Distribution {
    type Error = DistributionError;

    fn try_from(entry: Entry) -> Result<Self, DistributionError> {
        let entry = match entry {
            Entry::Name(name) => return Self::named(&name, &[]),
            Entry::With(entry) => entry,
        };
        let mut entries = entry.iter();
        let (Some((name, value)), None) = (entries.next(), entries.next()) else {
            return Err(DistributionError::NotOne);
        };
        let wrong = |value: &Value| DistributionError::NoNumber { found: value.to_string(), within: name.to_owned() };
        let number = |value: &Value| value.number().ok_or_else(|| wrong(value));
        Self::named(name, &value.scalars().iter().map(number).collect::<Result<Vec<f64>, DistributionError>>()?)
    }
}

impl From<Distribution> for Entry {
    fn from(distribution: Distribution) -> Self {
        let value = match &distribution {
            Distribution::Uniform => return Self::Name(distribution.name().to_owned()),
            Distribution::Triangular(mode) => Value::Number(*mode),
            _ => distribution.numbers().into_iter().collect(),
        };
        Self::With([(distribution.name().to_owned(), value)].into_iter().collect())
    }
}

#[cfg(test)]
mod tests;
