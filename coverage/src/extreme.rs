//! The extreme discrepancy: how far the share of points in an axis-parallel box is from the box's volume, at worst.

use crate::star::{Sides, largest_difference};
use crate::{Bracket, Deadline, PointSet};

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
