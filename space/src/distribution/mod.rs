//! How a parameter is distributed: what failure probabilities are taken under.
//!
//! Coverage and generators know nothing of it: to them every part of a domain is worth a look. Where a probability is
//! asked for, a uniform number becomes a value by the inverse of the distribution function, so that one source of
//! uniform numbers, random or quasi-random, serves all distributions.

mod beta;
mod normal;

pub use beta::{beta_cdf, beta_quantile};
pub use normal::{normal_cdf, normal_quantile};

use crate::names::{did_you_mean, nearest};
use crate::{Domain, Record, Value};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The names of all distributions, with what they take.
const NAMES: [(&str, &str); 5] = [
    ("uniform", "no numbers"),
    ("beta", "two numbers above 0, its shape"),
    ("normal", "two numbers, its mean and its standard deviation"),
    ("triangular", "one number, its mode"),
    ("weights", "a number for each value of a choice"),
];

/// Shapes of a beta distribution outside this range are a mistake.
const SHAPES: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// A normal distribution with less of it in the interval says nothing of what is there.
const LEAST_MASS: f64 = 1e-9;

/// A normal distribution that is so many times wider than the interval is uniform, as far as rounding lets one see.
const WIDEST: f64 = 100.0;

/// Why a text is no distribution, or why values of a domain cannot be distributed so.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum DistributionError {
    /// No distribution has that name.
    #[error("no distribution is called `{name}`{}; there are {}", did_you_mean(.nearest), NAMES.map(|(name, _)| name).join(", "))]
    Unknown {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// A distribution with too many or too few numbers.
    #[error("the distribution {name} takes {takes}, found {found} of them")]
    Numbers {
        /// The distribution.
        name: &'static str,
        /// The numbers that it takes, in words.
        takes: &'static str,
        /// How many were found.
        found: usize,
    },
    /// A word where a number belongs.
    #[error("found `{found}` in {within}, expected a number")]
    NoNumber {
        /// The word.
        found: String,
        /// The text or the entry that it stands in.
        within: String,
    },
    /// An entry of a file that names no distribution, or several.
    #[error("expected one distribution, such as {{ beta = [2.0, 5.0] }}")]
    NotOne,
    /// A number that is not finite.
    #[error("distribution {distribution}: found {number}, expected finite numbers")]
    Infinite {
        /// The distribution.
        distribution: Distribution,
        /// The number.
        number: f64,
    },
    /// Weights that are not one for each value.
    #[error("found {found} weights, expected one for each of the {expected} values")]
    WeightCount {
        /// How many weights there are.
        found: usize,
        /// How many values there are.
        expected: usize,
    },
    /// Weights below 0, or no weight above 0.
    #[error("distribution {0}: expected weights of at least 0, not all of them 0")]
    Weights(Distribution),
    /// A distribution of numbers for the values of a choice.
    #[error("found the distribution {0}, expected uniform or weights for the values of a choice")]
    ForInterval(Distribution),
    /// Weights for the numbers of an interval.
    #[error("found weights, which are for a choice, expected uniform, beta, normal or triangular")]
    ForChoice,
    /// Shapes of a beta distribution that are out of range.
    #[error("distribution {distribution}: expected shapes from {} to {}", SHAPES.start(), SHAPES.end())]
    Shapes {
        /// The distribution.
        distribution: Distribution,
    },
    /// A standard deviation that is out of range.
    #[error("distribution {distribution}: expected a deviation above 0 and at most {most}")]
    Deviation {
        /// The distribution.
        distribution: Distribution,
        /// The largest standard deviation for the interval.
        most: f64,
    },
    /// A normal distribution that lies elsewhere.
    #[error("distribution {distribution}: next to nothing of it lies in [{lo}, {hi}]")]
    Outside {
        /// The distribution.
        distribution: Distribution,
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
    /// A mode outside of the interval.
    #[error("distribution {distribution}: expected a mode in [{lo}, {hi}]")]
    Mode {
        /// The distribution.
        distribution: Distribution,
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
}

/// How the values of a parameter are distributed over its domain; of a signal each coordinate by itself.
///
/// As text, `uniform`, `beta:2,5`, `normal:1.4,0.3`, `triangular:1.4` or `weights:0.7,0.2,0.1`; in files
/// `{ beta = [2.0, 5.0] }` and likewise.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Entry", into = "Entry")]
pub enum Distribution {
    /// Every part of an interval by its length, every value of a choice as often as another.
    #[default]
    Uniform,
    /// The beta distribution of these shapes, stretched from `[0,1]` to the interval.
    Beta(f64, f64),
    /// The normal distribution of this mean and standard deviation, in the parameter's unit, given that it lies in the
    /// interval.
    Normal(f64, f64),
    /// A density that rises from the lower end of the interval to this mode, in the parameter's unit, and falls to the
    /// upper end.
    Triangular(f64),
    /// How likely each value of a choice is, in proportion.
    Weights(Vec<f64>),
}

impl Distribution {
    /// Checks that values of this domain can be distributed so.
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

    /// The coordinate in `[0,1]` of the interval below which a share `u` of the distribution lies.
    ///
    /// # Panics
    /// Values of an interval cannot be distributed so.
    pub(crate) fn quantile(&self, lo: f64, hi: f64, u: f64) -> f64 {
        // Rounding must not keep a test off the ends.
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

    /// The level of a choice among `levels` up to which a share `u` of the distribution lies; never one of weight 0.
    ///
    /// # Panics
    /// Values of a choice cannot be distributed so.
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

    /// The distribution of that name, with the numbers that it takes.
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

/// A distribution as files write it: its name, or its name with what it takes.
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
