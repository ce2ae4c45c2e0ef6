//! What a formula is worth at a tick: its robustness and, where that is 0, its truth.
//!
//! Robustness above 0 says that a formula holds and below 0 that it does not; 0 says neither. IEEE 754 has two zeros,
//! and so one number can carry both meanings: a formula that holds with nothing to spare is worth +0, one that is
//! violated by nothing -0. In the total order of floating-point numbers minimum and maximum are then conjunction and
//! disjunction for both meanings at once, a change of sign is negation, and the sign bit is the truth. The numbers are
//! kept as the integers that have that order, in which negation is the bitwise complement.

use crate::Truth;

/// A robustness with its truth; ordered from surely violated to surely held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Worth(i64);

impl Worth {
    /// Held by a margin that nothing exceeds; the conjunction of nothing.
    pub const BEST: Self = Self(key(f64::INFINITY));
    /// The disjunction of nothing.
    pub const WORST: Self = Self(key(f64::NEG_INFINITY));

    /// The worth of a number that is not NaN, whose sign bit says whether the formula is violated.
    pub fn of(number: f64) -> Self {
        debug_assert!(!number.is_nan(), "a robustness is a number");
        Self(key(number))
    }

    /// The worth of a statement that is true or false by no measure.
    pub fn certain(holds: bool) -> Self {
        if holds { Self::BEST } else { Self::WORST }
    }

    pub fn holds(self) -> bool {
        self.0 >= 0
    }

    /// The robustness; neither zero has a sign that anybody should see.
    pub fn robustness(self) -> f64 {
        let bits = self.0 ^ ((self.0 >> 63) as u64 >> 1) as i64;
        f64::from_bits(bits as u64) + 0.0
    }

    /// The worth of the negated formula, if it is `dual`, and of the formula itself otherwise.
    pub fn flipped(self, dual: bool) -> Self {
        Self(self.0 ^ -i64::from(dual))
    }
}

/// The integer whose order is that of the floating-point numbers, -0 below +0.
const fn key(number: f64) -> i64 {
    let bits = number.to_bits() as i64;
    bits ^ ((bits >> 63) as u64 >> 1) as i64
}

/// The truth of a formula that is worth at least `lower` and at most `upper`.
pub(crate) fn truth(lower: Worth, upper: Worth) -> Truth {
    match (lower.holds(), upper.holds()) {
        (true, _) => Truth::Holds,
        (_, false) => Truth::Violated,
        _ => Truth::Undecided,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worths_have_the_order_of_numbers_with_the_violated_zero_below_the_held_one() {
        let numbers = [f64::NEG_INFINITY, -2.0, -f64::MIN_POSITIVE, -0.0, 0.0, 1e-300, 3.0, f64::INFINITY];
        assert!(numbers.map(Worth::of).is_sorted_by(|a, b| a < b));
        assert!(numbers.iter().all(|x| Worth::of(*x).robustness() == *x));
        assert!(numbers.iter().all(|x| Worth::of(*x).holds() == x.is_sign_positive()));
    }

    #[test]
    fn the_negation_of_a_worth_is_that_of_its_robustness_and_its_truth() {
        for x in [0.0, -0.0, 1.5, f64::NEG_INFINITY] {
            assert_eq!(Worth::of(x).flipped(true), Worth::of(-x));
            assert_eq!(Worth::of(x).flipped(false), Worth::of(x));
        }
    }
}
