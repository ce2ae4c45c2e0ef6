//! Operators on parameters: a parameter stands where a stream stands, also beside `+`, `-`, `*` and `/`.

use super::Param;
use crate::stream::Stream;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Implements an operator between a parameter and anything that is a stream.
macro_rules! between {
    ($($trait:ident $method:ident),*) => {$(
        impl<S: Into<Stream<f64>>> $trait<S> for &Param<f64> {
            type Output = Stream<f64>;

            fn $method(self, other: S) -> Stream<f64> {
                $trait::$method(&**self, other)
            }
        }

        impl<S: Into<Stream<f64>>> $trait<S> for Param<f64> {
            type Output = Stream<f64>;

            fn $method(self, other: S) -> Stream<f64> {
                $trait::$method(&*self, other)
            }
        }
    )*};
}

/// Implements an operator between a number and a parameter.
macro_rules! number_first {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait<&Param<f64>> for f64 {
            type Output = Stream<f64>;

            fn $method(self, other: &Param<f64>) -> Stream<f64> {
                $trait::$method(self, &**other)
            }
        }

        impl $trait<Param<f64>> for f64 {
            type Output = Stream<f64>;

            fn $method(self, other: Param<f64>) -> Stream<f64> {
                $trait::$method(self, &*other)
            }
        }
    )*};
}

impl Neg for &Param<f64> {
    type Output = Stream<f64>;

    fn neg(self) -> Stream<f64> {
        -&**self
    }
}

impl Neg for Param<f64> {
    type Output = Stream<f64>;

    fn neg(self) -> Stream<f64> {
        -&*self
    }
}

between!(Add add, Sub sub, Mul mul, Div div);
number_first!(Add add, Sub sub, Mul mul, Div div);
