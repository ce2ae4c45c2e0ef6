//! Sequences of points and gaps along y, with the largest sums of the weights of their parts.

use super::lanes::{LANES, Lanes};
use crate::star::BoxKind;

/// The number of widths at which a run knows its parts: one for each lane. With two widths the straight lines between
/// them are so far from the truth that some regularly spread points need many more cuts.
pub(super) const NODES: usize = LANES;

/// Returns the weight of a point, for boxes of one kind.
pub(super) fn point_weight(kind: BoxKind) -> f64 {
    match kind {
        BoxKind::Open => -1.0,
        BoxKind::Closed => 1.0,
    }
}

/// Returns the weight of a gap of height 1, for boxes of one kind and one width among `n` points.
pub(super) fn gap_weight(kind: BoxKind, n: f64, width: f64) -> f64 {
    match kind {
        BoxKind::Open => n * width,
        BoxKind::Closed => -n * width,
    }
}

/// The sum of the weights of a sequence, and the largest sums of its parts, each at the widths of the run. The empty
/// part counts, so that the largest sums are not negative.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    pub(super) sum: Lanes,
    /// The largest sum of a part at the start.
    pub(super) head: Lanes,
    /// The largest sum of a part at the end.
    pub(super) tail: Lanes,
    /// The largest sum of any part.
    pub(super) any: Lanes,
}

impl Parts {
    /// Makes the parts of a single point or a single gap.
    #[inline(always)]
    pub(super) fn of(weight: Lanes) -> Self {
        let most = weight.greatest(Lanes::all(0.0));
        Self { sum: weight, head: most, tail: most, any: most }
    }

    /// Returns the parts of a sequence that continues with another sequence.
    #[inline(always)]
    pub(super) fn followed_by(self, next: Self) -> Self {
        Self {
            sum: self.sum + next.sum,
            head: self.head.greatest(self.sum + next.head),
            tail: next.tail.greatest(next.sum + self.tail),
            any: self.any.greatest(next.any).greatest(self.tail + next.head),
        }
    }

    /// Returns the parts at other widths.
    #[inline(always)]
    pub(super) fn at(&self, widths: &Interpolation) -> Self {
        Self {
            sum: widths.interpolated(self.sum),
            head: widths.interpolated(self.head),
            tail: widths.interpolated(self.tail),
            any: widths.interpolated(self.any),
        }
    }
}

/// A sequence of points and gaps, for boxes whose width is between a least and a greatest width.
///
/// The largest sums are convex functions of the width, because each is the largest of several linear functions. The
/// straight lines between the largest sums at some widths are therefore an upper bound for all widths between them.
#[derive(Clone, Copy)]
pub(super) struct Run {
    /// The sum of the gaps.
    pub(super) height: f64,
    /// The parts at evenly spaced widths, from the least to the greatest width.
    pub(super) parts: Parts,
}

impl Run {
    /// Makes the run that is a single gap. The weights are the weights of a gap of height 1 at the widths of the run.
    pub(super) fn gap(height: f64, weights: [f64; NODES]) -> Self {
        Self { height, parts: Parts::of(weights.map(|weight| weight * height).into()) }
    }

    /// Returns the run at other widths, between the least and the greatest width.
    #[inline(always)]
    pub(super) fn at(&self, widths: &Interpolation) -> Self {
        Self { height: self.height, parts: self.parts.at(widths) }
    }
}

/// Widths between the least and the greatest width of a run. The parts at these widths are interpolated between the
/// widths at which the run knows its parts. The field holds the weights of each of the latter.
pub(super) struct Interpolation([Lanes; NODES]);

impl Interpolation {
    /// Makes the interpolation at `widths`, which are between the least and the greatest width of a run.
    pub(super) fn between([narrowest, widest]: [f64; 2], widths: [f64; LANES]) -> Self {
        let steps = widths.map(|width| {
            let share = if widest > narrowest { (width - narrowest) / (widest - narrowest) } else { 0.0 };
            share.clamp(0.0, 1.0) * (NODES - 1) as f64
        });
        Self(std::array::from_fn(|node| steps.map(|steps| f64::max(1.0 - (steps - node as f64).abs(), 0.0)).into()))
    }

    #[inline(always)]
    fn interpolated(&self, numbers: Lanes) -> Lanes {
        let [a, b, c, d] = numbers.numbers().map(Lanes::all);
        let [e, f, g, h] = self.0;
        (a * e + b * f) + (c * g + d * h)
    }
}
