//! Signals: parameters that vary over time, reduced to a few coordinates by a shape (section 3.3 of the paper).
//!
//! A test gives a signal one value for each of its coordinates, all in the parameter's domain. The shape says which
//! value the signal has at each moment of a run. The signal never leaves the domain: between two values it is a mean
//! of both, and a polynomial is written in the Bernstein basis, where it is a mean of all its coefficients.

use crate::names::{did_you_mean, nearest};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The form of a signal over time, as a function of the values of its coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A signal that is a polynomial over the duration of the run. The coordinates are its Bernstein coefficients, one
    /// more than the degree. The first and the last are the values of the signal at the start and at the end of the
    /// run.
    Polynomial {
        /// The degree of the polynomial.
        degree: usize,
    },
    /// A signal that is constant in each of several equal parts of the run. Each coordinate is the value of a part.
    PiecewiseConstant {
        /// The number of equal parts of the run.
        pieces: usize,
    },
    /// A signal of straight lines over equal parts of the run. The coordinates are the values at the start of each part
    /// and at the end of the run.
    PiecewiseLinear {
        /// The number of equal parts of the run.
        pieces: usize,
    },
}

/// The reason why a text, or an entry of a file, does not describe the shape of a signal.
#[derive(Debug, Clone, Error, PartialEq, Eq)]
pub enum ShapeError {
    /// No shape of a signal has the given name.
    #[error("no shape of a signal is called `{name}`{}; the shapes are {}", did_you_mean(.nearest), NAMES.join(", "))]
    Unknown {
        /// The given name, which is not the name of a shape.
        name: String,
        /// The most similar name of a shape, if a name is similar enough.
        nearest: Option<&'static str>,
    },
    /// The text lacks the number that the shape needs, such as a degree.
    #[error("found `{text}`, expected the shape `{shape}` with a number, such as `piecewise-constant(5)`")]
    NoNumber {
        /// The text that was read as a shape.
        text: String,
        /// The name of the shape in the text.
        shape: String,
    },
    /// An entry of a file lacks the key that its shape needs, or has a key of another shape.
    #[error("a signal of the shape `{shape}` takes {takes}")]
    Keys {
        /// The name of the shape in the entry.
        shape: String,
        /// The keys that the shape takes, in words.
        takes: &'static str,
    },
}

/// The names of all shapes.
const NAMES: [&str; 3] = ["polynomial", "piecewise-constant", "piecewise-linear"];

impl Shape {
    /// Returns the number of coordinates of a signal of this shape, which is the number of values that make the signal.
    pub fn coordinates(self) -> usize {
        match self {
            Shape::Polynomial { degree } => degree.saturating_add(1),
            Shape::PiecewiseConstant { pieces } => pieces,
            Shape::PiecewiseLinear { pieces } => pieces.saturating_add(1),
        }
    }

    /// Returns the value that a signal has at a tick of a run, if its coordinates have the given values. The run takes
    /// `ticks` ticks. After the last tick the value stays.
    ///
    /// ```
    /// # use paracosm_space::Shape;
    /// let bow = Shape::Polynomial { degree: 2 };
    /// assert_eq!([0, 50, 100].map(|tick| bow.number_at(&[0.0, 1.0, 0.0], tick, 100)), [0.0, 0.5, 0.0]);
    /// ```
    ///
    /// # Panics
    /// The number of values differs from the number of coordinates.
    pub fn number_at(self, values: &[f64], tick: usize, ticks: usize) -> f64 {
        assert_eq!(values.len(), self.coordinates(), "a value for every coordinate");
        let (tick, ticks) = (tick.min(ticks), ticks.max(1));
        match self {
            Shape::Polynomial { .. } => bernstein(values, tick as f64 / ticks as f64),
            Shape::PiecewiseConstant { pieces } => values[Self::piece(pieces, tick, ticks)],
            Shape::PiecewiseLinear { pieces } => {
                let piece = Self::piece(pieces, tick, ticks);
                // The share of the piece that has passed. It is exactly 0 at a piece's first tick, where the value is
                // the given one.
                let share = (tick * pieces - piece * ticks) as f64 / ticks as f64;
                mean(values[piece], values[piece + 1], share)
            }
        }
    }

    /// Returns the number, from 0, of the part that contains a tick, if the run is divided into `pieces` equal parts.
    /// If there are as many parts as ticks, every tick has its own part.
    pub fn piece(pieces: usize, tick: usize, ticks: usize) -> usize {
        (tick * pieces / ticks.max(1)).min(pieces - 1)
    }
}

/// Returns a point between two numbers. Both ends are exact, and the point is never outside.
fn mean(from: f64, to: f64, share: f64) -> f64 {
    ((1.0 - share) * from + share * to).clamp(from.min(to), from.max(to))
}

/// Evaluates the polynomial with these Bernstein coefficients at `u` in `[0,1]`, by convex combinations in linear
/// time. See Woźny and Chudy, "Linear-time geometric algorithm for evaluating Bézier curves", Computer-Aided Design
/// 118, 2020.
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

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Shape::Polynomial { degree } => write!(f, "polynomial({degree})"),
            Shape::PiecewiseConstant { pieces } => write!(f, "piecewise-constant({pieces})"),
            Shape::PiecewiseLinear { pieces } => write!(f, "piecewise-linear({pieces})"),
        }
    }
}

/// Reads a shape as people write it: `polynomial(2)`, or `polynomial:2` if a shell would interpret the parentheses.
impl FromStr for Shape {
    type Err = ShapeError;

    fn from_str(text: &str) -> Result<Self, ShapeError> {
        let inner = text.strip_suffix(')').and_then(|text| text.split_once('('));
        let (name, number) = inner.or_else(|| text.split_once(':')).unwrap_or((text, ""));
        let missing = |_| ShapeError::NoNumber { text: text.to_owned(), shape: name.to_owned() };
        Self::named(name.trim(), || number.trim().parse().map_err(missing))
    }
}

impl Shape {
    /// Returns the shape of this name. `number` gives the number that the shape takes.
    fn named(name: &str, number: impl Fn() -> Result<usize, ShapeError>) -> Result<Self, ShapeError> {
        match name {
            "polynomial" => Ok(Shape::Polynomial { degree: number()? }),
            "piecewise-constant" => Ok(Shape::PiecewiseConstant { pieces: number()? }),
            "piecewise-linear" => Ok(Shape::PiecewiseLinear { pieces: number()? }),
            _ => Err(ShapeError::Unknown { name: name.to_owned(), nearest: nearest(name, NAMES) }),
        }
    }
}

/// A shape as it is written in files: `{ shape = "polynomial", degree = 2 }`.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Entry {
    shape: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    degree: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pieces: Option<usize>,
}

impl Entry {
    /// Returns the shape of the signal, or `None` for a constant signal, which is the same as no signal.
    pub fn shape(&self) -> Result<Option<Shape>, ShapeError> {
        let Self { shape, degree, pieces } = self;
        let (takes, number, other) = match shape.as_str() {
            "constant" => ("no other key", None, degree.or(*pieces)),
            "polynomial" => ("the key `degree`, and not the key `pieces`", *degree, *pieces),
            _ => ("the key `pieces`, and not the key `degree`", *pieces, *degree),
        };
        let missing = || ShapeError::Keys { shape: shape.clone(), takes };
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
