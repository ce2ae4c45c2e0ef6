//! The middle line of a lane: one curve, or a chain of curves.
//!
//! The lanes of our own elements are single lines and arcs. Lanes of files follow spirals and polynomials, which chains of arcs
//! approximate.

use super::bounds::Bounds;
use super::curve::Curve;
use crate::geometry::{Frame, Pose};
use nalgebra::Vector2;
use std::sync::Arc;

/// The middle line of a lane, parametrised by arc length. It is cheap to clone.
#[derive(Debug, Clone, PartialEq)]
pub struct Centreline {
    /// The only curve, or the first one.
    first: Curve,
    length: f64,
    /// All curves of a chain, each with the place where it begins, in metres along the line; `None` for a single curve.
    chain: Option<Chain>,
}

/// Curves one after the other, each with the place where it begins, in metres from the start of the first.
pub(super) type Chain = Arc<[(f64, Curve)]>;

/// Returns curves with the places where they begin, and the sum of their lengths in metres.
pub(super) fn chained(curves: impl IntoIterator<Item = Curve>) -> (Chain, f64) {
    let mut length = 0.0;
    let begun = |curve: Curve| {
        let from = length;
        length += curve.length();
        (from, curve)
    };
    let chain = curves.into_iter().map(begun).collect();
    (chain, length)
}

impl From<Curve> for Centreline {
    fn from(curve: Curve) -> Self {
        Self { first: curve, length: curve.length(), chain: None }
    }
}

impl Centreline {
    /// Makes the line along the given curves. Each curve has to begin where the previous curve ends.
    ///
    /// # Panics
    /// There are no curves.
    pub fn new(curves: impl IntoIterator<Item = Curve>) -> Self {
        let (chain, length) = chained(curves);
        match &*chain {
            [] => panic!("a line has at least one curve"),
            [(_, curve)] => Self::from(*curve),
            [(_, first), ..] => Self { first: *first, length, chain: Some(chain) },
        }
    }

    /// Returns the curves of the line in their order.
    pub fn curves(&self) -> impl Iterator<Item = &Curve> {
        let chain = self.chain.iter().flat_map(|chain| chain.iter().map(|(_, curve)| curve));
        self.chain.is_none().then_some(&self.first).into_iter().chain(chain)
    }

    /// Returns the length of the line in metres.
    #[inline]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the curve at a place, and the place along that curve.
    #[inline]
    fn curve_at(&self, s: f64) -> (&Curve, f64) {
        match &self.chain {
            None => (&self.first, s),
            Some(chain) => {
                let (from, curve) = &chain[chain.partition_point(|(from, _)| *from <= s).max(1) - 1];
                (curve, s - from)
            }
        }
    }

    /// Returns the greatest curvature of the line in 1/m, whichever way the line bends.
    pub fn greatest_curvature(&self) -> f64 {
        self.curves().map(|curve| curve.curvature().abs()).fold(0.0, f64::max)
    }

    /// Returns the point `s` metres along the line. Before its start and beyond its end the first and the last curve
    /// continue.
    #[inline]
    pub fn point(&self, s: f64) -> Vector2<f64> {
        let (curve, s) = self.curve_at(s);
        curve.point(s)
    }

    /// Returns the point `offset` metres to the left of the point `s` metres along the line.
    #[inline]
    pub fn beside(&self, s: f64, offset: f64) -> Vector2<f64> {
        let (curve, s) = self.curve_at(s);
        curve.beside(s, offset)
    }

    /// Returns the heading of the line in radians, `s` metres along the line, in (-π, π].
    #[inline]
    pub fn heading(&self, s: f64) -> f64 {
        let (curve, s) = self.curve_at(s);
        curve.heading(s)
    }

    /// Returns the unit vector in the direction of the line, `s` metres along the line.
    #[inline]
    pub(super) fn forward(&self, s: f64) -> Vector2<f64> {
        let (curve, s) = self.curve_at(s);
        curve.forward(s)
    }

    /// Returns the axes of [`Centreline::at`], to the last bit; on a straight line it takes no sine.
    #[inline]
    pub fn frame(&self, s: f64) -> Frame {
        let (curve, s) = self.curve_at(s);
        curve.frame(s)
    }

    /// Returns the position and the heading of the line, `s` metres along the line.
    #[inline]
    pub fn at(&self, s: f64) -> Pose {
        let (curve, s) = self.curve_at(s);
        curve.at(s)
    }

    /// Returns the position and the heading at the start of the line.
    #[inline]
    pub fn start(&self) -> Pose {
        self.first.start()
    }

    /// Returns the position and the heading at the end of the line.
    #[inline]
    pub fn end(&self) -> Pose {
        self.last().end()
    }

    fn last(&self) -> &Curve {
        self.chain.as_ref().and_then(|chain| chain.last()).map_or(&self.first, |(_, curve)| curve)
    }

    /// Returns the distance in metres along the line to the line's point that is nearest to `point`.
    #[inline]
    pub fn nearest(&self, point: Vector2<f64>) -> f64 {
        let Some(chain) = &self.chain else { return self.first.nearest(point) };
        let mut best = (f64::INFINITY, 0.0);
        for (from, curve) in chain.iter() {
            if curve.is_beyond(point, best.0) {
                continue;
            }
            let s = curve.nearest(point);
            let distance = (curve.point(s) - point).norm();
            if distance < best.0 {
                best = (distance, from + s);
            }
        }
        best.1
    }

    /// Returns `true` only if all points of the line are more than `metres` metres away from a point. The test needs no
    /// square root and no sine.
    #[inline]
    pub fn is_beyond(&self, point: Vector2<f64>, metres: f64) -> bool {
        match &self.chain {
            None => self.first.is_beyond(point, metres),
            Some(chain) => chain.iter().all(|(_, curve)| curve.is_beyond(point, metres)),
        }
    }

    /// Returns the curves of the line between two distances along it; at least one curve, which may be a point.
    pub fn pieces(&self, from: f64, to: f64) -> Vec<Curve> {
        let Some(chain) = &self.chain else { return vec![self.first.piece(from, to)] };
        let piece = |(begin, curve): &(f64, Curve)| {
            let [from, to] = [from - begin, to - begin].map(|s| s.clamp(0.0, curve.length()));
            (to > from).then(|| curve.piece(from, to))
        };
        let mut pieces: Vec<_> = chain.iter().filter_map(piece).collect();
        if pieces.is_empty() {
            let (curve, s) = self.curve_at(from);
            pieces.push(curve.piece(s, s));
        }
        pieces
    }

    /// Returns the smallest box with sides along the axes that contains the line.
    pub fn bounds(&self) -> Bounds {
        self.curves().map(Curve::bounds).fold(Bounds::empty(), |all, next| all.union(&next))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn chain(curvatures: &[f64], length: f64) -> Centreline {
        let mut start = Pose { position: Vector2::new(1.0, 2.0), heading: 0.4 };
        Centreline::new(curvatures.iter().map(|curvature| {
            let curve = Curve::new(start, *curvature, length);
            start = curve.end();
            curve
        }))
    }

    proptest! {
        #[test]
        fn the_nearest_place_of_a_chain_is_that_of_a_search_along_it(
            curvatures in prop::collection::vec(-0.05..0.05, 1..6), length in 2.0..20.0,
            at in prop::array::uniform2(-40.0..80.0)
        ) {
            let line = chain(&curvatures, length);
            let point = Vector2::from(at);
            let found = (line.point(line.nearest(point)) - point).norm();
            let places = (0..=2000).map(|i| line.length() * f64::from(i) / 2000.0);
            let searched = places.map(|s| (line.point(s) - point).norm()).fold(f64::INFINITY, f64::min);
            prop_assert!(found <= searched + 1e-9 && found >= searched - line.length() / 2000.0, "{found} {searched}");
        }

        #[test]
        fn the_pieces_of_a_chain_are_the_chain(
            curvatures in prop::collection::vec(-0.05..0.05, 1..6), length in 2.0..20.0, cuts in prop::array::uniform2(0.0..1.0)
        ) {
            let line = chain(&curvatures, length);
            let [a, b] = cuts.map(|share: f64| share * line.length());
            let (from, to) = (a.min(b), a.max(b));
            prop_assume!(to - from > 1e-6);
            let piece = Centreline::new(line.pieces(from, to));
            prop_assert!((piece.length() - (to - from)).abs() < 1e-9);
            for share in [0.0, 0.3, 0.7, 1.0] {
                let s = share * piece.length();
                prop_assert!((piece.point(s) - line.point(from + s)).norm() < 1e-9);
            }
        }

        #[test]
        fn a_chain_continues_where_its_curves_meet(
            curvatures in prop::collection::vec(-0.05..0.05, 2..6), length in 2.0..20.0
        ) {
            let line = chain(&curvatures, length);
            for i in 1..curvatures.len() {
                let s = length * i as f64;
                prop_assert!((line.point(s - 1e-9) - line.point(s + 1e-9)).norm() < 1e-8);
            }
            prop_assert!((line.end().position - line.point(line.length())).norm() < 1e-9);
        }
    }
}
