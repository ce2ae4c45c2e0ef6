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
    ///
    /// # Errors
    /// What was found and what was expected.
    pub(crate) fn check(&self, domain: &Domain) -> Result<(), String> {
        let numbers = self.numbers();
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            return Err(format!("distribution {self}: found {number}, expected finite numbers"));
        }
        match (self, domain) {
            (Self::Uniform, _) => Ok(()),
            (Self::Weights(weights), Domain::Choice(levels)) => {
                if weights.len() != levels.len() {
                    let (found, expected) = (weights.len(), levels.len());
                    return Err(format!("found {found} weights, expected one for each of the {expected} values"));
                }
                let sum: f64 = weights.iter().sum();
                if weights.iter().any(|weight| *weight < 0.0) || !(sum > 0.0 && sum.is_finite()) {
                    return Err(format!("distribution {self}: expected weights of at least 0, not all of them 0"));
                }
                Ok(())
            }
            (_, Domain::Choice(_)) => {
                Err(format!("found the distribution {self}, expected uniform or weights for the values of a choice"))
            }
            (Self::Weights(_), Domain::Interval { .. }) => {
                Err("found weights, which are for a choice, expected uniform, beta, normal or triangular".to_owned())
            }
            (Self::Beta(a, b), Domain::Interval { .. }) => {
                if SHAPES.contains(a) && SHAPES.contains(b) {
                    return Ok(());
                }
                Err(format!("distribution {self}: expected shapes from {} to {}", SHAPES.start(), SHAPES.end()))
            }
            (Self::Normal(mean, sd), Domain::Interval { lo, hi }) => {
                let most = WIDEST * (hi - lo);
                if !(*sd > 0.0 && *sd <= most) {
                    return Err(format!("distribution {self}: expected a deviation above 0 and at most {most}"));
                }
                let mass = normal::Truncated::new(*mean, *sd, *lo, *hi).mass();
                if mass < LEAST_MASS {
                    return Err(format!("distribution {self}: next to nothing of it lies in [{lo}, {hi}]"));
                }
                Ok(())
            }
            (Self::Triangular(mode), Domain::Interval { lo, hi }) => {
                if (lo..=hi).contains(&mode) {
                    return Ok(());
                }
                Err(format!("distribution {self}: expected a mode in [{lo}, {hi}]"))
            }
        }
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
    fn named(name: &str, numbers: &[f64]) -> Result<Self, String> {
        match (name, numbers) {
            ("uniform", []) => Ok(Self::Uniform),
            ("beta", &[a, b]) => Ok(Self::Beta(a, b)),
            ("normal", &[mean, sd]) => Ok(Self::Normal(mean, sd)),
            ("triangular", &[mode]) => Ok(Self::Triangular(mode)),
            ("weights", [_, ..]) => Ok(Self::Weights(numbers.to_vec())),
            _ => Err(match NAMES.iter().find(|(known, _)| *known == name) {
                Some((_, takes)) => {
                    format!("the distribution {name} takes {takes}, found {} of them", numbers.len())
                }
                None => {
                    let names = NAMES.map(|(name, _)| name);
                    let hint = did_you_mean(&nearest(name, names));
                    format!("no distribution is called `{name}`{hint}; there are {}", names.join(", "))
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
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, numbers) = text.split_once(':').unwrap_or((text, ""));
        let numbers = numbers.split(',').filter(|_| !numbers.is_empty()).map(|number| {
            number.trim().parse().map_err(|_| format!("found `{number}` in `{text}`, expected a number"))
        });
        Self::named(name.trim(), &numbers.collect::<Result<Vec<f64>, String>>()?)
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
    type Error = String;

    fn try_from(entry: Entry) -> Result<Self, String> {
        let entry = match entry {
            Entry::Name(name) => return Self::named(&name, &[]),
            Entry::With(entry) => entry,
        };
        let mut entries = entry.iter();
        let (Some((name, value)), None) = (entries.next(), entries.next()) else {
            return Err("expected one distribution, such as { beta = [2.0, 5.0] }".to_owned());
        };
        let number = |value: &Value| value.number().ok_or(format!("found `{value}` in {name}, expected a number"));
        Self::named(name, &value.scalars().iter().map(number).collect::<Result<Vec<f64>, String>>()?)
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
