//! The car under test, as programs place it and read it.

use super::{Line, Place, Pose, Scenario};
use crate::stream::{Source, Stream};
use crate::vehicle::Vehicle;
use nalgebra::Vector2;

/// The car that the system under test drives, not placed yet: a [`Vehicle::BMW_320I`].
#[derive(Debug, Clone, Copy)]
pub struct AutonomousVehicle {
    setup: CarSetup,
}

/// What a run needs of the placed car.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CarSetup {
    pub vehicle: Vehicle,
    pub start: Pose,
    pub speed: f64,
}

/// The placed car: its outputs.
#[derive(Debug, Clone)]
pub struct Car {
    vehicle: Vehicle,
}

impl AutonomousVehicle {
    /// A car that stands at `start`, which is where its middle is.
    pub fn at(start: Pose) -> Self {
        Self { setup: CarSetup { vehicle: Vehicle::BMW_320I, start, speed: 0.0 } }
    }

    /// The speed in m/s at which it starts, and which its driver is told to keep.
    pub fn speed(mut self, speed: f64) -> Self {
        self.setup.speed = speed;
        self
    }
}

impl Place for AutonomousVehicle {
    type Handle = Car;

    fn place(self, scenario: &mut Scenario) -> Car {
        let speed = self.setup.speed;
        let most = self.setup.vehicle.max_speed;
        if !(0.0..=most).contains(&speed) {
            scenario.problem(format!("the car's speed is {speed} m/s, expected 0 to {most}"));
        }
        scenario.cars.push(self.setup);
        Car { vehicle: self.setup.vehicle }
    }
}

impl Car {
    /// Where its middle is.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        Stream::output(Source::CarPosition, "car.position".into())
    }

    /// Its speed in m/s.
    pub fn speed(&self) -> Stream<f64> {
        Stream::output(Source::CarSpeed, "car.speed".into())
    }

    /// The length of the way it has come, in metres.
    pub fn travelled(&self) -> Stream<f64> {
        Stream::output(Source::CarTravelled, "car.travelled".into())
    }

    /// Metres of free space to the nearest other body. Once it touches one: minus the braking distance that
    /// was missing, max(v²/(2 μ g), 0.001) with v the speed of one body relative to the other.
    pub fn clearance(&self) -> Stream<f64> {
        Stream::output(Source::CarClearance, "car.clearance".into())
    }

    /// Whether it touches another body.
    pub fn collides(&self) -> Stream<bool> {
        self.clearance().at_most(0.0)
    }

    /// How far the line is ahead of its front bumper, in metres.
    pub fn gap_along(&self, line: &Line) -> Stream<f64> {
        self.position().distance_to(line) - 0.5 * self.vehicle.length
    }
}
