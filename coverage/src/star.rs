//! The star discrepancy: the largest difference between the share of points in a box anchored at 0 and its volume.
//!
//! Branch and bound over cells of boxes finds the two differences, for open and for closed boxes (`search`). A cell
//! knows which points are in all of its boxes, and which are in none. The effect of the undecided points is bounded
//! by a choice for each side, which dynamic programming solves (`cell`). A local search gives a first good value
//! (`ascent`). Boxes are described by their free sides (`sides`). The same code therefore computes the extreme
//! discrepancy, whose boxes have twice as many free sides. In the plane a sweep is much faster
//! (`sweep`), and on a line the points only have to be sorted (`line`).

mod ascent;
mod cell;
mod line;
mod region;
mod search;
mod sides;
mod sweep;

use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::{Bracket, Deadline, PointSet};
pub(crate) use cell::Cell;
pub(crate) use region::{BoxKind, Region, Relaxed};
pub(crate) use search::largest_difference;
pub(crate) use sides::Sides;

impl Measure {
    /// The measure "star discrepancy", which compares volume and share of tests over boxes at the origin.
    pub const STAR: Self = Self::of(&Descriptor {
        name: "star",
        key: "star_discrepancy",
        label: "star discrepancy",
        title: "star discrepancy",
        about: "the largest difference between the volume of a box at the origin and its share of the tests",
        pace: 6,
        compare: Compare::Always,
        method: Computation::Bracket(star_discrepancy),
    });
}

/// Computes the star discrepancy of a set of points. The star discrepancy is the largest of `vol [0,y) - #{x < y} / n`
/// and `#{x <= y} / n - vol [0,y)` over all `y` in the unit cube (Niederreiter, Random Number Generation and
/// Quasi-Monte Carlo Methods, 1992, section 2.1).
///
/// The result is exact, in any dimension, unless `deadline` or memory (some 200 MiB) cuts the search short. In the
/// plane the time is O(n sqrt(n)) for evenly spread points, and O(n^2) in the worst case. On a line it is O(n log n).
/// The discrepancy of a set without points is 1, because the whole cube is uncovered.
pub fn star_discrepancy(points: &PointSet, deadline: Deadline) -> Bracket {
    if points.is_empty() {
        return Bracket::exact(1.0);
    }
    let found = match points.dims() {
        1 => Some(line::star_on_the_line(points)),
        2 => sweep::star_in_the_plane(points, deadline),
        _ => None,
    };
    let sides = Sides::of_anchored_boxes(points);
    found.map_or_else(|| largest_difference::<Cell>(&sides, &sides, deadline), Bracket::exact)
}
