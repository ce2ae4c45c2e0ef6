//! Dispersion: the largest open axis-parallel box in the unit cube that no point has entered.
//!
//! An empty box is what is left of the cube after each point has been cut away along some axis, on one of the box's
//! two sides. The search branches on these cuts: it takes a point inside the current box, the pivot, and tries its
//! `2d` cuts. A box without points inside is a candidate. A box that is no larger than the best candidate is dropped.
//! Three things keep the search small:
//!
//! * Children are disjoint. The cuts of a pivot are tried in an order, and the child of a later cut carries the
//!   constraint that the earlier cuts were not made (`Side::kept`), so that no empty box is found twice. Larger
//!   children come later in the order and are more constrained.
//! * The pivot is chosen well: it is the point whose children's volumes have the least sum of cubes. That prefers
//!   points near the centre, and above all points to which constraints and the best candidate leave few cuts.
//! * Volumes are products of differences, which floating-point rounding keeps monotone: a box inside another is
//!   never computed to be larger. Pruning on computed volumes is exact, without tolerances.
//!
//! The search of one box (`search.rs`) is depth-first with a stack of its own, because boxes can be cut `n` deep. It
//! explores the larger children first, which finds good candidates early. The search of the cube (`hunt.rs`) shares
//! boxes out to all cores. Under a time limit it gives up the exact search early enough to narrow the bracket from
//! both sides.
//!
//! If a search found nothing above a volume, its pivots prove that no box is larger (`trail.rs`).
//!
//! One dimension needs no search, and two dimensions have a search of their own (`plane.rs`).
//!
//! If constraints cut a valid part out of the cube, a box weighs what it has of this part (`valid.rs`).

mod hunt;
mod plane;
mod search;
mod side;
mod trail;
mod valid;

pub(crate) use trail::trail;

use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::valid::ValidPart;
pub use crate::witness::{Dispersion, LargestEmptyBox};
use crate::{Bracket, Deadline, PointSet};
use hunt::Hunt;
use plane::Plane;
use side::Volume;

impl Measure {
    /// The measure "dispersion", which is the volume of the largest box without a test.
    pub const DISPERSION: Self = Self::of(&Descriptor {
        name: "dispersion",
        key: "dispersion",
        label: "dispersion",
        title: "dispersion",
        about: "the volume of the largest box that no test has entered, as a share of the valid part of the space",
        pace: 4,
        compare: Compare::Always,
        method: Computation::Hole(dispersion_within),
    });
}

/// Computes the dispersion of points, which is the largest volume of an open axis-parallel box in `[0,1]^d` without a
/// point. A point on a face of a box is not in the box. The dispersion of a set without points is 1, the volume of the
/// cube (Rote, Tichy, Quasi-Monte Carlo methods and the dispersion of point sequences, Math. Comput. Modelling 23,
/// 1996).
///
/// The result is exact, in any dimension, unless `deadline` cuts the search short (in one dimension it never does).
/// From three dimensions on, the limit of memory (some 200 MiB) can also cut it short, but only for many points on a
/// curved surface. Volume and witness of an exact result do not depend on the number of threads.
pub fn dispersion(points: &PointSet, deadline: Deadline) -> Dispersion {
    dispersion_within(points, None, deadline, &mut |_| ())
}

/// Computes the [`dispersion`] of points, and calls `watch` with the present bracket each time the bracket narrows. If a
/// valid part is given, a box has the volume of its valid part, as a share of the whole valid part.
pub fn dispersion_within(
    points: &PointSet,
    valid: Option<&ValidPart>,
    deadline: Deadline,
    watch: &mut dyn FnMut(Bracket),
) -> Dispersion {
    match valid {
        Some(valid) => valid::largest(points, valid, deadline, watch),
        None => largest_above(points, f64::NEG_INFINITY, deadline, watch),
    }
}

/// Returns true if the dispersion of the points is at most `volume`; `None` if the answer is not known at the deadline.
/// This check takes less time than the computation of the dispersion. See [`valid_is_at_most`] for the valid part of a space.
pub fn is_at_most(points: &PointSet, volume: f64, deadline: Deadline) -> Option<bool> {
    let slab = widest_slab(points);
    match points.dims() {
        1 => Some(slab.volume() <= volume),
        2 => Plane::new(points, slab, volume).finds_none(volume, deadline),
        _ => Hunt::new(points, Volume, slab, volume).finds_none(volume, deadline),
    }
}

/// Returns true if the dispersion of the points within the valid part is at most `share`; `None` if the answer is not known at
/// the deadline, or if it depends on undecided cells of the valid part.
pub fn valid_is_at_most(points: &PointSet, valid: &ValidPart, share: f64, deadline: Deadline) -> Option<bool> {
    match valid::larger_than(points, valid, share, deadline) {
        None => Some(true),
        Some(found) if found.volume.lower > share => Some(false),
        Some(found) => (found.volume.upper <= share).then_some(true),
    }
}

/// Returns the dispersion of points, within the valid part if there is one; `None` if the search proves that the dispersion is
/// at most `above`.
pub(crate) fn larger_than(
    points: &PointSet,
    valid: Option<&ValidPart>,
    above: f64,
    deadline: Deadline,
) -> Option<Dispersion> {
    if let Some(valid) = valid {
        return valid::larger_than(points, valid, above, deadline);
    }
    let found = largest_above(points, above, deadline, &mut |_| ());
    (found.volume.upper > above).then_some(found)
}

/// The dispersion if it is more than `above`; otherwise some empty box, reported as if it were the largest.
fn largest_above(points: &PointSet, above: f64, deadline: Deadline, watch: &mut dyn FnMut(Bracket)) -> Dispersion {
    let slab = widest_slab(points);
    match points.dims() {
        1 => Dispersion { volume: Bracket::exact(slab.volume()), witness: slab },
        2 => {
            watch(Bracket { lower: slab.volume(), upper: 1.0 });
            Plane::new(points, slab, above).run(deadline)
        }
        _ => Hunt::new(points, Volume, slab, above).run(deadline, watch),
    }
}

/// The widest gap between neighbouring coordinates along any axis, as a box across the whole cube. The search starts
/// from this candidate.
fn widest_slab(points: &PointSet) -> LargestEmptyBox {
    let width = |(_, lower, upper): &(usize, f64, f64)| upper - lower;
    let widest = gaps(points).max_by(|a, b| width(a).total_cmp(&width(b))).expect("0 and 1 are apart");
    slab(points.dims(), widest)
}

/// Iterates over the gaps between neighbouring coordinates: the axis, and the lower and the upper end.
fn gaps(points: &PointSet) -> impl Iterator<Item = (usize, f64, f64)> {
    (0..points.dims()).flat_map(|axis| {
        let mut coordinates: Vec<f64> = points.iter().map(|point| point[axis]).chain([0.0, 1.0]).collect();
        coordinates.sort_unstable_by(f64::total_cmp);
        let gaps = coordinates.windows(2).map(|gap| (axis, gap[0], gap[1]));
        gaps.collect::<Vec<_>>()
    })
}

/// Returns a gap as a box across the whole cube.
fn slab(dims: usize, (axis, lower, upper): (usize, f64, f64)) -> LargestEmptyBox {
    let mut slab = LargestEmptyBox { lower: vec![0.0; dims], upper: vec![1.0; dims] };
    (slab.lower[axis], slab.upper[axis]) = (lower, upper);
    slab
}
