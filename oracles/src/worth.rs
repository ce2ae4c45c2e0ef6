//! The worth of a formula at a tick: its robustness and, if the robustness is 0, its truth.
//!
//! A robustness above 0 says that a formula holds, and below 0 that it is violated; 0 says neither. IEEE 754 has two
//! zeros, so one number can express both meanings: +0 means that the formula holds without any margin, -0 that it is
//! violated without any margin. In the total order of floats, the minimum is then the conjunction and the maximum is
//! the disjunction, for both meanings at once. A change of sign is the negation, and the sign bit is the truth. The
//! numbers are stored as integers with the same order. The negation of these integers is the bitwise complement.

use crate::Truth;

/// A robustness whose sign gives the truth of the formula, also for 0. The order runs from certainly violated to
/// certainly satisfied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Worth(i64);

impl Worth {
    /// The robustness of a formula that holds with an infinite margin. It is the conjunction of no formulas.
    pub const BEST: Self = Self(key(f64::INFINITY));
    /// The robustness of a formula that is violated with an infinite margin. It is the disjunction of no formulas.
    pub const WORST: Self = Self(key(f64::NEG_INFINITY));

    /// Makes a signed robustness from a number that is not NaN. A set sign bit means that the formula is violated.
    pub fn of(number: f64) -> Self {
        debug_assert!(!number.is_nan(), "a robustness is a number");
        Self(key(number))
    }

    /// Makes the robustness of a statement without a margin, which is infinity or, if `holds` is false, minus infinity.
    pub fn certain(holds: bool) -> Self {
        if holds { Self::BEST } else { Self::WORST }
    }

    pub fn holds(self) -> bool {
        self.0 >= 0
    }

    /// Returns the robustness as a number. A zero never has a sign that users could see.
    pub fn robustness(self) -> f64 {
        let bits = self.0 ^ ((self.0 >> 63) as u64 >> 1) as i64;
        f64::from_bits(bits as u64) + 0.0
    }

    /// Returns the robustness of the negated formula if `dual` is true, and otherwise the unchanged robustness.
    pub fn flipped(self, dual: bool) -> Self {
        Self(self.0 ^ -i64::from(dual))
    }
}

/// Returns the integer that has the same order as the floats, with -0 below +0.
const fn key(number: f64) -> i64 {
    let bits = number.to_bits() as i64;
    bits ^ ((bits >> 63) as u64 >> 1) as i64
}

/// Returns the truth of a formula whose worth lies between `lower` and `upper`.
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
