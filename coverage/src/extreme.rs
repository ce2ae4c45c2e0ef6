//! The extreme discrepancy: how far the share of points in an axis-parallel box is from the box's volume, at worst.

use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::star::{Sides, largest_difference};
use crate::{Bracket, Deadline, PointSet};

impl Measure {
    /// The extreme discrepancy.
    pub const EXTREME: Self = Self::of(&Descriptor {
        name: "extreme",
        key: "extreme_discrepancy",
        label: "extreme discrepancy",
        title: "extreme discrepancy",
        about: "the largest difference of volume and share of tests over all boxes",
        pace: 7,
        compare: Compare::WhereQuick(|dims, points| libm::pow(points as f64, dims as f64) <= QUICK),
        method: Computation::Bracket(extreme_discrepancy),
    });
}

/// The search takes milliseconds for so many combinations of coordinates.
const QUICK: f64 = 4e6;

/// The extreme discrepancy: the largest of `vol (a,b) - #{a < x < b} / n` and `#{a <= x <= b} / n - vol [a,b]`
/// over all axis-parallel boxes in the unit cube (Niederreiter, Random Number Generation and Quasi-Monte Carlo
/// Methods, 1992, section 2.1).
///
/// Exact, in any dimension, unless `deadline` or memory (some 200 MiB) cuts the search short. A set without points leaves the whole
/// cube uncovered: 1.
pub fn extreme_discrepancy(points: &PointSet, deadline: Deadline) -> Bracket {
    if points.is_empty() {
        return Bracket::exact(1.0);
    }
    largest_difference(&Sides::of_all_boxes(points), deadline)
}
