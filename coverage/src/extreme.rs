//! The extreme discrepancy: the largest difference between the share of points in an axis-parallel box and its
//! volume.

use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::star::{Sides, largest_difference};
use crate::{Bracket, Deadline, PointSet};

impl Measure {
    /// The measure "extreme discrepancy", which compares volume and share of tests over all axis-parallel boxes.
    pub const EXTREME: Self = Self::of(&Descriptor {
        name: "extreme",
        key: "extreme_discrepancy",
        label: "extreme discrepancy",
        title: "extreme discrepancy",
        about: "the largest difference between the volume of any box and its share of the tests",
        pace: 7,
        compare: Compare::WhereQuick(|dims, points| libm::pow(points as f64, dims as f64) <= QUICK),
        method: Computation::Bracket(extreme_discrepancy),
    });
}

/// The largest number of combinations of coordinates for which the search takes milliseconds.
const QUICK: f64 = 4e6;

/// Computes the extreme discrepancy of a set of points. The extreme discrepancy is the largest of `vol (a,b) - #{a < x
/// < b} / n` and `#{a <= x <= b} / n - vol [a,b]` over all axis-parallel boxes in the unit cube (Niederreiter, Random
/// Number Generation and Quasi-Monte Carlo Methods, 1992, section 2.1).
///
/// The result is exact, in any dimension, unless `deadline` or memory (some 200 MiB) cuts the search short. The
/// discrepancy of a set without points is 1, because the whole cube is uncovered.
pub fn extreme_discrepancy(points: &PointSet, deadline: Deadline) -> Bracket {
    if points.is_empty() {
        return Bracket::exact(1.0);
    }
    largest_difference(&Sides::of_all_boxes(points), deadline)
}
