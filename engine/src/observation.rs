//! What passes between a run and the system under test.

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
    /// Its middle as seen from the car's middle, in metres: x ahead, y to the left.
    pub position: Vector2<f64>,
    /// Its velocity over the ground in the same directions, in m/s.
    pub velocity: Vector2<f64>,
    /// Where it points, in radians counter-clockwise from the car's heading.
    pub heading: f64,
    /// Its extent along its heading, in metres.
    pub length: f64,
    /// Its extent across its heading, in metres.
    pub width: f64,
    /// Half of its extent as seen from above, in metres.
    pub radius: f64,
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
    /// The other bodies, always in the same order.
    pub others: Vec<Other>,
}

/// What a driver does until it is asked again.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Control {
    /// From -1, full brakes, to 1, full power.
    pub throttle: f64,
}
