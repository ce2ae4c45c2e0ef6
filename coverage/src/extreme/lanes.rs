//! Four numbers that are computed together. With AVX2 one instruction computes all four.

use crate::ordered::{greatest, least};
use std::ops::{Add, Mul, Sub};

/// The number of lanes.
pub(super) const LANES: usize = 4;

/// Numbers that are computed together.
#[derive(Clone, Copy)]
pub(super) struct Lanes([f64; LANES]);

impl Lanes {
    /// Makes lanes that all hold the same number.
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

    /// Computes each lane. The lanes are listed one by one, because the compiler makes one instruction of them then.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lane_is_computed_alone() {
        let (a, b) = (Lanes::from([1.0, -2.0, 3.0, 0.5]), Lanes::from([4.0, -5.0, 0.0, 0.5]));
        assert_eq!((a + b).numbers(), [5.0, -7.0, 3.0, 1.0]);
        assert_eq!((a - b).numbers(), [-3.0, 3.0, 3.0, 0.0]);
        assert_eq!((a * b).numbers(), [4.0, 10.0, 0.0, 0.25]);
        assert_eq!(a.greatest(b).numbers(), [4.0, -2.0, 3.0, 0.5]);
        assert_eq!(a.least(b).numbers(), [1.0, -5.0, 0.0, 0.5]);
    }
}
