//! Sequences of points and gaps along y, with the largest sums of the weights of their parts.

use super::lanes::{LANES, Lanes};
use crate::star::BoxKind;

/// The number of widths at which a run knows its parts. With two widths the straight lines between them are so far
/// from the truth that some regularly spread points need many more cuts.
pub(super) const NODES: usize = LANES;

/// The weights of points and gaps, for boxes of one kind and one width.
#[derive(Clone, Copy)]
pub(super) struct Weights {
    /// The weight of a point.
    pub(super) point: f64,
    /// The weight of a gap of height 1.
    pub(super) gap: f64,
}

impl Weights {
    /// Makes the weights for boxes of the given width, among `n` points.
    pub(super) fn of(kind: BoxKind, n: f64, width: f64) -> Self {
        match kind {
            BoxKind::Open => Self { point: -1.0, gap: n * width },
            BoxKind::Closed => Self { point: 1.0, gap: -n * width },
        }
    }
}

/// The sum of the weights of a sequence, and the largest sums of its parts, at some widths. The empty part counts, so
/// that the largest sums are not negative.
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
    pub(super) fn at(&self, widths: &Widths) -> Self {
        Self {
            sum: widths.of(self.sum),
            head: widths.of(self.head),
            tail: widths.of(self.tail),
            any: widths.of(self.any),
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

/// Some widths between the least and the greatest width of a run: for each width at which the run knows its parts, the
/// weight that it has at each of the widths, in the straight line to this width.
pub(super) struct Widths([Lanes; NODES]);

impl Widths {
    /// Makes the widths `widths` between the least and the greatest width of a run.
    pub(super) fn between([narrowest, widest]: [f64; 2], widths: [f64; LANES]) -> Self {
        let steps = widths.map(|width| {
            let share = if widest > narrowest { (width - narrowest) / (widest - narrowest) } else { 0.0 };
            share.clamp(0.0, 1.0) * (NODES - 1) as f64
        });
        Self(std::array::from_fn(|node| steps.map(|steps| f64::max(1.0 - (steps - node as f64).abs(), 0.0)).into()))
    }

    #[inline(always)]
    fn of(&self, numbers: Lanes) -> Lanes {
        let [a, b, c, d] = numbers.numbers();
        let [e, f, g, h] = &self.0;
        (Lanes::all(a) * *e + Lanes::all(b) * *f) + (Lanes::all(c) * *g + Lanes::all(d) * *h)
    }
}
