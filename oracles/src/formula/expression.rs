//! Arithmetic expressions over signals: the numbers that formulas compare.

use super::Formula;
use crate::Comparison;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// An arithmetic operation on two numbers, such as the sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arithmetic {
    /// The sum `a + b`.
    Add,
    /// The difference `a - b`.
    Subtract,
    /// The product `a * b`.
    Multiply,
    /// The quotient `a / b` of IEEE 754. A number other than 0 divided by 0 is infinite; 0 / 0 has no value.
    Divide,
    /// The lesser number, `min(a, b)`.
    Least,
    /// The greater number, `max(a, b)`.
    Greatest,
}

impl Arithmetic {
    /// Returns the result of the operation. It is NaN if an operand is NaN.
    pub(crate) fn apply(self, left: f64, right: f64) -> f64 {
        match self {
            Arithmetic::Add => left + right,
            Arithmetic::Subtract => left - right,
            Arithmetic::Multiply => left * right,
            Arithmetic::Divide => left / right,
            _ if left.is_nan() || right.is_nan() => f64::NAN,
            Arithmetic::Least => left.min(right),
            Arithmetic::Greatest => left.max(right),
        }
    }
}

/// An arithmetic expression over signals. It has a value at each tick. [`Display`](std::fmt::Display) writes a text
/// that can be parsed again.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A number that is the same at every tick.
    Number(f64),
    /// The sample of the signal with the given name at the current tick.
    Signal(String),
    /// The negation `-x` of an expression.
    Negate(Box<Expression>),
    /// The absolute value `abs(x)` of an expression.
    Absolute(Box<Expression>),
    /// An arithmetic operation on two expressions.
    Binary(Arithmetic, Box<Expression>, Box<Expression>),
}

/// Makes the expression for the samples of the signal with the given name.
pub fn signal(name: impl Into<String>) -> Expression {
    Expression::Signal(name.into())
}

impl Expression {
    /// Makes the expression for the absolute value of this expression.
    pub fn abs(self) -> Self {
        Expression::Absolute(Box::new(self))
    }

    /// Makes the expression for the lesser of this expression and `other`.
    pub fn min(self, other: impl Into<Expression>) -> Self {
        self.binary(Arithmetic::Least, other)
    }

    /// Makes the expression for the greater of this expression and `other`.
    pub fn max(self, other: impl Into<Expression>) -> Self {
        self.binary(Arithmetic::Greatest, other)
    }

    fn binary(self, operation: Arithmetic, other: impl Into<Expression>) -> Self {
        Expression::Binary(operation, Box::new(self), Box::new(other.into()))
    }

    /// Makes the formula `self < other`.
    pub fn below(self, other: impl Into<Expression>) -> Formula {
        self.compare(Comparison::Below, other)
    }

    /// Makes the formula `self <= other`.
    pub fn at_most(self, other: impl Into<Expression>) -> Formula {
        self.compare(Comparison::AtMost, other)
    }

    /// Makes the formula `self > other`.
    pub fn above(self, other: impl Into<Expression>) -> Formula {
        self.compare(Comparison::Above, other)
    }

    /// Makes the formula `self >= other`.
    pub fn at_least(self, other: impl Into<Expression>) -> Formula {
        self.compare(Comparison::AtLeast, other)
    }

    /// Makes the formula `self == other`.
    pub fn equal_to(self, other: impl Into<Expression>) -> Formula {
        self.compare(Comparison::Equal, other)
    }

    /// Makes the formula `self != other`.
    pub fn different_from(self, other: impl Into<Expression>) -> Formula {
        self.compare(Comparison::Different, other)
    }

    /// Makes the formula that compares this expression with `other` by the given comparison.
    pub fn compare(self, comparison: Comparison, other: impl Into<Expression>) -> Formula {
        Formula::Compare(self, comparison, other.into())
    }

    /// Calls `visit` for each signal, from left to right.
    pub(crate) fn for_each_signal<'a>(&'a self, visit: &mut impl FnMut(&'a str)) {
        match self {
            Expression::Number(_) => {}
            Expression::Signal(name) => visit(name),
            Expression::Negate(inner) | Expression::Absolute(inner) => inner.for_each_signal(visit),
            Expression::Binary(_, left, right) => {
                left.for_each_signal(visit);
                right.for_each_signal(visit);
            }
        }
    }
}

impl From<f64> for Expression {
    fn from(number: f64) -> Self {
        Expression::Number(number)
    }
}

impl Neg for Expression {
    type Output = Expression;

    fn neg(self) -> Expression {
        Expression::Negate(Box::new(self))
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident, $operation:ident) => {
        impl<E: Into<Expression>> $operator<E> for Expression {
            type Output = Expression;

            fn $method(self, other: E) -> Expression {
                self.binary(Arithmetic::$operation, other)
            }
        }
    };
}

operator!(Add, add, Add);
operator!(Sub, sub, Subtract);
operator!(Mul, mul, Multiply);
operator!(Div, div, Divide);
