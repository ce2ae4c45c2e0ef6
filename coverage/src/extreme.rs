//! The extreme discrepancy: the largest difference between the share of points in an axis-parallel box and its
//! volume.
//!
//! Any dimension is searched by the search for the star discrepancy (`star`), with two free sides per axis. In the
//! plane the search cuts other regions, which are far fewer (`strips`). On a line there is a formula (`line`).

mod bounds;
mod ends;
mod lanes;
mod line;
mod plane;
mod run;
mod strips;

use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::star::{Cell, Sides, largest_difference};
use crate::{Bracket, Deadline, PointSet};
use line::extreme_on_the_line;
use plane::Plane;
use strips::Strips;

impl Measure {
    /// The measure "extreme discrepancy", which compares volume and share of tests over all axis-parallel boxes.
    pub const EXTREME: Self = Self::of(&Descriptor {
        name: "extreme",
        key: "extreme_discrepancy",
        label: "extreme discrepancy",
        title: "extreme discrepancy",
        about: "the largest difference between the volume of any box and its share of the tests",
        pace: 7,
        compare: Compare::WhereQuick(is_quick),
        method: Computation::Bracket(extreme_discrepancy),
    });
}

/// The largest number of combinations of coordinates for which the search takes milliseconds.
const QUICK: f64 = 4e6;
/// The largest number of points in the plane for which the search takes a second or two.
const QUICK_IN_THE_PLANE: usize = 10_000;
/// The largest number of points in the plane for which one task can keep all open regions of strips.
const MOST_IN_STRIPS: usize = 275_000;

/// Returns `true` if the extreme discrepancy of so many points takes little time.
fn is_quick(dims: usize, points: usize) -> bool {
    dims == 1 || (dims == 2 && points <= QUICK_IN_THE_PLANE) || libm::pow(points as f64, dims as f64) <= QUICK
}

/// Computes the extreme discrepancy of a set of points. The extreme discrepancy is the largest of `vol (a,b) - #{a < x
/// < b} / n` and `#{a <= x <= b} / n - vol [a,b]` over all axis-parallel boxes in the unit cube (Niederreiter, Random
/// Number Generation and Quasi-Monte Carlo Methods, 1992, section 2.1).
///
/// The result is exact, in any dimension, unless `deadline` or memory (some 200 MiB for each thread) cuts the search short. In the
/// plane 10,000 points take about a second. On a line the time is O(n log n). The discrepancy of a set without points
/// is 1, because the whole cube is uncovered.
pub fn extreme_discrepancy(points: &PointSet, deadline: Deadline) -> Bracket {
    if points.is_empty() {
        return Bracket::exact(1.0);
    }
    if points.dims() == 1 {
        return Bracket::exact(extreme_on_the_line(points));
    }
    let sides = Sides::of_all_boxes(points);
    if points.dims() == 2 && points.len() <= MOST_IN_STRIPS {
        largest_difference::<Strips>(&Plane::of(points), &sides, deadline)
    } else {
        largest_difference::<Cell>(&sides, &sides, deadline)
    }
}
