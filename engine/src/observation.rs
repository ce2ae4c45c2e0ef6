//! The data that pass between a run and the system under test.

use crate::geometry::Pose;
use crate::object::{Class, Outline};
use crate::vehicle::Vehicle;
use nalgebra::Vector2;

/// The facts that a driver is told before a run begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Briefing {
    /// The speed in m/s that the driver is to keep if nothing is in the way.
    pub cruise_speed: f64,
    /// The car that the driver drives.
    pub vehicle: Vehicle,
}

/// Another body, as it truly is. A driver may make its own perception of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Other {
    /// The number of the body, from 0 on, which is the same during the whole run.
    pub id: usize,
    /// The class of the body.
    pub class: Class,
    /// The position of the body's middle as seen from the car's middle, in metres: x ahead, y to the left.
    pub position: Vector2<f64>,
    /// The body's velocity over the ground in the same directions, in m/s.
    pub velocity: Vector2<f64>,
    /// The direction in which the body points, in radians counter-clockwise from the car's heading.
    pub heading: f64,
    /// The outline of the body on the ground.
    pub outline: Outline,
}

impl Other {
    /// Returns half the extent, in metres, of the box along the car's axes that encloses the body.
    pub fn half_extent(&self) -> Vector2<f64> {
        self.outline.enclosing(self.heading)
    }
}

/// The observation of a driver at one moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Observation {
    /// The seconds since the run began.
    pub time: f64,
    /// The car's speed in m/s.
    pub speed: f64,
    /// The distance that the car has covered, in metres.
    pub travelled: f64,
    /// The pose of the car as seen from its start, as perfect odometry would tell it.
    pub odometry: Pose,
    /// The way that the car is to go.
    pub way: Way,
    /// The other bodies in the world, in the order of their ids, without bodies on the [`Roadside`](crate::Roadside).
    pub others: Vec<Other>,
}

/// The way that a car is to go, as seen from the car's middle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Way {
    /// The distance of the car to the left of the way, in metres.
    pub offset: f64,
    /// The angle by which the car points to the left of the way, in radians.
    pub heading: f64,
    /// Points of the way ahead, every [`Way::SPACING`] metres, the nearest first.
    pub ahead: [Ahead; 16],
}

/// A point of the way ahead.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ahead {
    /// The position of the point as seen from the car's middle, in metres: x ahead, y to the left.
    pub position: Vector2<f64>,
    /// The curvature of the way at the point, in 1/m, positive to the left.
    pub curvature: f64,
}

impl Way {
    /// The distance in metres along the way from one point ahead to the next.
    pub const SPACING: f64 = 2.5;

    /// Returns the point of the way that is nearest to this many metres ahead along the way.
    pub fn at(&self, metres: f64) -> &Ahead {
        let index = (metres / Self::SPACING).round() as usize;
        &self.ahead[index.clamp(1, self.ahead.len()) - 1]
    }
}

/// The control that a driver gives until it is asked again.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Control {
    /// The throttle, from -1 (full brakes) to 1 (full power).
    pub throttle: f64,
    /// The steering, from -1 (wheels fully to the right) to 1 (wheels fully to the left).
    pub steering: f64,
}
