//! Distributions of parameters. Probabilities of failure refer to them.
//!
//! Coverage and strategies ignore the distributions, since every part of a domain is worth testing. If a probability
//! is asked for, the inverse of the distribution function turns a uniform number into a value. One source of uniform
//! numbers, random or quasi-random, therefore serves all distributions.

mod beta;
mod error;
mod histogram;
mod normal;
mod part;

pub use beta::{beta_cdf, beta_quantile};
pub use error::DistributionError;
pub use normal::{normal_cdf, normal_quantile};

use crate::names::nearest;
use crate::{Domain, Record, Value};
use histogram::Bins;
use normal::Truncated;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The names of all distributions, with the numbers that they take, in words.
const NAMES: [(&str, &str); 7] = [
    ("uniform", "no numbers"),
    ("beta", "two numbers above 0 (its shapes)"),
    ("normal", "two numbers (its mean and its standard deviation)"),
    ("lognormal", "two numbers (the mean and the standard deviation of the logarithm)"),
    ("triangular", "one number (its mode)"),
    ("histogram", "an odd number of numbers, at least three (edges, with a weight between each two edges)"),
    (WEIGHTS, "a number for each value of a choice"),
];

/// The name of the distribution of a choice.
const WEIGHTS: &str = "weights";

/// The range of the shapes of a beta distribution. Shapes outside this range are a mistake.
const SHAPES: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// The least share of a distribution that has to lie in the interval. With less, the distribution says nothing about the
/// interval.
const LEAST_MASS: f64 = 1e-9;

/// The greatest standard deviation of a normal distribution, in widths of the interval. A wider distribution is
/// uniform up to rounding.
const WIDEST: f64 = 100.0;

/// The greatest standard deviation of the logarithm of a lognormal number.
const WIDEST_LOGARITHM: f64 = 100.0;

/// The probability distribution of a parameter's values over the parameter's domain. Each coordinate of a signal has
/// this distribution on its own.
///
/// As a text, a distribution is written `uniform`, `beta:2,5`, `normal:1.4,0.3`, `lognormal:0.3,0.2`, `triangular:1.4`,
/// `histogram:0,1,5,3,10` or `weights:0.7,0.2,0.1`. In files it is written like `{ beta = [2.0, 5.0] }`.
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
    /// The distribution of a number whose natural logarithm has the normal distribution with the given mean and standard
    /// deviation, restricted to the interval of the parameter.
    LogNormal(f64, f64),
    /// The triangular distribution with the given mode, in the parameter's unit. The density rises from the lower end
    /// of the interval to the mode and falls to the upper end.
    Triangular(f64),
    /// The distribution with a constant density in each bin of a histogram, restricted to the interval of the parameter.
    /// The numbers are an edge, a weight, an edge, a weight and so on, up to the last edge. The edges are in the
    /// parameter's unit and ascend. The probability of a bin is proportional to its weight.
    Histogram(Vec<f64>),
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
            (Self::Normal(mean, sd) | Self::LogNormal(mean, sd), &Domain::Interval { lo, hi }) => {
                let [from, to] = [lo, hi].map(|end| self.scaled(end));
                let most = if matches!(self, Self::Normal(..)) { WIDEST * (hi - lo) } else { WIDEST_LOGARITHM };
                if !(*sd > 0.0 && *sd <= most) {
                    DistributionError::Deviation { distribution: distribution(), most }
                } else if Truncated::new(*mean, *sd, from, to).mass() < LEAST_MASS {
                    DistributionError::Outside { distribution: distribution(), lo, hi }
                } else {
                    return Ok(());
                }
            }
            (Self::Histogram(numbers), &Domain::Interval { lo, hi }) => match Bins::new(numbers) {
                None => DistributionError::Edges(distribution()),
                Some(bins) if !bins.has_weights() => DistributionError::Weights(distribution()),
                Some(bins) if bins.share(lo, hi) < LEAST_MASS => {
                    DistributionError::Outside { distribution: distribution(), lo, hi }
                }
                Some(_) => return Ok(()),
            },
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
        // Rounding must not keep tests away from the ends of the interval. A histogram may begin or end with empty bins.
        let reaches_the_ends = !matches!(self, Self::Histogram(_));
        if reaches_the_ends && !(0.0 < u && u < 1.0) {
            return u.clamp(0.0, 1.0);
        }
        match self {
            Self::Uniform => u,
            Self::Beta(a, b) => beta_quantile(*a, *b, u),
            Self::Normal(mean, sd) => Truncated::new(*mean, *sd, lo, hi).quantile(u),
            Self::LogNormal(mean, sd) => {
                let [from, to] = [lo, hi].map(|end| self.scaled(end));
                let number = libm::exp(mean + sd * Truncated::new(*mean, *sd, from, to).deviations(u));
                ((number - lo) / (hi - lo)).clamp(0.0, 1.0)
            }
            Self::Histogram(numbers) => {
                let bins = Bins::new(numbers).expect("spaces check their distributions");
                ((bins.quantile(lo, hi, u) - lo) / (hi - lo)).clamp(0.0, 1.0)
            }
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

    /// Returns a number on the scale on which a normal or lognormal distribution is normal.
    fn scaled(&self, number: f64) -> f64 {
        if matches!(self, Self::LogNormal(..)) { libm::log(number.max(0.0)) } else { number }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Beta(..) => "beta",
            Self::Normal(..) => "normal",
            Self::LogNormal(..) => "lognormal",
            Self::Triangular(_) => "triangular",
            Self::Histogram(_) => "histogram",
            Self::Weights(_) => WEIGHTS,
        }
    }

    fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Uniform => Vec::new(),
            Self::Beta(a, b) | Self::Normal(a, b) | Self::LogNormal(a, b) => vec![*a, *b],
            Self::Triangular(mode) => vec![*mode],
            Self::Histogram(numbers) | Self::Weights(numbers) => numbers.clone(),
        }
    }

    /// Returns the distribution of this name with these numbers.
    fn named(name: &str, numbers: &[f64]) -> Result<Self, DistributionError> {
        match (name, numbers) {
            ("uniform", []) => Ok(Self::Uniform),
            ("beta", &[a, b]) => Ok(Self::Beta(a, b)),
            ("normal", &[mean, sd]) => Ok(Self::Normal(mean, sd)),
            ("lognormal", &[mean, sd]) => Ok(Self::LogNormal(mean, sd)),
            ("triangular", &[mode]) => Ok(Self::Triangular(mode)),
            ("histogram", [_, _, _, ..]) if numbers.len() % 2 == 1 => Ok(Self::Histogram(numbers.to_vec())),
            (WEIGHTS, [_, ..]) => Ok(Self::Weights(numbers.to_vec())),
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
