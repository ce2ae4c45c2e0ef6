//! The data that pass between a run and the system under test.

use crate::object::{Class, Outline};
use crate::road::{Path, RoadNetwork};
use crate::vehicle::Vehicle;
use nalgebra::Vector2;
use paracosm_road::Pose;
use std::sync::Arc;

/// The facts that a driver gets before a run begins.
#[derive(Debug, Clone)]
pub struct Briefing {
    /// The speed in m/s that the driver is to keep if nothing is in the way.
    pub cruise_speed: f64,
    /// The car that the driver drives.
    pub vehicle: Vehicle,
    /// The map of the roads and the way of the car; `None` for a driver in another process, which is not told them.
    pub navigation: Option<Navigation>,
}

/// The map of the roads with the way that a car is to go over them, cheap to clone.
#[derive(Debug, Clone)]
pub struct Navigation {
    /// The roads of the world.
    pub network: Arc<RoadNetwork>,
    /// The way of the car over the roads.
    pub way: Path,
    /// The place where the car's middle starts, in metres along the way.
    pub start: f64,
}

/// The true state of a body, as seen from the car. A driver may derive its own perception from the true state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Other {
    /// The number of the body, from 0 on, which is the same during the whole run.
    pub id: usize,
    /// The class of the body.
    pub class: Class,
    /// The position of the body's middle in metres, as seen from the car's middle (x ahead, y to the left).
    pub position: Vector2<f64>,
    /// The velocity of the body over the ground in m/s, along the axes of the car.
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
    /// The pose of the car relative to its start, as perfect odometry measures the pose.
    pub odometry: Pose,
    /// The way that the car is to go.
    pub way: Way,
    /// The other bodies in the world, in the order of their ids, without bodies on the [`Roadside`](crate::Roadside).
    pub others: Vec<Other>,
}

/// The way that a car is to go, as seen from the car's middle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Way {
    /// The lateral distance of the car from the way in metres, positive to the left of the way.
    pub offset: f64,
    /// The angle from the direction of the way to the car's heading in radians, positive to the left.
    pub heading: f64,
    /// The points of the way ahead of the car, every [`Way::SPACING`] metres, the nearest first.
    pub ahead: [Ahead; 16],
}

/// A point of the way ahead.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ahead {
    /// The position of the point in metres, as seen from the car's middle (x ahead, y to the left).
    pub position: Vector2<f64>,
    /// The curvature of the way at the point, in 1/m, positive to the left.
    pub curvature: f64,
}

impl Way {
    /// The distance in metres along the way from one point ahead to the next.
    pub const SPACING: f64 = 2.5;

    /// Returns the point whose distance ahead along the way is nearest to the given number of metres.
    pub fn at(&self, metres: f64) -> &Ahead {
        let index = (metres / Self::SPACING).round() as usize;
        &self.ahead[index.clamp(1, self.ahead.len()) - 1]
    }
}

/// The throttle and the steering that a driver sets until the next question to the driver.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Control {
    /// The throttle, from -1 (full brakes) to 1 (full power).
    pub throttle: f64,
    /// The steering, from -1 (wheels fully to the right) to 1 (wheels fully to the left).
    pub steering: f64,
}
