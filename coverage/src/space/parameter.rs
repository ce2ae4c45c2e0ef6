//! One parameter: its name, what values it takes, and its unit.

use super::{Shape, SpaceError, Value, signal};
use crate::Distribution;
use crate::names::nearest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;

/// What values a parameter takes.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// Any number from `lo` to `hi`: a continuous parameter.
    Interval {
        /// The lower end.
        lo: f64,
        /// The upper end.
        hi: f64,
    },
    /// One of these values: a discrete parameter.
    Choice(Vec<Value>),
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Domain::Interval { lo, hi } => write!(f, "a number in [{lo}, {hi}]"),
            Domain::Choice(levels) => {
                f.write_str("one of ")?;
                for (i, level) in levels.iter().enumerate() {
                    write!(f, "{}{level}", if i == 0 { "" } else { ", " })?;
                }
                Ok(())
            }
        }
    }
}

/// A named parameter of a [`Space`](super::Space).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Entry", into = "Entry")]
pub struct Parameter {
    /// The name by which a scenario asks for it.
    pub name: String,
    /// What values it takes.
    pub domain: Domain,
    /// The unit in which its values are read, for labels.
    pub unit: Option<String>,
    /// The nominal value: what it is where nobody varies it, and where shrinking goes.
    pub default: Option<Value>,
    /// How it varies over time; `None` of what is constant in each test.
    pub signal: Option<Shape>,
    /// How likely its values are, where a probability is asked for.
    pub distribution: Distribution,
}

impl Parameter {
    /// A parameter without unit and nominal value, constant over time.
    pub fn new(name: impl Into<String>, domain: Domain) -> Self {
        Self { name: name.into(), domain, unit: None, default: None, signal: None, distribution: Distribution::Uniform }
    }

    /// The values of a discrete parameter; `None` of a continuous one.
    pub fn levels(&self) -> Option<&[Value]> {
        match &self.domain {
            Domain::Interval { .. } => None,
            Domain::Choice(levels) => Some(levels),
        }
    }

    /// The position of a value among the levels: of the level that is written so, or the only one that is the same number.
    pub fn level(&self, value: &Value) -> Option<usize> {
        let levels = self.levels()?;
        levels.iter().position(|level| level == value).or_else(|| {
            let mut same = (0..levels.len()).filter(|&level| levels[level].means(value));
            same.next().filter(|_| same.next().is_none())
        })
    }

    /// The value at a coordinate in `[0,1]` of a continuous parameter.
    ///
    /// # Panics
    /// The parameter is discrete.
    pub fn value_at(&self, coordinate: f64) -> f64 {
        match self.domain {
            Domain::Interval { lo, hi } => super::at(lo, hi, coordinate),
            Domain::Choice(_) => panic!("parameter `{}` is discrete and has levels", self.name),
        }
    }

    /// The name with its unit, for an axis or a column: `speed (m/s)`.
    pub fn label(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} ({unit})", self.name),
            None => self.name.clone(),
        }
    }

    /// Checks that the parameter takes this value. A signal takes a list with a value for each coordinate, or a single
    /// value for one that never changes.
    ///
    /// # Errors
    /// It does not; the error says what it takes.
    pub fn check(&self, value: &Value) -> Result<(), SpaceError> {
        if let (Value::List(values), Some(shape)) = (value, self.signal) {
            if values.len() != shape.coordinates() {
                let (found, expected) = (values.len(), shape.coordinates());
                let message = format!("found {found} values, expected the {expected} of a signal {shape}");
                return Err(SpaceError::Signal { name: self.name.clone(), message });
            }
            return values.iter().try_for_each(|value| self.check_scalar(value));
        }
        self.check_scalar(value)
    }

    fn check_scalar(&self, value: &Value) -> Result<(), SpaceError> {
        let taken = match (&self.domain, value) {
            (Domain::Interval { lo, hi }, value) => value.number().is_some_and(|v| (*lo..=*hi).contains(&v)),
            (Domain::Choice(_), value) => self.level(value).is_some(),
        };
        if taken {
            return Ok(());
        }
        let words = self.levels().unwrap_or_default().iter().filter_map(Value::word);
        let meant = value.word().and_then(|word| nearest(word, words));
        Err(SpaceError::OutsideDomain {
            name: self.name.clone(),
            value: value.clone(),
            expected: self.domain.to_string(),
            nearest: meant.map(str::to_owned),
        })
    }

    pub(super) fn validate(&self) -> Result<(), SpaceError> {
        let name = || self.name.clone();
        match &self.domain {
            Domain::Interval { lo, hi } => {
                // Written so that NaN fails.
                if !(lo.is_finite() && hi.is_finite() && lo < hi) {
                    return Err(SpaceError::Interval { name: name(), lo: *lo, hi: *hi });
                }
            }
            Domain::Choice(levels) => {
                if levels.is_empty() {
                    return Err(SpaceError::EmptyChoice(name()));
                }
                // Two levels that are written alike could not be told apart in a file of tests.
                let mut written = BTreeSet::new();
                for level in levels {
                    if matches!(level, Value::List(_)) {
                        let message = format!("a choice is between numbers and words, found {level}");
                        return Err(SpaceError::Signal { name: name(), message });
                    }
                    if !written.insert(level.to_string()) {
                        return Err(SpaceError::SameLevel { name: name(), value: level.clone() });
                    }
                }
            }
        }
        self.signal.map_or(Ok(()), |shape| self.check_signal(shape))?;
        let distributed = self.distribution.check(&self.domain);
        distributed.map_err(|message| SpaceError::Distribution { name: name(), message })?;
        self.default.as_ref().map_or(Ok(()), |value| self.check(value))
    }
}

/// A parameter as files write it: `interval = [lo, hi]` or `choice = [..]`, beside its name.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entry {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    interval: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<Vec<Value>>,
    /// How the values of the choice are written, where the format would write some numbers otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    written: Option<Vec<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    default: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    signal: Option<signal::Entry>,
    #[serde(default, skip_serializing_if = "is_uniform")]
    distribution: Distribution,
}

fn is_uniform(distribution: &Distribution) -> bool {
    *distribution == Distribution::Uniform
}

impl Entry {
    /// An entry that says how its numbers are written, whatever the format makes of fractions.
    pub(super) fn spelled_out(parameter: Parameter) -> Self {
        let levels = parameter.levels().unwrap_or_default();
        let fraction = |level: &Value| level.number().is_some() && level.to_string().parse::<i64>().is_err();
        let written = levels.iter().any(fraction).then(|| levels.iter().map(ToString::to_string).collect());
        let entry = Self::from(parameter);
        Self { written: written.or(entry.written), ..entry }
    }
}

/// The levels of a choice as they are written.
fn as_written(choice: Vec<Value>, written: &[String]) -> Result<Vec<Value>, String> {
    if choice.len() != written.len() {
        return Err(format!("found {} texts in `written`, expected the {} of `choice`", written.len(), choice.len()));
    }
    let level = |(level, text): (Value, &String)| match Value::written(text) {
        number if level.number().is_some() && number.means(&level) => Ok(number),
        _ if level.to_string() == *text => Ok(level),
        _ => Err(format!("found `{text}` in `written`, expected the text of {level}")),
    };
    choice.into_iter().zip(written).map(level).collect()
}

impl TryFrom<Entry> for Parameter {
    type Error = String;

    fn try_from(entry: Entry) -> Result<Self, String> {
        let in_parameter = |message: String| format!("parameter `{}`: {message}", entry.name);
        let domain = match (entry.interval, entry.choice, entry.written) {
            (Some([lo, hi]), None, None) => Domain::Interval { lo, hi },
            (None, Some(levels), None) => Domain::Choice(levels),
            (None, Some(levels), Some(written)) => Domain::Choice(as_written(levels, &written).map_err(in_parameter)?),
            _ => {
                return Err(format!(
                    "parameter `{}`: expected either `interval = [lo, hi]` or `choice = [..]`",
                    entry.name
                ));
            }
        };
        let shape = entry.signal.map(|signal| signal.shape()).transpose();
        let signal = shape.map_err(in_parameter)?.flatten();
        let Entry { name, unit, default, distribution, .. } = entry;
        Ok(Self { name, domain, unit, default, signal, distribution })
    }
}

impl From<Parameter> for Entry {
    fn from(parameter: Parameter) -> Self {
        let (interval, choice) = match parameter.domain {
            Domain::Interval { lo, hi } => (Some([lo, hi]), None),
            Domain::Choice(levels) => (None, Some(levels)),
        };
        let levels = choice.as_deref().unwrap_or_default();
        let otherwise = levels.iter().any(|level| matches!(level, Value::Written(..)));
        let written = otherwise.then(|| levels.iter().map(ToString::to_string).collect());
        let Parameter { name, unit, default, distribution, .. } = parameter;
        Self { name, interval, choice, written, unit, default, signal: parameter.signal.map(Into::into), distribution }
    }
}
