//! Signals: parameters that vary over time, reduced to a few coordinates by a shape (section 3.3 of the paper).
//!
//! A test gives a signal one value for each of its coordinates, all in the parameter's domain, and the shape says what
//! that means at each moment of a run. Every shape stays in the domain: what lies between two values is a mean of them,
//! and a polynomial is written in the Bernstein basis, where it is a mean of all its coefficients.

use crate::names::{did_you_mean, nearest};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

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

/// Why a text, or an entry of a file, is no shape of a signal.
#[derive(Debug, Clone, Error, PartialEq, Eq)]
pub enum ShapeError {
    /// No shape has that name.
    #[error("no shape of a signal is called `{name}`{}; there are {}", did_you_mean(.nearest), NAMES.join(", "))]
    Unknown {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// A text without the number that its shape takes.
    #[error("found `{text}`, expected `{shape}` with a number")]
    NoNumber {
        /// The text.
        text: String,
        /// The shape that it names.
        shape: String,
    },
    /// An entry of a file that lacks the key of its shape, or has that of another one.
    #[error("a signal of the shape `{shape}` takes {takes}")]
    Keys {
        /// The shape.
        shape: String,
        /// The keys that it takes.
        takes: &'static str,
    },
}

/// The names of all shapes.
const NAMES: [&str; 3] = ["polynomial", "piecewise-constant", "piecewise-linear"];

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
    /// # use paracosm_space::Shape;
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
    type Err = ShapeError;

    fn from_str(text: &str) -> Result<Self, ShapeError> {
        let inner = text.strip_suffix(')').and_then(|text| text.split_once('('));
        let (name, number) = inner.or_else(|| text.split_once(':')).unwrap_or((text, ""));
        let missing = |_| ShapeError::NoNumber { text: text.to_owned(), shape: name.to_owned() };
        Self::named(name.trim(), || number.trim().parse().map_err(missing))
    }
}

impl Shape {
    /// The shape of that name, with the number that it takes.
    fn named(name: &str, number: impl Fn() -> Result<usize, ShapeError>) -> Result<Self, ShapeError> {
        match name {
            "polynomial" => Ok(Shape::Polynomial { degree: number()? }),
            "piecewise-constant" => Ok(Shape::PiecewiseConstant { pieces: number()? }),
            "piecewise-linear" => Ok(Shape::PiecewiseLinear { pieces: number()? }),
            _ => Err(ShapeError::Unknown { name: name.to_owned(), nearest: nearest(name, NAMES) }),
        }
    }
}

/// A shape as files write it: `{ shape = "polynomial", degree = 2 }`.
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
    /// The shape; none of a signal that is constant, which is as good as no signal.
    pub fn shape(&self) -> Result<Option<Shape>, ShapeError> {
        let Self { shape, degree, pieces } = self;
        let (takes, number, other) = match shape.as_str() {
            "constant" => ("nothing more", None, degree.or(*pieces)),
            "polynomial" => ("`degree`, and no `pieces`", *degree, *pieces),
            _ => ("`pieces`, and no `degree`", *pieces, *degree),
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
