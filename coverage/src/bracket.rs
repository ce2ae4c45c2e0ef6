//! The result of a measure that may be stopped early: a certified interval.

use serde::{Deserialize, Serialize};

/// A certified interval that contains an exact value, so that `lower <= exact <= upper`.
///
/// `lower == upper` means that the value was computed to the end. It is exact but for the rounding of that
/// computation: a product of differences for a volume, a distance for a radius.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bracket {
    /// The lower bound on the exact value, which is the largest value that the search found.
    pub lower: f64,
    /// The upper bound on the exact value, which is the smallest bound that the search proved.
    pub upper: f64,
}

impl Bracket {
    /// Makes a bracket whose lower and upper bound are the given exact value.
    pub fn exact(value: f64) -> Self {
        Self { lower: value, upper: value }
    }

    /// Returns `true` if the lower and the upper bound are equal, so that the value is exact.
    pub fn is_exact(&self) -> bool {
        self.lower == self.upper
    }
}
