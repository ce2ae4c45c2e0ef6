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
use super::lanes::{LANES, Lanes};
use super::plane::Plane;
use super::run::{Interpolation, Run, point_weight};
use crate::star::BoxKind;
use std::array::from_fn;
use std::ops::Range;

/// The places of the points that some boxes of a part hold along x, and of the points that all boxes hold. The numbers
/// are of the same type as the weights, so that all parts are compared at once.
struct Inside {
    some: [[f64; LANES]; 2],
    all: [[f64; LANES]; 2],
    /// The first place on the right.
    middle: [f64; LANES],
    /// 1 for a part whose undecided points have a price, or 0.
    priced: [f64; LANES],
}

impl Inside {
    fn of<'a>(kind: BoxKind, part: impl Fn(usize) -> &'a Ends) -> Self {
        let place = |of: fn([Range<u32>; 2]) -> u32| from_fn(|at| f64::from(of(part(at).inside(kind))));
        Self {
            some: [place(|[_, some]| some.start), place(|[_, some]| some.end)],
            all: [place(|[all, _]| all.start), place(|[all, _]| all.end)],
            middle: from_fn(|at| f64::from(part(at).left.end)),
            priced: from_fn(|at| f64::from(u8::from(part(at).are_apart()))),
        }
    }
}

/// Returns an upper bound on the difference of every box, for each part of a region. If there are fewer parts than
/// lanes, the last bound is repeated.
///
/// # Panics
/// There is no part, or there are more parts than lanes.
#[inline(always)]
pub(super) fn bounds(
    kind: BoxKind,
    widths: [f64; 2],
    runs: &[(u32, Run)],
    parts: &[Ends],
    plane: &Plane,
) -> [f64; LANES] {
    assert!(parts.len() <= LANES, "there is a lane for each part");
    let is_closed = kind == BoxKind::Closed;
    let point = point_weight(kind);
    let part = |at: usize| &parts[at.min(parts.len() - 1)];
    let inside = Inside::of(kind, part);
    let totals: [f64; LANES] = from_fn(|at| total_price(kind, part(at), plane));
    let paid_widths = from_fn(|at| {
        let [narrowest, widest] = part(at).widths(plane);
        let paid = totals[at] / 2.0 / plane.n;
        if is_closed { narrowest + paid } else { widest - paid }
    });
    let paid_widths = Interpolation::between(widths, paid_widths);
    let (zero, half) = (Lanes::all(0.0), Lanes::all(0.5));
    let [mut tail, mut any] = [zero; 2];
    // `G - M h` from 0 up to the current y, and its extremes, whose difference is `E`.
    let [mut excess, mut lowest, mut highest] = [zero; 3];
    for (place, run) in runs {
        let [below, above] = if *place == NO_POINT { [0.0; 2] } else { plane.prices_at(*place) };
        // A closed box pays for the gap between the point and the other side.
        let [on_left, on_right] = if is_closed { [above, below] } else { [below, above] };
        let place = f64::from(*place);
        let (mut weight, mut price) = ([0.0; LANES], [0.0; LANES]);
        for at in 0..LANES {
            let some = (inside.some[0][at] <= place) & (place < inside.some[1][at]);
            let all = (inside.all[0][at] <= place) & (place < inside.all[1][at]);
            let held = if is_closed { some } else { all };
            weight[at] = if held { point } else { 0.0 };
            let by_side = if place < inside.middle[at] { on_left } else { on_right };
            price[at] = (if some & !all { by_side } else { 0.0 }) * inside.priced[at];
        }
        let (weight, price) = (Lanes::from(weight), Lanes::from(price));
        let next = run.parts.at(&paid_widths);
        let at_point = (tail + (weight - price * half)).greatest(zero);
        any = any.greatest(at_point).greatest(next.any.greatest(at_point + next.head));
        tail = (at_point + next.sum).greatest(next.tail);
        excess = excess + price;
        highest = highest.greatest(excess);
        excess = excess - Lanes::from(totals) * Lanes::all(run.height);
        lowest = lowest.least(excess);
    }
    let (any, range) = (any.numbers(), (highest - lowest).numbers());
    from_fn(|at| {
        let (total, range) = (totals[at], range[at]);
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
