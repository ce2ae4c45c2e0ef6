//! The driver `cruise`: keeps its speed and never brakes for anything. What it hits, any driver that did nothing
//! would hit; and holding the speed is a part of every other driver.

use super::{Driver, Kind, Settings};
use crate::observation::{Briefing, Control, Observation};

pub(super) const KIND: Kind = Kind {
    name: "cruise",
    about: "keeps its speed and never brakes",
    settings: &[],
    make: |_: &Settings| Box::new(Cruise::default()),
};

/// Strongest acceleration and deceleration in m/s² of a comfortable speed control (ISO 15622 lets an adaptive
/// cruise control accelerate by up to 2.0 m/s² at high speed).
const COMFORT: f64 = 2.0;
/// Seconds between two questions: 20 Hz, a usual rate of driver assistance.
pub(super) const PERIOD: f64 = 0.05;
/// Acceleration per m/s of missing speed, in 1/s.
const GAIN: f64 = 1.0;

/// A speed controller.
#[derive(Debug, Default)]
pub(super) struct Cruise {
    set_speed: f64,
    max_acceleration: f64,
}

impl Cruise {
    /// The acceleration in m/s² that brings the car to its set speed.
    pub fn acceleration(&self, speed: f64) -> f64 {
        (GAIN * (self.set_speed - speed)).clamp(-COMFORT, COMFORT)
    }

    /// The control that asks the car for an acceleration in m/s².
    pub fn control(&self, acceleration: f64) -> Control {
        Control { throttle: (acceleration / self.max_acceleration).clamp(-1.0, 1.0) }
    }
}

impl Driver for Cruise {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn reset(&mut self, briefing: &Briefing) {
        *self = Self { set_speed: briefing.cruise_speed, max_acceleration: briefing.vehicle.max_acceleration };
    }

    fn step(&mut self, observation: &Observation) -> Control {
        self.control(self.acceleration(observation.speed))
    }
}
