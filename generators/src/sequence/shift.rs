//! Shifts modulo 1 by one random vector (Cranley and Patterson, SIAM J. Numer. Anal. 13, 1976).
//!
//! A shift makes every point uniformly random and keeps the evenness of the set, except for a box that is cut at the
//! border of the cube. It serves two purposes: repetitions of a deterministic set, and copies of a set for the rows
//! of a discrete family, which would otherwise all be tested at the same points.

use crate::seeded::{Purpose, seeded};
use rand::Rng;

/// A vector by which points are shifted modulo 1. A vector of zeros leaves every coordinate unchanged, to the last bit.
pub(super) struct Shift(Vec<f64>);

impl Shift {
    pub(super) fn none(dims: usize) -> Self {
        Self(vec![0.0; dims])
    }

    /// Makes the random shift for a seed and a number.
    pub(super) fn random(dims: usize, seed: u64, number: u64) -> Self {
        let mut rng = seeded(seed, Purpose::Shift, number);
        Self((0..dims).map(|_| rng.random()).collect())
    }

    /// Makes the shift of a row's copy of a set. It is a random shift, but no shift for the first row without a seed.
    pub(super) fn of_row(dims: usize, seed: Option<u64>, row: u64) -> Self {
        match (seed, row) {
            (None, 0) => Self::none(dims),
            _ => Self::random(dims, seed.unwrap_or(0), row),
        }
    }

    /// Returns the shifted point.
    pub(super) fn apply(&self, point: impl IntoIterator<Item = f64>) -> Vec<f64> {
        point.into_iter().zip(&self.0).map(|(u, &shift)| rotate(u, shift)).collect()
    }
}

/// `u + shift` modulo 1. Both are at most 1 - 2^-53, so that their sum is at most 2 - 2^-52, which is a double.
fn rotate(u: f64, shift: f64) -> f64 {
    let sum = u + shift;
    if sum < 1.0 { sum } else { sum - 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_shift_leaves_the_cube() {
        let nearly_one = 1.0_f64.next_down();
        assert!(rotate(nearly_one, nearly_one) < 1.0);
        assert_eq!(rotate(0.75, 0.5), 0.25);
    }
}
