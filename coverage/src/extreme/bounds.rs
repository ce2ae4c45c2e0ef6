//! Upper bounds on the differences of the boxes of all parts of a region, in one pass over its runs.
//!
//! The bound of a part takes the narrowest closed boxes, or the widest open boxes, with the most favourable weight of
//! each undecided point. But a closed box that takes in the points at a position is wider by a gap between positions. An
//! open box that leaves out the points at a position is narrower by a gap. The price of a point is the number of points
//! that this gap would hold in a set of evenly spread points. A box of height `h` pays `h G` at least, where `G` is the
//! sum of the prices of undecided points between bottom and top.
//!
//! This product is bounded from below by a sum. Let `M` be the sum of all prices, and `E` the largest of `|G - M h|`
//! over all bottoms and tops. Then `(h - 1/2) (G - M/2) >= -E^2 / (4 M)`, and thus `h G >= G/2 + M h/2 - M/4 - E^2 / (4
//! M)`: the box pays half a price for each undecided point, and `M/2` for its height. This holds for any `M`, and
//! therefore for a rounded sum, too.
//!
//! Kadane's algorithm finds the largest sum of weights (Bentley, Programming Pearls, Communications of the ACM 27,
//! 1984). Each step of the algorithm waits for the step before. Therefore the loop takes one step for all parts at a
//! time.

use super::ends::{Ends, NO_POINT};
use super::plane::Plane;
use super::run::{NODES, Parts, Run, Width};
use crate::ordered::{greatest, least};
use crate::star::BoxKind;
use std::ops::Range;

/// The greatest number of parts of a region.
const PARTS: usize = 4;

/// A number for each part of a region.
type PerPart = [f64; PARTS];

/// Returns the numbers that a function gives for the parts.
#[inline(always)]
fn per_part(of: impl FnMut(usize) -> f64) -> PerPart {
    std::array::from_fn(of)
}

/// The places of the points that some boxes of a part hold along x, and of the points that all boxes hold. The numbers
/// are of the same type as the weights, so that all parts are compared at once.
struct Inside {
    some: [PerPart; 2],
    all: [PerPart; 2],
    /// The place from which on a point is on the right.
    middle: PerPart,
    /// 1 for a part whose undecided points have a price, or 0.
    priced: PerPart,
}

impl Inside {
    fn of<'a>(kind: BoxKind, part: impl Fn(usize) -> &'a Ends) -> Self {
        let place = |of: fn([Range<u32>; 2]) -> u32| per_part(|at| f64::from(of(part(at).inside(kind))));
        Self {
            some: [place(|[_, some]| some.start), place(|[_, some]| some.end)],
            all: [place(|[all, _]| all.start), place(|[all, _]| all.end)],
            middle: per_part(|at| f64::from(part(at).left.end)),
            priced: per_part(|at| f64::from(u8::from(part(at).are_apart()))),
        }
    }
}

/// Returns an upper bound on the difference of every box of each part of a region, and fills up with repetitions of the
/// last bound.
///
/// # Panics
/// There is no part.
pub(super) fn bounds(kind: BoxKind, widths: [f64; 2], runs: &[(u32, Run)], parts: &[Ends], plane: &Plane) -> PerPart {
    let is_closed = kind == BoxKind::Closed;
    let sign = if is_closed { 1.0 } else { -1.0 };
    let part = |at: usize| &parts[at.min(parts.len() - 1)];
    let inside = Inside::of(kind, part);
    let totals = per_part(|at| total_price(kind, part(at), plane));
    let weights: [_; PARTS] = std::array::from_fn(|at| {
        let [narrowest, widest] = part(at).widths(plane);
        let paid = totals[at] / 2.0 / plane.n;
        Width::between(widths, if is_closed { narrowest + paid } else { widest - paid }).weights()
    });
    let weights: [PerPart; NODES] = std::array::from_fn(|node| per_part(|at| weights[at][node]));
    let [mut tail, mut any] = [[0.0; PARTS]; 2];
    // `G - M h` from 0 up to the current y, and its extremes, whose difference is `E`.
    let [mut excess, mut lowest, mut highest] = [[0.0; PARTS]; 3];
    for (place, run) in runs {
        let [below, above] = if *place == NO_POINT { [0.0; 2] } else { plane.prices_at(*place) };
        // A closed box pays for the gap between the point and the other side.
        let [on_left, on_right] = if is_closed { [above, below] } else { [below, above] };
        let place = f64::from(*place);
        let parts = |of: fn(&Parts) -> f64| {
            per_part(|at| (0..NODES).map(|node| of(&run.parts[node]) * weights[node][at]).sum())
        };
        let (sums, heads) = (parts(|parts| parts.sum), parts(|parts| parts.head));
        let (tails, largest) = (parts(|parts| parts.tail), parts(|parts| parts.any));
        for at in 0..PARTS {
            let some = (inside.some[0][at] <= place) & (place < inside.some[1][at]);
            let all = (inside.all[0][at] <= place) & (place < inside.all[1][at]);
            let held = if is_closed { some } else { all };
            let weight = (if held { 1.0 } else { 0.0 }) * sign;
            let price = if place < inside.middle[at] { on_left } else { on_right };
            let price = (if some & !all { price } else { 0.0 }) * inside.priced[at];
            let at_point = greatest(tail[at] + (weight - price / 2.0), 0.0);
            any[at] = greatest(greatest(any[at], at_point), greatest(largest[at], at_point + heads[at]));
            tail[at] = greatest(at_point + sums[at], tails[at]);
            excess[at] += price;
            highest[at] = greatest(highest[at], excess[at]);
            excess[at] -= totals[at] * run.height;
            lowest[at] = least(lowest[at], excess[at]);
        }
    }
    per_part(|at| {
        let (total, range) = (totals[at], highest[at] - lowest[at]);
        let unpaid = if total > 0.0 { total / 4.0 + range * range / (4.0 * total) } else { 0.0 };
        plane.difference(any[at] + unpaid)
    })
}

/// Returns the sum of the prices of all undecided points of a part of a region.
fn total_price(kind: BoxKind, part: &Ends, plane: &Plane) -> f64 {
    if !part.are_apart() {
        return 0.0;
    }
    let [all, some] = part.inside(kind);
    let is_closed = kind == BoxKind::Closed;
    plane.prices(some.start..all.start, is_closed) + plane.prices(all.end..some.end, !is_closed)
}
