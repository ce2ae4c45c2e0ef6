//! Signals: parameters that vary over time, reduced to a few coordinates by a shape (section 3.3 of the paper).
//!
//! A test gives a signal one value for each of its coordinates, all in the parameter's domain, and the shape says what
//! that means at each moment of a run. Every shape stays in the domain: what lies between two values is a mean of them,
//! and a polynomial is written in the Bernstein basis, where it is a mean of all its coefficients.

use super::{Parameter, SpaceError, Value};
use std::fmt;
use std::str::FromStr;

/// How a signal follows from the values of its coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A polynomial of this degree over the run's duration: its Bernstein coefficients, one more than the degree. The
    /// first and the last are its values at the start and at the end.
    Polynomial {
        /// The degree.
        degree: usize,
    },
    /// As many values, each for an equal part of the run.
    PiecewiseConstant {
        /// The number of parts.
        pieces: usize,
    },
    /// Straight lines over equal parts of the run: the values where they begin, and that at the end.
    PiecewiseLinear {
        /// The number of parts.
        pieces: usize,
    },
}

/// More coordinates than this are a mistake.
const MOST: usize = 1_000_000;

impl Shape {
    /// How many values make such a signal.
    pub fn coordinates(self) -> usize {
        match self {
            Shape::Polynomial { degree } => degree.saturating_add(1),
            Shape::PiecewiseConstant { pieces } => pieces,
            Shape::PiecewiseLinear { pieces } => pieces.saturating_add(1),
        }
    }

    /// The value of a signal of numbers at a tick of a run that takes `ticks`; from the last tick on it stays as it is.
    ///
    /// ```
    /// # use paracosm_coverage::Shape;
    /// let bow = Shape::Polynomial { degree: 2 };
    /// assert_eq!([0, 50, 100].map(|tick| bow.number_at(&[0.0, 1.0, 0.0], tick, 100)), [0.0, 0.5, 0.0]);
    /// ```
    ///
    /// # Panics
    /// There are not as many values as coordinates.
    pub fn number_at(self, values: &[f64], tick: usize, ticks: usize) -> f64 {
        assert_eq!(values.len(), self.coordinates(), "a value for every coordinate");
        let (tick, ticks) = (tick.min(ticks), ticks.max(1));
        match self {
            Shape::Polynomial { .. } => bernstein(values, tick as f64 / ticks as f64),
            Shape::PiecewiseConstant { pieces } => values[Self::piece(pieces, tick, ticks)],
            Shape::PiecewiseLinear { pieces } => {
                let piece = Self::piece(pieces, tick, ticks);
                // How far into the piece, exactly: a tick at which a piece begins has the value given for it.
                let share = (tick * pieces - piece * ticks) as f64 / ticks as f64;
                mean(values[piece], values[piece + 1], share)
            }
        }
    }

    /// Which of equal parts of a run a tick belongs to. With as many parts as ticks, every tick has its own.
    pub fn piece(pieces: usize, tick: usize, ticks: usize) -> usize {
        (tick * pieces / ticks.max(1)).min(pieces - 1)
    }
}

/// A point between two numbers; both ends exactly, and never outside.
fn mean(from: f64, to: f64, share: f64) -> f64 {
    ((1.0 - share) * from + share * to).clamp(from.min(to), from.max(to))
}

/// A polynomial with these Bernstein coefficients at `u` in `[0,1]`, by convex combinations in linear time: Woźny and
/// Chudy, "Linear-time geometric algorithm for evaluating Bézier curves", Computer-Aided Design 118, 2020.
fn bernstein(coefficients: &[f64], u: f64) -> f64 {
    let degree = coefficients.len() - 1;
    let (mut weight, mut value) = (1.0, coefficients[0]);
    for (k, coefficient) in coefficients.iter().enumerate().skip(1) {
        let gain = u * weight * (degree - k + 1) as f64;
        weight = gain / (gain + k as f64 * (1.0 - u));
        value = mean(value, *coefficient, weight);
    }
    value
}

impl Parameter {
    /// How many coordinates of a test it has: one, or those of its signal.
    pub fn coordinates(&self) -> usize {
        self.signal.map_or(1, Shape::coordinates)
    }

    /// The values of its coordinates; of a signal, a single value stands for the one that never changes.
    ///
    /// # Errors
    /// The value is not in the domain, or a list that is not as long as there are coordinates.
    pub fn scalars(&self, value: &Value) -> Result<Vec<Value>, SpaceError> {
        self.check(value)?;
        Ok(match value {
            Value::List(values) => values.to_vec(),
            value => vec![value.clone(); self.coordinates()],
        })
    }

    /// Checks that it can vary in this shape.
    ///
    /// # Errors
    /// The shape has no piece or too many coordinates, or the parameter is a choice and the shape not piecewise
    /// constant.
    pub fn check_signal(&self, shape: Shape) -> Result<(), SpaceError> {
        let refuse = |message| Err(SpaceError::Signal { name: self.name.clone(), message });
        let found = shape.coordinates();
        match shape {
            _ if !(1..=MOST).contains(&found) => {
                refuse(format!("the signal {shape} has {found} coordinates, expected 1 to {MOST}"))
            }
            Shape::PiecewiseLinear { pieces: 0 } => refuse("a signal needs at least one piece".to_owned()),
            Shape::Polynomial { .. } | Shape::PiecewiseLinear { .. } if self.levels().is_some() => {
                refuse(format!("a choice is piecewise constant where it varies, found the shape {shape}"))
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Shape::Polynomial { degree } => write!(f, "polynomial({degree})"),
            Shape::PiecewiseConstant { pieces } => write!(f, "piecewise-constant({pieces})"),
            Shape::PiecewiseLinear { pieces } => write!(f, "piecewise-linear({pieces})"),
        }
    }
}

/// A shape as people write it: `polynomial(2)` or, where a shell would take the parentheses, `polynomial:2`.
impl FromStr for Shape {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let inner = text.strip_suffix(')').and_then(|text| text.split_once('('));
        let (name, number) = inner.or_else(|| text.split_once(':')).unwrap_or((text, ""));
        let number = || number.trim().parse().map_err(|_| format!("found `{text}`, expected `{name}` with a number"));
        Self::named(name.trim(), number)
    }
}

impl Shape {
    /// The shape of that name, with the number that it takes.
    fn named(name: &str, number: impl Fn() -> Result<usize, String>) -> Result<Self, String> {
        const NAMES: [&str; 3] = ["polynomial", "piecewise-constant", "piecewise-linear"];
        match name {
            "polynomial" => Ok(Shape::Polynomial { degree: number()? }),
            "piecewise-constant" => Ok(Shape::PiecewiseConstant { pieces: number()? }),
            "piecewise-linear" => Ok(Shape::PiecewiseLinear { pieces: number()? }),
            _ => {
                let hint = crate::did_you_mean(&crate::nearest(name, NAMES));
                Err(format!("no shape of a signal is called `{name}`{hint}; there are {}", NAMES.join(", ")))
            }
        }
    }
}

/// A shape as files write it: `{ shape = "polynomial", degree = 2 }`.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entry {
    shape: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    degree: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pieces: Option<usize>,
}

impl Entry {
    /// The shape; none of a signal that is constant, which is as good as no signal.
    pub fn shape(&self) -> Result<Option<Shape>, String> {
        let Self { shape, degree, pieces } = self;
        let (needed, number, other) = match shape.as_str() {
            "constant" => ("nothing more", None, degree.or(*pieces)),
            "polynomial" => ("`degree`, and no `pieces`", *degree, *pieces),
            _ => ("`pieces`, and no `degree`", *pieces, *degree),
        };
        let missing = || format!("a signal of the shape `{shape}` takes {needed}");
        let found = if shape == "constant" { None } else { Some(Shape::named(shape, || number.ok_or_else(missing))?) };
        if other.is_some() { Err(missing()) } else { Ok(found) }
    }
}

impl From<Shape> for Entry {
    fn from(shape: Shape) -> Self {
        let (shape, degree, pieces) = match shape {
            Shape::Polynomial { degree } => ("polynomial", Some(degree), None),
            Shape::PiecewiseConstant { pieces } => ("piecewise-constant", None, Some(pieces)),
            Shape::PiecewiseLinear { pieces } => ("piecewise-linear", None, Some(pieces)),
        };
        Self { shape: shape.to_owned(), degree, pieces }
    }
}

/// One coordinate of the tests of a space: a parameter, or one of the values that make a signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate<'a> {
    /// The parameter that it belongs to.
    pub parameter: &'a Parameter,
    /// Which of its values it is, from 0.
    pub index: usize,
}

impl Coordinate<'_> {
    /// The name of the parameter; of a signal with the index: `leader_speed[0]`.
    pub fn name(&self) -> String {
        let Parameter { name, signal, .. } = self.parameter;
        if signal.is_some() { format!("{name}[{}]", self.index) } else { name.clone() }
    }

    /// The name with its unit, for an axis or a column: `leader_speed[0] (m/s)`.
    pub fn label(&self) -> String {
        match &self.parameter.unit {
            Some(unit) => format!("{} ({unit})", self.name()),
            None => self.name(),
        }
    }

    /// Its value among those of a test; `None` where the test says nothing of it.
    pub fn value<'v>(&self, value: &'v Value) -> Option<&'v Value> {
        match value {
            Value::List(values) => values.get(self.index),
            value => Some(value),
        }
    }
}
