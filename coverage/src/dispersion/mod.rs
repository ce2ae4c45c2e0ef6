//! Dispersion: the largest open axis-parallel box in the unit cube that no point has entered.
//!
//! Every empty box is what is left of the cube after each point has been cut away along some axis, on one of its
//! two sides. The search branches on that: it takes a point inside the box at hand, the pivot, and tries its
//! `2d` cuts. A box without points inside is a candidate; one that is no larger than the best candidate is
//! dropped. Three things keep this small:
//!
//! * Children are disjoint. The cuts of a pivot are tried in an order, and the child of a later cut carries the
//!   constraint that the earlier ones were not made (`Side::kept`), so that no empty box is found twice. The larger a child, the later in the order and the more constrained it is.
//! * The pivot is chosen well: the one whose children's volumes have the least sum of cubes. That prefers points
//!   near the centre, and above all points that constraints and the best candidate leave few cuts.
//! * Volumes are products of differences, which floating-point rounding keeps monotone: a box inside another is
//!   never computed to be larger. Pruning on computed volumes is exact, without tolerances.
//!
//! The search of one box (`search.rs`) is depth-first with a stack of its own, because boxes can be cut `n` deep; the
//! larger children are explored first, which finds good candidates early. The search of the cube (`hunt.rs`) shares
//! boxes out to all cores; under a time limit it gives up being exact in time to close in on the answer from both
//! sides.
//!
//! The pivots of a search that found nothing above a volume prove that there is nothing (`trail.rs`).
//!
//! An interval needs no search, and rectangles have one of their own (`plane.rs`).

mod hunt;
mod plane;
mod search;
mod side;
mod trail;

pub(crate) use trail::trail;

use crate::measure::{Compare, Computation, Descriptor, Measure};
pub use crate::witness::{Dispersion, LargestEmptyBox};
use crate::{Bracket, Deadline, PointSet};
use hunt::Hunt;
use plane::Plane;

impl Measure {
    /// The volume of the largest box without a test.
    pub const DISPERSION: Self = Self::of(&Descriptor {
        name: "dispersion",
        key: "dispersion",
        label: "dispersion",
        title: "dispersion",
        about: "the volume of the largest box that no test has entered, as a share of the space",
        pace: 4,
        compare: Compare::Always,
        method: Computation::Hole(dispersion_watched),
    });
}

/// The largest volume over the open axis-parallel boxes in `[0,1]^d` that hold none of the points. A point on a
/// face of a box is not in it; of a set without points the largest is the cube, with volume 1 (Rote, Tichy,
/// Quasi-Monte Carlo methods and the dispersion of point sequences, Math. Comput. Modelling 23, 1996).
///
/// Exact, in any dimension, unless `deadline` cuts the search short (in one dimension it never does), or from three
/// dimensions on memory (some 200 MiB), which only many points on a curved surface need. Volume and witness of an exact
/// result do not depend on the number of threads.
pub fn dispersion(points: &PointSet, deadline: Deadline) -> Dispersion {
    dispersion_watched(points, deadline, &mut |_| ())
}

/// The [`dispersion`], while `watch` sees the bracket close.
pub fn dispersion_watched(points: &PointSet, deadline: Deadline, watch: &mut dyn FnMut(Bracket)) -> Dispersion {
    largest_above(points, f64::NEG_INFINITY, deadline, watch)
}

/// Whether the dispersion is at most `volume`; `None` if that was not known at the deadline. To know it takes less
/// than to know the dispersion.
pub fn is_at_most(points: &PointSet, volume: f64, deadline: Deadline) -> Option<bool> {
    let slab = widest_slab(points);
    match points.dims() {
        1 => Some(slab.volume() <= volume),
        2 => Plane::new(points, slab, volume).finds_none(volume, deadline),
        _ => Hunt::new(points, slab, volume).finds_none(volume, deadline),
    }
}

/// The dispersion, if it is not proved to be at most `above`.
pub(crate) fn larger_than(points: &PointSet, above: f64, deadline: Deadline) -> Option<Dispersion> {
    let found = largest_above(points, above, deadline, &mut |_| ());
    (found.volume.upper > above).then_some(found)
}

/// The dispersion, if it is more than `above`; otherwise some empty box, as if it were the largest.
fn largest_above(points: &PointSet, above: f64, deadline: Deadline, watch: &mut dyn FnMut(Bracket)) -> Dispersion {
    let slab = widest_slab(points);
    match points.dims() {
        1 => Dispersion { volume: Bracket::exact(slab.volume()), witness: slab },
        2 => {
            watch(Bracket { lower: slab.volume(), upper: 1.0 });
            Plane::new(points, slab, above).run(deadline)
        }
        _ => Hunt::new(points, slab, above).run(deadline, watch),
    }
}

/// The widest gap between neighbouring coordinates along any axis, as a box across the whole cube: the candidate
/// that the search starts from.
fn widest_slab(points: &PointSet) -> LargestEmptyBox {
    let dims = points.dims();
    let gaps = (0..dims).flat_map(|axis| {
        let mut coordinates: Vec<f64> = points.iter().map(|point| point[axis]).chain([0.0, 1.0]).collect();
        coordinates.sort_unstable_by(f64::total_cmp);
        let gaps = coordinates.windows(2).map(|gap| (axis, gap[0], gap[1]));
        gaps.collect::<Vec<_>>()
    });
    let width = |gap: &(usize, f64, f64)| gap.2 - gap.1;
    let (axis, lower, upper) = gaps.max_by(|a, b| width(a).total_cmp(&width(b))).expect("0 and 1 are apart");
    let mut slab = LargestEmptyBox { lower: vec![0.0; dims], upper: vec![1.0; dims] };
    (slab.lower[axis], slab.upper[axis]) = (lower, upper);
    slab
}
