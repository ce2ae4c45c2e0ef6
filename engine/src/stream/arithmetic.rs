//! Arithmetic on streams of numbers, truths and vectors, at the ticks at which all operands have a value.

use super::Stream;
use super::node::{Binary, NodeKind, Unary};
use crate::line::Line;
use nalgebra::Vector2;
use paracosm_oracles::Comparison;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

impl Stream<f64> {
    /// Returns a stream that is true at the ticks at which this stream is below the other stream.
    pub fn below(&self, other: impl Into<Stream<f64>>) -> Stream<bool> {
        self.with(NodeKind::Compare(Comparison::Below), &other.into())
    }

    /// Returns a stream that is true at the ticks at which this stream is at most the other stream.
    pub fn at_most(&self, other: impl Into<Stream<f64>>) -> Stream<bool> {
        self.with(NodeKind::Compare(Comparison::AtMost), &other.into())
    }

    /// Returns a stream that is true at the ticks at which this stream is above the other stream.
    pub fn above(&self, other: impl Into<Stream<f64>>) -> Stream<bool> {
        self.with(NodeKind::Compare(Comparison::Above), &other.into())
    }

    /// Returns a stream that is true at the ticks at which this stream is at least the other stream.
    pub fn at_least(&self, other: impl Into<Stream<f64>>) -> Stream<bool> {
        self.with(NodeKind::Compare(Comparison::AtLeast), &other.into())
    }

    /// Returns the smaller value of this stream and the other stream; NaN if a value is NaN.
    pub fn min(&self, other: impl Into<Stream<f64>>) -> Self {
        self.with(NodeKind::Binary(Binary::Least), &other.into())
    }

    /// Returns the larger value of this stream and the other stream; NaN if a value is NaN.
    pub fn max(&self, other: impl Into<Stream<f64>>) -> Self {
        self.with(NodeKind::Binary(Binary::Greatest), &other.into())
    }

    /// Returns the absolute value of the stream's number at each tick.
    pub fn abs(&self) -> Self {
        self.then(NodeKind::Unary(Unary::Absolute))
    }

    /// Returns the square root of the stream's number at each tick; NaN if the number is below 0.
    pub fn sqrt(&self) -> Self {
        self.then(NodeKind::Unary(Unary::SquareRoot))
    }

    /// Returns the sum of all values of the stream so far, at the ticks at which the stream has a value.
    pub fn sum(&self) -> Self {
        self.then(NodeKind::Sum(0.0.into()))
    }
}

impl Stream<Vector2<f64>> {
    /// Makes a stream of vectors from the streams of the vectors' coordinates.
    pub fn vector(x: impl Into<Stream<f64>>, y: impl Into<Stream<f64>>) -> Self {
        x.into().with(NodeKind::Binary(Binary::Vector), &y.into())
    }

    /// Returns the distance in metres from the stream's position to a line, along the line's direction; negative if the
    /// position is past the line.
    pub fn distance_to(&self, line: &Line) -> Stream<f64> {
        self.then(NodeKind::Towards(line.clone()))
    }

    /// Returns the length of the stream's vector at each tick.
    pub fn norm(&self) -> Stream<f64> {
        self.then(NodeKind::Unary(Unary::Norm))
    }

    /// Returns the scalar product of the vectors of this stream and the other stream.
    pub fn dot(&self, other: impl Into<Stream<Vector2<f64>>>) -> Stream<f64> {
        self.with(NodeKind::Binary(Binary::Dot), &other.into())
    }

    /// Returns the first coordinate of the stream's vector at each tick.
    pub fn x(&self) -> Stream<f64> {
        self.then(NodeKind::Unary(Unary::X))
    }

    /// Returns the second coordinate of the stream's vector at each tick.
    pub fn y(&self) -> Stream<f64> {
        self.then(NodeKind::Unary(Unary::Y))
    }

    /// Returns the sum of all values of the stream so far, at the ticks at which the stream has a value.
    pub fn sum(&self) -> Self {
        self.then(NodeKind::Sum(Vector2::zeros().into()))
    }
}

/// Implements an operator between two streams, and between a stream and a value that converts to a stream.
macro_rules! operator {
    ($trait:ident, $method:ident, $binary:ident, $left:ty, $right:ty) => {
        impl<S: Into<Stream<$right>>> $trait<S> for &Stream<$left> {
            type Output = Stream<$left>;

            fn $method(self, other: S) -> Stream<$left> {
                self.with(NodeKind::Binary(Binary::$binary), &other.into())
            }
        }

        impl<S: Into<Stream<$right>>> $trait<S> for Stream<$left> {
            type Output = Stream<$left>;

            fn $method(self, other: S) -> Stream<$left> {
                $trait::$method(&self, other)
            }
        }
    };
}

operator!(Add, add, Sum, f64, f64);
operator!(Sub, sub, Difference, f64, f64);
operator!(Mul, mul, Product, f64, f64);
operator!(Div, div, Quotient, f64, f64);
operator!(Add, add, Sum, Vector2<f64>, Vector2<f64>);
operator!(Sub, sub, Difference, Vector2<f64>, Vector2<f64>);
operator!(Mul, mul, Product, Vector2<f64>, f64);
operator!(Div, div, Quotient, Vector2<f64>, f64);
operator!(BitAnd, bitand, And, bool, bool);
operator!(BitOr, bitor, Or, bool, bool);

/// Implements an operator with a plain number on its left.
macro_rules! number_first {
    ($trait:ident, $method:ident) => {
        impl $trait<Stream<f64>> for f64 {
            type Output = Stream<f64>;

            fn $method(self, other: Stream<f64>) -> Stream<f64> {
                $trait::$method(Stream::constant(self), other)
            }
        }

        impl $trait<&Stream<f64>> for f64 {
            type Output = Stream<f64>;

            fn $method(self, other: &Stream<f64>) -> Stream<f64> {
                $trait::$method(Stream::constant(self), other)
            }
        }
    };
}

number_first!(Add, add);
number_first!(Sub, sub);
number_first!(Mul, mul);
number_first!(Div, div);

/// Implements an operator on one stream.
macro_rules! prefix {
    ($trait:ident, $method:ident, $unary:ident, $type:ty) => {
        impl $trait for &Stream<$type> {
            type Output = Stream<$type>;

            fn $method(self) -> Stream<$type> {
                self.then(NodeKind::Unary(Unary::$unary))
            }
        }

        impl $trait for Stream<$type> {
            type Output = Stream<$type>;

            fn $method(self) -> Stream<$type> {
                $trait::$method(&self)
            }
        }
    };
}

prefix!(Neg, neg, Negative, f64);
prefix!(Neg, neg, Negative, Vector2<f64>);
prefix!(Not, not, Not, bool);
