//! Sequences of points and gaps along y, with the largest sums of the weights of their parts.

use crate::ordered::greatest;
use crate::star::BoxKind;

/// The number of widths at which a run knows its parts. With two widths the straight lines between them are so far
/// from the truth that some regularly spread points need many more cuts.
pub(super) const NODES: usize = 3;

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

/// The sum of the weights of a sequence, and the largest sums of its parts. The empty part counts, so that the largest
/// sums are not negative.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    pub(super) sum: f64,
    /// The largest sum of a part at the start.
    pub(super) head: f64,
    /// The largest sum of a part at the end.
    pub(super) tail: f64,
    /// The largest sum of any part.
    pub(super) any: f64,
}

impl Parts {
    /// Makes the parts of a single point or a single gap.
    pub(super) fn of(weight: f64) -> Self {
        let most = greatest(weight, 0.0);
        Self { sum: weight, head: most, tail: most, any: most }
    }

    /// Returns the parts of a sequence that continues with another sequence.
    fn followed_by(self, next: Self) -> Self {
        Self {
            sum: self.sum + next.sum,
            head: greatest(self.head, self.sum + next.head),
            tail: greatest(next.tail, next.sum + self.tail),
            any: greatest(greatest(self.any, next.any), self.tail + next.head),
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
    pub(super) parts: [Parts; NODES],
}

impl Run {
    /// Makes the run that is a single gap.
    pub(super) fn gap(height: f64, weights: [Weights; NODES]) -> Self {
        Self { height, parts: weights.map(|weights| Parts::of(weights.gap * height)) }
    }

    /// Adds a point, if the run continues with a point, and another run, which is taken at the given widths.
    pub(super) fn append(&mut self, point: Option<Parts>, next: &Self, widths: &[Width; NODES]) {
        self.height += next.height;
        if let Some(point) = point {
            self.parts.iter_mut().for_each(|parts| *parts = parts.followed_by(point));
        }
        for (parts, width) in self.parts.iter_mut().zip(widths) {
            *parts = parts.followed_by(next.at(*width));
        }
    }

    /// Returns the run at other widths, between the least and the greatest width.
    pub(super) fn at_all(&self, widths: &[Width; NODES]) -> Self {
        Self { height: self.height, parts: widths.map(|width| self.at(width)) }
    }

    fn at(&self, width: Width) -> Parts {
        let (from, to) = (&self.parts[width.node], &self.parts[width.node + 1]);
        let at = |from: f64, to: f64| from + (to - from) * width.share;
        Parts {
            sum: at(from.sum, to.sum),
            head: at(from.head, to.head),
            tail: at(from.tail, to.tail),
            any: at(from.any, to.any),
        }
    }
}

/// A width between the least and the greatest width of a run.
#[derive(Clone, Copy)]
pub(super) struct Width {
    /// The number of the next lower width at which the run knows its parts.
    node: usize,
    /// The share of the way from this width to the next higher one.
    share: f64,
}

impl Width {
    /// Makes the width at the given share of the way from the least to the greatest width.
    fn at(share: f64) -> Self {
        let steps = share * (NODES - 1) as f64;
        let node = (steps as usize).min(NODES - 2);
        Self { node, share: steps - node as f64 }
    }

    /// Makes the width `width` between the least and the greatest width of a run.
    pub(super) fn between([narrowest, widest]: [f64; 2], width: f64) -> Self {
        let share = if widest > narrowest { (width - narrowest) / (widest - narrowest) } else { 0.0 };
        Self::at(share.clamp(0.0, 1.0))
    }

    /// Returns the weights of the widths at which a run knows its parts, in the straight line to this width.
    pub(super) fn weights(self) -> [f64; NODES] {
        let mut weights = [0.0; NODES];
        weights[self.node] = 1.0 - self.share;
        weights[self.node + 1] = self.share;
        weights
    }
}
