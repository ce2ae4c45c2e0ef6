//! What passes between a run and the system under test.

use crate::geometry::Pose;
use crate::object::{Class, Outline};
use crate::vehicle::Vehicle;
use nalgebra::Vector2;

/// What a driver is told before a run begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Briefing {
    /// The speed in m/s that it is to keep where nothing is in the way.
    pub cruise_speed: f64,
    /// The car that it drives.
    pub vehicle: Vehicle,
}

/// Another body, as it truly is; what a driver makes of it is the driver's own perception.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Other {
    /// Which of the bodies it is, from 0 on: by this it is known again.
    pub id: usize,
    /// What it is taken for.
    pub class: Class,
    /// Its middle as seen from the car's middle, in metres: x ahead, y to the left.
    pub position: Vector2<f64>,
    /// Its velocity over the ground in the same directions, in m/s.
    pub velocity: Vector2<f64>,
    /// Where it points, in radians counter-clockwise from the car's heading.
    pub heading: f64,
    /// What it covers of the ground.
    pub outline: Outline,
}

impl Other {
    /// The halves, in metres, of the box along the car's axes that encloses it.
    pub fn half_extent(&self) -> Vector2<f64> {
        self.outline.enclosing(self.heading)
    }
}

/// What there is to see at one moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Observation {
    /// Seconds since the run began.
    pub time: f64,
    /// The car's speed in m/s.
    pub speed: f64,
    /// The way the car has covered, in metres.
    pub travelled: f64,
    /// Where the car is as seen from where it began: what perfect odometry tells.
    pub odometry: Pose,
    /// The way that it is to go.
    pub way: Way,
    /// The other bodies in the order of their ids: those that are in the world, without what stands on the
    /// [`Roadside`](crate::Roadside).
    pub others: Vec<Other>,
}

/// The way that a car is to go, as seen from the car's middle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Way {
    /// How far the car is to the left of it, in metres.
    pub offset: f64,
    /// By how much the car points to the left of it, in radians.
    pub heading: f64,
    /// What lies ahead on it, every [`Way::SPACING`] metres, the nearest first.
    pub ahead: [Ahead; 16],
}

/// A point of the way ahead.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ahead {
    /// Where it is as seen from the car's middle, in metres: x ahead, y to the left.
    pub position: Vector2<f64>,
    /// How the way bends there, in 1/m, positive to the left.
    pub curvature: f64,
}

impl Way {
    /// Metres along the way from one point ahead to the next.
    pub const SPACING: f64 = 2.5;

    /// The point of the way that is nearest to this many metres ahead along it.
    pub fn at(&self, metres: f64) -> &Ahead {
        let index = (metres / Self::SPACING).round() as usize;
        &self.ahead[index.clamp(1, self.ahead.len()) - 1]
    }
}

/// What a driver does until it is asked again.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Control {
    /// From -1, full brakes, to 1, full power.
    pub throttle: f64,
    /// From -1, the wheels turned to the right as far as they go, to 1, to the left.
    pub steering: f64,
}
