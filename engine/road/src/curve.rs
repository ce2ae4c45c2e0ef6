//! Lines and circular arcs in the ground plane, parametrised by arc length. All road geometry consists of them.

use super::bounds::Bounds;
use crate::geometry::{Frame, Pose, wrapped};
use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A straight line or a circular arc, with a length and a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    start: Pose,
    /// The unit vector of the start's heading.
    forward: Vector2<f64>,
    curvature: f64,
    length: f64,
}

/// Returns a vector turned to the left by 90 degrees.
fn left_of(vector: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-vector.y, vector.x)
}

impl Curve {
    /// Makes a curve of `length` metres from a pose `start`. `curvature` in 1/m is positive to the left, 0 for a line.
    #[inline]
    pub fn new(start: Pose, curvature: f64, length: f64) -> Self {
        Self { start, forward: start.forward(), curvature, length }
    }

    /// Returns the length of the curve in metres.
    #[inline]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the curvature of the curve in 1/m; positive for a bend to the left, 0 for a straight line.
    #[inline]
    pub fn curvature(&self) -> f64 {
        self.curvature
    }

    /// Returns the point `s` metres along the curve. Before its start and beyond its end the line or circle continues.
    #[inline]
    pub fn point(&self, s: f64) -> Vector2<f64> {
        self.beside(s, 0.0)
    }

    /// Returns the point `offset` metres to the left of the point `s` metres along the curve.
    #[inline]
    pub fn beside(&self, s: f64, offset: f64) -> Vector2<f64> {
        let left = left_of(self.forward);
        if self.curvature == 0.0 {
            return self.start.position + self.forward * s + left * offset;
        }
        let (sin, cos) = libm::sincos(self.curvature * s);
        // 1 - cos, in a form that keeps its digits on an arc that is nearly straight.
        let half = libm::sin(0.5 * self.curvature * s);
        let ahead = sin / self.curvature - offset * sin;
        let aside = 2.0 * half * half / self.curvature + offset * cos;
        self.start.position + self.forward * ahead + left * aside
    }

    /// Returns the heading of the curve in radians, `s` metres along the curve, in (-π, π].
    #[inline]
    pub fn heading(&self, s: f64) -> f64 {
        wrapped(self.start.heading + self.curvature * s)
    }

    /// Returns the unit vector in the direction of the curve, `s` metres along the curve. It is the direction of
    /// [`Curve::at`], to the last bit; on a straight line it takes no sine.
    #[inline]
    pub(super) fn forward(&self, s: f64) -> Vector2<f64> {
        let heading = self.heading(s);
        let is_start = heading.to_bits() == self.start.heading.to_bits();
        if is_start { self.forward } else { Pose { heading, ..self.start }.forward() }
    }

    /// Returns the axes of [`Curve::at`], to the last bit; on a straight line it takes no sine.
    #[inline]
    pub fn frame(&self, s: f64) -> Frame {
        Frame::new(self.point(s), self.forward(s))
    }

    /// Returns the position and the heading of the curve, `s` metres along the curve.
    #[inline]
    pub fn at(&self, s: f64) -> Pose {
        Pose { position: self.point(s), heading: self.heading(s) }
    }

    /// Returns the position and the heading at the start of the curve.
    #[inline]
    pub fn start(&self) -> Pose {
        self.at(0.0)
    }

    /// Returns the position and the heading at the end of the curve.
    #[inline]
    pub fn end(&self) -> Pose {
        self.at(self.length)
    }

    /// Returns the distance in metres along the curve to the curve's point that is nearest to `point`.
    pub fn nearest(&self, point: Vector2<f64>) -> f64 {
        let from_start = point - self.start.position;
        if self.curvature == 0.0 {
            return from_start.dot(&self.forward).clamp(0.0, self.length);
        }
        let centre = self.centre();
        let (spoke, to_point) = (self.start.position - centre, point - centre);
        let turn = libm::atan2(spoke.perp(&to_point), spoke.dot(&to_point)) * self.curvature.signum();
        let s = turn.rem_euclid(TAU) / self.curvature.abs();
        if s <= self.length {
            s
        } else if from_start.norm_squared() <= (point - self.point(self.length)).norm_squared() {
            0.0
        } else {
            self.length
        }
    }

    /// Returns `true` only if all points of the curve are more than `metres` metres away from a point. The test needs no
    /// square root and no sine: no point of the curve is farther from the start than the length.
    #[inline]
    pub fn is_beyond(&self, point: Vector2<f64>, metres: f64) -> bool {
        // The margin is far above all rounding.
        let reach = self.length + metres + 1e-6;
        (point - self.start.position).norm_squared() > reach * reach
    }

    /// Returns the centre of the circle of an arc.
    fn centre(&self) -> Vector2<f64> {
        self.start.position + left_of(self.forward) / self.curvature
    }

    /// Returns the curve `left` metres to the left of this one. Inside of an arc, `left` is less than its radius.
    pub(super) fn offset(&self, left: f64) -> Self {
        let stretch = 1.0 - self.curvature * left;
        let start = Pose { position: self.beside(0.0, left), heading: self.start.heading };
        Self { start, forward: self.forward, curvature: self.curvature / stretch, length: self.length * stretch }
    }

    /// Returns the curve in the opposite direction, from the end to the start.
    pub(super) fn reversed(&self) -> Self {
        let end = self.end();
        let start = Pose { position: end.position, heading: wrapped(end.heading + PI) };
        Self::new(start, -self.curvature, self.length)
    }

    /// Returns the piece of the curve between two distances along it.
    #[inline]
    pub(super) fn piece(&self, from: f64, to: f64) -> Self {
        Self::new(self.at(from), self.curvature, to - from)
    }

    /// Returns the curve in the plane, if `frame` is the pose of the element that the curve belongs to.
    pub(super) fn moved(&self, frame: &Pose) -> Self {
        Self::new(frame.then(&self.start), self.curvature, self.length)
    }

    /// Returns the smallest box with sides along the axes that contains the curve.
    pub fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::around([self.start.position, self.point(self.length)]);
        if self.curvature != 0.0 {
            let (centre, radius) = (self.centre(), 1.0 / self.curvature.abs());
            let side = self.curvature.signum();
            for (quarter, direction) in
                [(0.0, Vector2::x()), (1.0, Vector2::y()), (2.0, -Vector2::x()), (3.0, -Vector2::y())]
            {
                // The point where the full circle is farthest in this direction of an axis.
                let turn = (quarter * FRAC_PI_2 - (self.start.heading - side * FRAC_PI_2)) * side;
                if turn.rem_euclid(TAU) * radius <= self.length {
                    bounds.include(centre + direction * radius);
                }
            }
        }
        bounds
    }

    /// Returns the smallest number of equal pieces that are straight to `tolerance` metres, `offset` to the left.
    pub(super) fn pieces(&self, offset: f64, tolerance: f64) -> usize {
        let radius = (1.0 / self.curvature - offset).abs();
        if self.curvature == 0.0 || radius <= tolerance {
            return 1;
        }
        let most = 2.0 * libm::acos(1.0 - tolerance / radius);
        ((self.curvature.abs() * self.length / most).ceil() as usize).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_curve_beyond_a_distance_has_no_point_within_it(
            at in prop::array::uniform2(-60.0..60.0), heading in -3.1..3.1, curvature in prop_oneof![Just(0.0), -0.2..0.2],
            length in 1.0..80.0, metres in 0.0..10.0
        ) {
            let curve = Curve::new(Pose { position: Vector2::zeros(), heading }, curvature, length);
            let point = Vector2::from(at);
            let nearest = (0..=400).map(|i| (curve.point(length * f64::from(i) / 400.0) - point).norm());
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            prop_assert!(!curve.is_beyond(point, metres) || nearest > metres, "{nearest} m");
        }
    }
}
