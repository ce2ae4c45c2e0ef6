//! Four numbers that are computed together, so that a processor computes them by one instruction.

use crate::ordered::{greatest, least};
use std::ops::{Add, Mul, Sub};

/// The number of numbers that are computed together.
pub(super) const LANES: usize = 4;

/// Numbers that are computed together.
#[derive(Clone, Copy)]
pub(super) struct Lanes([f64; LANES]);

impl Lanes {
    /// Makes lanes with the same number.
    #[inline(always)]
    pub(super) const fn all(number: f64) -> Self {
        Self([number; LANES])
    }

    /// Returns the numbers.
    #[inline(always)]
    pub(super) fn numbers(self) -> [f64; LANES] {
        self.0
    }

    /// Returns the greatest of two numbers in each lane.
    #[inline(always)]
    pub(super) fn greatest(self, other: Self) -> Self {
        self.zip(other, greatest)
    }

    /// Returns the least of two numbers in each lane.
    #[inline(always)]
    pub(super) fn least(self, other: Self) -> Self {
        self.zip(other, least)
    }

    #[inline(always)]
    fn zip(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([of(a, e), of(b, f), of(c, g), of(d, h)])
    }
}

impl Add for Lanes {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl From<[f64; LANES]> for Lanes {
    #[inline(always)]
    fn from(numbers: [f64; LANES]) -> Self {
        Self(numbers)
    }
}
