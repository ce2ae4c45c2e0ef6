//! A parameter: its name, its values, its unit and its distribution.

use crate::distribution::DistributionError;
use crate::domain::at;
use crate::names::{did_you_mean, nearest};
use crate::plural;
use crate::shape::{self, ShapeError};
use crate::{Distribution, Domain, Shape, Value};
use serde::de::{Error as _, IgnoredAny};
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeSet;
use thiserror::Error;

/// The greatest number of coordinates of a signal. A larger number is a mistake.
const MOST_COORDINATES: usize = 1_000_000;

/// An error in a parameter, or in a value of a parameter.
#[derive(Debug, Clone, Error, PartialEq)]
#[error("parameter `{name}`: {flaw}")]
pub struct ParameterError {
    /// The name of the parameter.
    pub name: String,
    /// The kind of the error, with its details.
    pub flaw: ParameterFlaw,
}

/// A kind of error in a parameter, or in a value of a parameter.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum ParameterFlaw {
    /// The lower end of an interval is not below its upper end, or an end is not a finite number.
    #[error("found the interval [{lo}, {hi}], expected two finite numbers, the first below the second")]
    Interval {
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
    /// A choice has no values.
    #[error("a choice needs at least one value")]
    EmptyChoice,
    /// A choice names a value twice.
    #[error("the choice names {value} twice")]
    SameLevel {
        /// The value that the choice names twice.
        value: Value,
    },
    /// A choice has a list as a value.
    #[error("found the list {value} in a choice, expected numbers and words")]
    ListLevel {
        /// The list that stands among the values of the choice.
        value: Value,
    },
    /// A signal has no coordinate, or too many coordinates.
    #[error("the signal {shape} has {found} coordinates, expected 1 to {MOST_COORDINATES}")]
    Coordinates {
        /// The shape of the signal.
        shape: Shape,
        /// The number of coordinates of the signal.
        found: usize,
    },
    /// A piecewise signal has no piece.
    #[error("a signal needs at least one piece")]
    NoPiece,
    /// A discrete parameter has a smooth signal. The values of a choice cannot change smoothly.
    #[error("found a signal of the shape {shape} for a choice, expected the shape piecewise-constant")]
    SmoothChoice {
        /// The shape of the signal.
        shape: Shape,
    },
    /// The number of values in a list differs from the number of coordinates of the signal.
    #[error("found {}, expected {expected} for a signal of shape {shape}", plural(*found, "value"))]
    SignalLength {
        /// The number of values in the list.
        found: usize,
        /// The number of coordinates of the signal.
        expected: usize,
        /// The shape of the signal.
        shape: Shape,
    },
    /// The distribution does not fit the domain of the parameter.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// A value is no whole number, but its parameter takes only whole numbers.
    #[error("found {value}, expected a whole number")]
    NotWhole {
        /// The value that is no whole number.
        value: Value,
    },
    /// A value lies outside the domain of its parameter.
    #[error("found {value}, expected {expected}{}", did_you_mean(.nearest))]
    OutsideDomain {
        /// The value that the parameter cannot take.
        value: Value,
        /// The domain of the parameter.
        expected: Domain,
        /// The most similar level of the parameter, if a level is similar enough.
        nearest: Option<String>,
    },
}

/// A named quantity of a [`Space`](crate::Space) that tests vary, with its values, unit and distribution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Entry", into = "Entry")]
pub struct Parameter {
    /// The name that scenarios use to read the parameter.
    pub name: String,
    /// The set of values that the parameter can take.
    pub domain: Domain,
    /// The unit of the parameter's values, for labels.
    pub unit: Option<String>,
    /// The nominal value, which the parameter has if nobody varies the parameter. Shrinking moves the parameter towards
    /// this value.
    pub default: Option<Value>,
    /// The shape of the signal if the parameter varies over time, or `None` if the parameter is constant in each test.
    pub signal: Option<Shape>,
    /// The probability distribution of the parameter's values. It is used if a probability is asked for.
    pub distribution: Distribution,
}

impl Parameter {
    /// Makes a parameter without unit and nominal value that is constant over time.
    pub fn new(name: impl Into<String>, domain: Domain) -> Self {
        Self { name: name.into(), domain, unit: None, default: None, signal: None, distribution: Distribution::Uniform }
    }

    /// Returns the values of a discrete parameter, or `None` if the parameter is continuous.
    pub fn levels(&self) -> Option<&[Value]> {
        match &self.domain {
            Domain::Interval { .. } => None,
            Domain::Choice(levels) => Some(levels),
        }
    }

    /// Returns the position of a value among the levels of a discrete parameter. This is the level that is written in
    /// the same way, or else the only level that is the same number.
    pub fn level(&self, value: &Value) -> Option<usize> {
        let levels = self.levels()?;
        levels.iter().position(|level| level == value).or_else(|| {
            let mut same = (0..levels.len()).filter(|&level| levels[level].means(value));
            same.next().filter(|_| same.next().is_none())
        })
    }

    /// Returns the value of a continuous parameter at a coordinate in `[0,1]`.
    ///
    /// # Panics
    /// The parameter is discrete.
    pub fn value_at(&self, coordinate: f64) -> f64 {
        match self.domain {
            Domain::Interval { lo, hi } => at(lo, hi, coordinate),
            Domain::Choice(_) => panic!("parameter `{}` is discrete and has levels", self.name),
        }
    }

    /// Returns the name of the parameter with its unit for an axis or a column, such as `speed (m/s)`.
    pub fn label(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} ({unit})", self.name),
            None => self.name.clone(),
        }
    }

    /// Checks that the parameter can take the given value. A signal takes a list with a value for each coordinate, or a
    /// single value if the signal never changes.
    ///
    /// # Errors
    /// The parameter does not take the value. The error says which values it takes.
    pub fn check(&self, value: &Value) -> Result<(), ParameterError> {
        if let (Value::List(values), Some(shape)) = (value, self.signal) {
            let (found, expected) = (values.len(), shape.coordinates());
            if found != expected {
                return Err(self.wrong(ParameterFlaw::SignalLength { found, expected, shape }));
            }
            return values.iter().try_for_each(|value| self.check_scalar(value));
        }
        self.check_scalar(value)
    }

    fn check_scalar(&self, value: &Value) -> Result<(), ParameterError> {
        let taken = match (&self.domain, value) {
            (Domain::Interval { lo, hi }, value) => value.number().is_some_and(|v| (*lo..=*hi).contains(&v)),
            (Domain::Choice(_), value) => self.level(value).is_some(),
        };
        if taken {
            return Ok(());
        }
        let words = self.levels().unwrap_or_default().iter().filter_map(Value::word);
        let nearest = value.word().and_then(|word| nearest(word, words)).map(str::to_owned);
        let (value, expected) = (value.clone(), self.domain.clone());
        Err(self.wrong(ParameterFlaw::OutsideDomain { value, expected, nearest }))
    }

    pub(crate) fn validate(&self) -> Result<(), ParameterError> {
        match &self.domain {
            &Domain::Interval { lo, hi } => {
                // Written in this way, the condition also rejects NaN.
                if !(lo.is_finite() && hi.is_finite() && lo < hi) {
                    return Err(self.wrong(ParameterFlaw::Interval { lo, hi }));
                }
            }
            Domain::Choice(levels) => {
                if levels.is_empty() {
                    return Err(self.wrong(ParameterFlaw::EmptyChoice));
                }
                // A file of tests could not tell two levels apart that are written alike.
                let mut written = BTreeSet::new();
                for level in levels {
                    if matches!(level, Value::List(_)) {
                        return Err(self.wrong(ParameterFlaw::ListLevel { value: level.clone() }));
                    }
                    if !written.insert(level.to_string()) {
                        return Err(self.wrong(ParameterFlaw::SameLevel { value: level.clone() }));
                    }
                }
            }
        }
        self.signal.map_or(Ok(()), |shape| self.check_signal(shape))?;
        self.distribution.check(&self.domain).map_err(|error| self.wrong(error))?;
        self.default.as_ref().map_or(Ok(()), |value| self.check(value))
    }

    /// Returns the number of coordinates of the parameter in a test, which is 1 unless the parameter is a signal.
    pub fn coordinates(&self) -> usize {
        self.signal.map_or(1, Shape::coordinates)
    }

    /// Returns a value of the parameter as a list with a value for each coordinate. For a signal, a single value stands
    /// for a signal that never changes.
    ///
    /// # Errors
    /// The value is not in the domain, or it is a list whose length differs from the number of coordinates.
    pub fn scalars(&self, value: &Value) -> Result<Vec<Value>, ParameterError> {
        self.check(value)?;
        Ok(match value {
            Value::List(values) => values.to_vec(),
            value => vec![value.clone(); self.coordinates()],
        })
    }

    /// Checks that the parameter can be a signal of the given shape.
    ///
    /// # Errors
    /// The shape has no piece or too many coordinates, or the parameter is a choice and the shape is not piecewise
    /// constant.
    pub fn check_signal(&self, shape: Shape) -> Result<(), ParameterError> {
        let found = shape.coordinates();
        match shape {
            _ if !(1..=MOST_COORDINATES).contains(&found) => {
                Err(self.wrong(ParameterFlaw::Coordinates { shape, found }))
            }
            Shape::PiecewiseLinear { pieces: 0 } => Err(self.wrong(ParameterFlaw::NoPiece)),
            Shape::Polynomial { .. } | Shape::PiecewiseLinear { .. } if self.levels().is_some() => {
                Err(self.wrong(ParameterFlaw::SmoothChoice { shape }))
            }
            _ => Ok(()),
        }
    }

    fn wrong(&self, flaw: impl Into<ParameterFlaw>) -> ParameterError {
        ParameterError { name: self.name.clone(), flaw: flaw.into() }
    }
}

/// A coordinate of the tests of a space, which is a parameter or one of the values that make a signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate<'a> {
    /// The parameter to which the coordinate belongs.
    pub parameter: &'a Parameter,
    /// The position of the coordinate among the coordinates of the parameter, from 0.
    pub index: usize,
}

impl Coordinate<'_> {
    /// Returns the name of the coordinate, such as `speed` or, for a signal, `leader_speed[0]`. It is the name of the
    /// parameter; for a signal the index is added.
    pub fn name(&self) -> String {
        let Parameter { name, signal, .. } = self.parameter;
        if signal.is_some() { format!("{name}[{}]", self.index) } else { name.clone() }
    }

    /// Returns the name of the coordinate with its unit for an axis or a column, such as `leader_speed[0] (m/s)`.
    pub fn label(&self) -> String {
        match &self.parameter.unit {
            Some(unit) => format!("{} ({unit})", self.name()),
            None => self.name(),
        }
    }

    /// Returns the value of the coordinate in the given value of the parameter, or `None` if a list is too short.
    pub fn value<'v>(&self, value: &'v Value) -> Option<&'v Value> {
        match value {
            Value::List(values) => values.get(self.index),
            value => Some(value),
        }
    }
}

/// A parameter as it is written in files: `interval = [lo, hi]` or `choice = [..]`, beside its name.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Entry {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "two_numbers", default)]
    interval: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<Vec<Value>>,
    /// The texts of the choice's values, if the file format would write some numbers in another way.
    #[serde(skip_serializing_if = "Option::is_none")]
    written: Option<Vec<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    default: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    signal: Option<shape::Entry>,
    #[serde(default, skip_serializing_if = "is_uniform")]
    distribution: Distribution,
    #[serde(rename = "scale", default, skip_serializing)]
    reserved: Option<IgnoredAny>,
}

/// Reads an interval. Some file formats would take the first two of more numbers.
fn two_numbers<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 2]>, D::Error> {
    let numbers = Option::<Vec<f64>>::deserialize(deserializer)?;
    let interval = |numbers: Vec<f64>| {
        let found = numbers.len();
        let of_two = || D::Error::custom(format!("found {found} numbers as the interval, expected [lo, hi]"));
        <[f64; 2]>::try_from(numbers).map_err(|_| of_two())
    };
    numbers.map(interval).transpose()
}

/// The name of a key that a later version will read.
const RESERVED: &str = "scale";

fn is_uniform(distribution: &Distribution) -> bool {
    *distribution == Distribution::Uniform
}

impl Entry {
    /// Makes an entry that says how its numbers are written, since file formats may write fractions in another way.
    pub(crate) fn spelled_out(parameter: Parameter) -> Self {
        let levels = parameter.levels().unwrap_or_default();
        let is_other = |level: &Value, whole: i64| level.to_string() != whole.to_string();
        let fraction = |level: &Value| {
            level.number().is_some_and(|number| Value::whole(number).is_none_or(|whole| is_other(level, whole)))
        };
        let written = levels.iter().any(fraction).then(|| levels.iter().map(ToString::to_string).collect());
        let entry = Self::from(parameter);
        Self { written: written.or(entry.written), ..entry }
    }
}

/// The reason why an entry of a file is not a parameter.
#[derive(Debug, Clone, Error, PartialEq)]
#[error("parameter `{name}`: {flaw}")]
pub(crate) struct EntryError {
    name: String,
    flaw: EntryFlaw,
}

#[derive(Debug, Clone, Error, PartialEq)]
enum EntryFlaw {
    #[error("expected either `interval = [lo, hi]` or `choice = [..]`")]
    Domain,
    #[error("the key `written` has length {found}, expected length {expected}, a text for each value of `choice`")]
    WrittenCount { found: usize, expected: usize },
    #[error("found `{found}` in `written`, expected a text of the value {level}")]
    Written { found: String, level: Value },
    #[error("the key `{RESERVED}` is not supported by this version; remove the key")]
    Reserved,
    #[error(transparent)]
    Shape(#[from] ShapeError),
}

/// Returns the levels of a choice as the texts in `written` write them.
fn as_written(choice: Vec<Value>, written: &[String]) -> Result<Vec<Value>, EntryFlaw> {
    if choice.len() != written.len() {
        return Err(EntryFlaw::WrittenCount { found: written.len(), expected: choice.len() });
    }
    let level = |(level, text): (Value, &String)| match Value::written(text) {
        number if level.number().is_some() && number.means(&level) => Ok(number),
        _ if level.to_string() == *text => Ok(level),
        _ => Err(EntryFlaw::Written { found: text.clone(), level }),
    };
    choice.into_iter().zip(written).map(level).collect()
}

impl TryFrom<Entry> for Parameter {
    type Error = EntryError;

    fn try_from(entry: Entry) -> Result<Self, EntryError> {
        let name = entry.name.clone();
        Self::read(entry).map_err(|flaw| EntryError { name, flaw })
    }
}

impl Parameter {
    fn read(entry: Entry) -> Result<Self, EntryFlaw> {
        let Entry { name, interval, choice, written, unit, default, signal, distribution, reserved } = entry;
        if reserved.is_some() {
            return Err(EntryFlaw::Reserved);
        }
        let domain = match (interval, choice, written) {
            (Some([lo, hi]), None, None) => Domain::Interval { lo, hi },
            (None, Some(levels), None) => Domain::Choice(levels),
            (None, Some(levels), Some(written)) => Domain::Choice(as_written(levels, &written)?),
            _ => return Err(EntryFlaw::Domain),
        };
        let signal = signal.map(|signal| signal.shape()).transpose()?.flatten();
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
        Self {
            name,
            interval,
            choice,
            written,
            unit,
            default,
            signal: parameter.signal.map(Into::into),
            distribution,
            reserved: None,
        }
    }
}
