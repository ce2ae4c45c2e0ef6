//! The star discrepancy: how far the share of points in a box anchored at 0 is from the box's volume, at worst.
//!
//! The two differences, of open and of closed boxes, are searched by branch and bound over cells of boxes
//! (`search`). A cell knows the points that are in all of its boxes and in none; what the undecided ones allow is
//! bounded by a choice per side that dynamic programming solves (`cell`). A first good value comes from local
//! search (`ascent`). Boxes are described by their free sides (`sides`), so that the same serves the extreme
//! discrepancy, whose boxes have twice as many.

mod ascent;
mod cell;
mod search;
mod sides;

use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::{Bracket, Deadline, PointSet};
pub(crate) use search::largest_difference;
pub(crate) use sides::Sides;

impl Measure {
    /// The star discrepancy.
    pub const STAR: Self = Self::of(&Descriptor {
        name: "star",
        key: "star_discrepancy",
        label: "star discrepancy",
        title: "star discrepancy",
        about: "the largest difference of volume and share of tests over boxes at the origin",
        pace: 6,
        compare: Compare::Always,
        method: Computation::Bracket(star_discrepancy),
    });
}

/// The star discrepancy: the largest of `vol [0,y) - #{x < y} / n` and `#{x <= y} / n - vol [0,y)` over all `y`
/// in the unit cube (Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods, 1992, section 2.1).
///
/// Exact, in any dimension, unless `deadline` or memory (some 200 MiB) cuts the search short. A set without points leaves the whole
/// cube uncovered: 1.
pub fn star_discrepancy(points: &PointSet, deadline: Deadline) -> Bracket {
    if points.is_empty() {
        return Bracket::exact(1.0);
    }
    largest_difference(&Sides::of_anchored_boxes(points), deadline)
}
