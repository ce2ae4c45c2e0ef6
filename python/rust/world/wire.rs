//! Streams of the library by the type of their values, and the operators between two of them.

use crate::error::raised;
use nalgebra::Vector2;
use paracosm::engine;
use pyo3::prelude::*;

/// A stream of the library, by the type of its values.
#[derive(Clone)]
pub enum Wire {
    Number(engine::Stream<f64>),
    Truth(engine::Stream<bool>),
    Vector(engine::Stream<Vector2<f64>>),
    Event(engine::Stream<()>),
}

/// Does the same with a stream of any type.
macro_rules! each {
    ($wire:expr, $stream:ident => $made:expr) => {
        match $wire {
            $crate::world::wire::Wire::Number($stream) => $made,
            $crate::world::wire::Wire::Truth($stream) => $made,
            $crate::world::wire::Wire::Vector($stream) => $made,
            $crate::world::wire::Wire::Event($stream) => $made,
        }
    };
}
pub(super) use each;

/// Does the same with two streams of the same type, and makes a stream of that type.
macro_rules! both {
    ($word:literal, $left:expr, $right:expr, $one:ident, $other:ident => $made:expr) => {
        match ($left, $right) {
            ($crate::world::wire::Wire::Number($one), $crate::world::wire::Wire::Number($other)) => {
                Ok($crate::world::wire::Wire::Number($made))
            }
            ($crate::world::wire::Wire::Truth($one), $crate::world::wire::Wire::Truth($other)) => {
                Ok($crate::world::wire::Wire::Truth($made))
            }
            ($crate::world::wire::Wire::Vector($one), $crate::world::wire::Wire::Vector($other)) => {
                Ok($crate::world::wire::Wire::Vector($made))
            }
            ($crate::world::wire::Wire::Event($one), $crate::world::wire::Wire::Event($other)) => {
                Ok($crate::world::wire::Wire::Event($made))
            }
            (left, right) => Err(raised(format!(
                "{}: found {} and {}, expected streams of the same type",
                $word,
                left.words(),
                right.words()
            ))),
        }
    };
}

pub(super) use both;

macro_rules! from_stream {
    ($($type:ty => $kind:ident),*) => {$(
        impl From<engine::Stream<$type>> for Wire {
            fn from(stream: engine::Stream<$type>) -> Self {
                Self::$kind(stream)
            }
        }
    )*};
}
from_stream!(f64 => Number, bool => Truth, Vector2<f64> => Vector, () => Event);

impl Wire {
    /// Returns the type of the stream in words.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Number(_) => "a stream of numbers",
            Self::Truth(_) => "a stream of truths",
            Self::Vector(_) => "a stream of vectors",
            Self::Event(_) => "a stream of events",
        }
    }

    /// Returns the stream of numbers.
    ///
    /// # Errors
    /// The stream has values of another type; `place` begins the message.
    pub fn numbers(self, place: &str) -> PyResult<engine::Stream<f64>> {
        match self {
            Self::Number(stream) => Ok(stream),
            other => Err(raised(format!("{place}: found {}, expected a stream of numbers", other.words()))),
        }
    }

    /// Returns the stream of truths, as [`numbers`](Self::numbers) does.
    pub fn truths(self, place: &str) -> PyResult<engine::Stream<bool>> {
        match self {
            Self::Truth(stream) => Ok(stream),
            other => Err(raised(format!(
                "{place}: found {}, expected a stream of truths, such as `car.speed() < 10`",
                other.words()
            ))),
        }
    }

    /// Returns the stream of vectors, as [`numbers`](Self::numbers) does.
    pub fn vectors(self, place: &str) -> PyResult<engine::Stream<Vector2<f64>>> {
        match self {
            Self::Vector(stream) => Ok(stream),
            other => Err(raised(format!("{place}: found {}, expected a stream of vectors", other.words()))),
        }
    }
}

/// An operator between two streams.
#[derive(Clone, Copy)]
pub enum Sign {
    Add,
    Sub,
    Mul,
    Div,
    And,
    Or,
}

impl Sign {
    /// Returns the operator as messages show it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Add => "`+`",
            Self::Sub => "`-`",
            Self::Mul => "`*`",
            Self::Div => "`/`",
            Self::And => "`&`",
            Self::Or => "`|`",
        }
    }

    /// Makes the stream of the operator between two streams.
    ///
    /// # Errors
    /// The operator does not work between streams of these types.
    pub fn of(self, left: Wire, right: Wire) -> PyResult<Wire> {
        use Wire::{Number, Truth, Vector};
        Ok(match (self, left, right) {
            (Self::Add, Number(one), Number(other)) => Number(one + other),
            (Self::Add, Vector(one), Vector(other)) => Vector(one + other),
            (Self::Sub, Number(one), Number(other)) => Number(one - other),
            (Self::Sub, Vector(one), Vector(other)) => Vector(one - other),
            (Self::Mul, Number(one), Number(other)) => Number(one * other),
            (Self::Mul, Vector(vector), Number(number)) | (Self::Mul, Number(number), Vector(vector)) => {
                Vector(vector * number)
            }
            (Self::Div, Number(one), Number(other)) => Number(one / other),
            (Self::Div, Vector(vector), Number(number)) => Vector(vector / number),
            (Self::And, Truth(one), Truth(other)) => Truth(one & other),
            (Self::Or, Truth(one), Truth(other)) => Truth(one | other),
            (sign, left, right) => {
                let (sign, left, right) = (sign.word(), left.words(), right.words());
                return Err(raised(format!("{sign} does not work between {left} and {right}")));
            }
        })
    }
}
