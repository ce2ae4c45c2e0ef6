//! Poses and directions in the ground plane.

use nalgebra::Vector2;
use std::f64::consts::{PI, TAU};

/// A position in the ground plane with a heading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// The position in metres, with x along the road and y to the left of the road.
    pub position: Vector2<f64>,
    /// The heading in radians, counter-clockwise from x.
    pub heading: f64,
}

impl Pose {
    /// Returns the unit vector in the direction of the heading.
    #[inline]
    pub fn forward(&self) -> Vector2<f64> {
        let (sin, cos) = libm::sincos(self.heading);
        Vector2::new(cos, sin)
    }

    /// Returns the unit vector to the left of the heading.
    #[inline]
    pub fn left(&self) -> Vector2<f64> {
        let forward = self.forward();
        Vector2::new(-forward.y, forward.x)
    }

    /// Returns a point of the plane as seen from this pose, in metres, with x ahead and y to the left.
    #[inline]
    pub fn to_local(&self, point: Vector2<f64>) -> Vector2<f64> {
        self.frame().to_local(point)
    }

    /// Returns the axes of the pose, to turn many points without computing the sine of the heading for each.
    #[inline]
    pub fn frame(&self) -> Frame {
        Frame { origin: self.position, ahead: self.forward() }
    }

    /// Converts a pose in the ground plane to the coordinates of this pose, with x ahead and y to the left.
    #[inline]
    pub fn relative(&self, pose: &Pose) -> Pose {
        Pose { position: self.to_local(pose.position), heading: wrapped(pose.heading - self.heading) }
    }

    /// Returns a direction of the plane as seen from this pose, as a vector with x ahead and y to the left.
    #[inline]
    pub fn turn_to_local(&self, direction: Vector2<f64>) -> Vector2<f64> {
        self.frame().turn_to_local(direction)
    }

    /// Returns a direction that is given as seen from this pose as a direction of the plane.
    #[inline]
    pub fn turn_to_plane(&self, local: Vector2<f64>) -> Vector2<f64> {
        let forward = self.forward();
        forward * local.x + Vector2::new(-forward.y, forward.x) * local.y
    }

    /// Returns `true` if position and heading are neither infinite nor NaN.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.position.iter().all(|metres| metres.is_finite()) && self.heading.is_finite()
    }

    /// Returns the pose in the plane of an object whose pose as seen from this pose is `local`.
    #[inline]
    pub fn then(&self, local: &Pose) -> Pose {
        let (sin, cos) = libm::sincos(self.heading);
        let (x, y) = (local.position.x, local.position.y);
        let position = self.position + Vector2::new(cos * x - sin * y, sin * x + cos * y);
        Pose { position, heading: wrapped(self.heading + local.heading) }
    }
}

/// The axes of a pose: its position, and the unit vector in the direction of its heading.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    origin: Vector2<f64>,
    ahead: Vector2<f64>,
}

impl Frame {
    /// Makes the axes of a pose from its position and the unit vector in the direction of its heading.
    #[inline]
    pub fn new(origin: Vector2<f64>, ahead: Vector2<f64>) -> Self {
        Self { origin, ahead }
    }

    /// Returns the unit vector in the direction of the heading.
    #[inline]
    pub fn ahead(self) -> Vector2<f64> {
        self.ahead
    }

    /// Returns a point of the plane as seen from the pose, like [`Pose::to_local`].
    #[inline]
    pub fn to_local(self, point: Vector2<f64>) -> Vector2<f64> {
        self.turn_to_local(point - self.origin)
    }

    /// Returns a direction of the plane as seen from the pose, like [`Pose::turn_to_local`].
    #[inline]
    pub fn turn_to_local(self, direction: Vector2<f64>) -> Vector2<f64> {
        Vector2::new(self.ahead.dot(&direction), self.ahead.perp(&direction))
    }
}

/// A side of a road, seen in the direction of the road.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The left side, where y is positive, beside the lanes of the opposite direction.
    Left,
    /// The right side, where y is negative, beside lane 1.
    Right,
}

/// Returns the angle in (-π, π] that points in the same direction.
#[inline]
pub fn wrapped(angle: f64) -> f64 {
    // Nearly all angles are in the range already; the formula below would return them unchanged.
    if -PI < angle && angle <= PI {
        return angle;
    }
    angle - (((angle + PI) / TAU).ceil() - 1.0) * TAU
}
