//! Comparisons of numbers: their truth and their distance from the other truth.

use crate::worth::Worth;

/// A comparison of two numbers, such as `<` or `==`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comparison {
    /// The comparison `left < right`.
    Below,
    /// The comparison `left <= right`.
    AtMost,
    /// The comparison `left > right`.
    Above,
    /// The comparison `left >= right`.
    AtLeast,
    /// The comparison `left == right`.
    Equal,
    /// The comparison `left != right`.
    Different,
}

impl Comparison {
    pub(crate) const ALL: [Self; 6] =
        [Self::Below, Self::AtMost, Self::Above, Self::AtLeast, Self::Equal, Self::Different];

    /// Returns `true` if the comparison holds between `left` and `right`. With NaN only [`Different`](Self::Different)
    /// holds.
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Comparison::Below => left < right,
            Comparison::AtMost => left <= right,
            Comparison::Above => left > right,
            Comparison::AtLeast => left >= right,
            Comparison::Equal => left == right,
            Comparison::Different => left != right,
        }
    }

    /// Returns the robustness of the comparison, for numbers that are not NaN. For equal infinities the distance is 0.
    pub(crate) fn worth(self, left: f64, right: f64) -> Worth {
        if left == right {
            let holds = matches!(self, Comparison::AtMost | Comparison::AtLeast | Comparison::Equal);
            return Worth::of(if holds { 0.0 } else { -0.0 });
        }
        Worth::of(match self {
            Comparison::Below | Comparison::AtMost => right - left,
            Comparison::Above | Comparison::AtLeast => left - right,
            Comparison::Equal => -(left - right).abs(),
            Comparison::Different => (left - right).abs(),
        })
    }

    /// Returns the symbol of the comparison in formulas, such as `<`.
    pub fn symbol(self) -> &'static str {
        match self {
            Comparison::Below => "<",
            Comparison::AtMost => "<=",
            Comparison::Above => ">",
            Comparison::AtLeast => ">=",
            Comparison::Equal => "==",
            Comparison::Different => "!=",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comparison_is_worth_a_distance_whose_sign_is_its_truth() {
        let numbers = [f64::NEG_INFINITY, -1.0, 0.0, f64::MIN_POSITIVE, 2.0, f64::INFINITY];
        for comparison in Comparison::ALL {
            for (left, right) in numbers.iter().flat_map(|left| numbers.iter().map(move |right| (*left, *right))) {
                let worth = comparison.worth(left, right);
                assert_eq!(worth.holds(), comparison.holds(left, right), "{left} {} {right}", comparison.symbol());
                assert_eq!(worth.robustness() == 0.0, left == right);
            }
        }
    }
}
