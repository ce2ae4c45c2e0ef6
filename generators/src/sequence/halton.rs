//! The Halton sequence (section 3.2 of the paper): dispersion O(1/n), any number of points.
//!
//! Coordinate i of point j is the radical inverse of j in the i-th prime: its digits mirrored at the point.
//! With a seed all points are shifted modulo 1 by one random vector (Cranley and Patterson, SIAM J. Numer. Anal.
//! 13, 1976), which makes each of them uniformly random and keeps the set's evenness.

use super::Sequence;
use crate::{
    GeneratorError,
    seeded::{Purpose, seeded},
};
use rand::Rng;

/// Beyond it doubles no longer tell the points apart: base 2 needs a bit of the mantissa for every bit of the index.
const LEN: u64 = 1 << 53;

/// The Halton sequence in the first primes, shifted or not.
pub(crate) struct Halton {
    bases: Vec<u64>,
    /// A vector of zeros leaves every coordinate as it is, to the last bit.
    shift: Vec<f64>,
}

impl Halton {
    /// The sequence of which the points before index `end` will be used.
    pub(crate) fn new(dims: usize, seed: Option<u64>, end: u64) -> Result<Self, GeneratorError> {
        if end > LEN {
            return Err(GeneratorError::HaltonLimit { last: end - 1 });
        }
        let shift = match seed {
            None => vec![0.0; dims],
            Some(seed) => {
                let mut rng = seeded(seed, Purpose::Shift, 0);
                (0..dims).map(|_| rng.random()).collect()
            }
        };
        Ok(Self { bases: primes().take(dims).collect(), shift })
    }
}

impl Sequence for Halton {
    fn len(&self) -> u64 {
        LEN
    }

    fn point(&self, index: u64) -> Vec<f64> {
        self.bases.iter().zip(&self.shift).map(|(&base, shift)| rotate(radical_inverse(base, index), *shift)).collect()
    }
}

/// The number in `[0,1)` whose digits in `base` are those of `index` mirrored at the point.
///
/// One division of two integers, and so one rounding, instead of a sum with a rounding for every digit.
fn radical_inverse(base: u64, mut index: u64) -> f64 {
    let (mut mirrored, mut scale) = (0_u128, 1_u128);
    while index > 0 {
        mirrored = mirrored * u128::from(base) + u128::from(index % base);
        scale *= u128::from(base);
        index /= base;
    }
    // Integers beyond 2^53 are rounded themselves, and might meet.
    (mirrored as f64 / scale as f64).min(1.0_f64.next_down())
}

/// `u + shift` modulo 1. Both are at most 1 - 2^-53, and so their sum is at most 2 - 2^-52, which is a double.
fn rotate(u: f64, shift: f64) -> f64 {
    let sum = u + shift;
    if sum < 1.0 { sum } else { sum - 1.0 }
}

/// The primes in order, by trial division: dimensions are few.
fn primes() -> impl Iterator<Item = u64> {
    let mut found: Vec<u64> = Vec::new();
    (2..).filter(move |&n| {
        let prime = found.iter().take_while(|&&p| p * p <= n).all(|p| n % p != 0);
        if prime {
            found.push(n);
        }
        prime
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bases_are_the_first_primes() {
        assert_eq!(primes().take(10).collect::<Vec<_>>(), [2, 3, 5, 7, 11, 13, 17, 19, 23, 29]);
    }

    #[test]
    fn digits_are_mirrored_at_the_point() {
        assert_eq!(radical_inverse(2, 0), 0.0);
        assert_eq!(radical_inverse(2, 0b1101), 0b1011 as f64 / 16.0);
        assert_eq!(radical_inverse(3, 5), 7.0 / 9.0);
    }

    #[test]
    fn coordinates_stay_below_one_at_the_far_end() {
        for base in primes().take(200) {
            assert!((0.0..1.0).contains(&radical_inverse(base, LEN - 1)));
            let digits_all_largest = std::iter::successors(Some(base), |power| power.checked_mul(base)).last();
            assert!(radical_inverse(base, digits_all_largest.expect("a first power") - 1) < 1.0);
        }
        let nearly_one = 1.0_f64.next_down();
        assert!(rotate(nearly_one, nearly_one) < 1.0);
    }
}
