//! The driver `cruise`: it keeps its speed and its way, and never brakes for others. It shows what happens to a driver
//! that does nothing. Every other driver uses it to hold its speed and its way.

use super::{Descriptor, Driver, Fault, Settings};
use crate::observation::{Briefing, Control, Observation, Way};
use nalgebra::Vector2;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "cruise",
    about: "keeps its speed and its way, and never brakes for others",
    settings: &[],
    make: |_: &Settings| Box::new(Cruise::default()),
};

/// The strongest acceleration and deceleration in m/s² of a comfortable speed control (ISO 15622 lets an adaptive
/// cruise control accelerate by up to 2.0 m/s² at high speed).
const COMFORT: f64 = 2.0;
/// The strongest lateral acceleration in m/s² in bends.
const SIDEWAYS: f64 = 2.0;
/// The seconds between two questions to the driver. 20 Hz is a usual rate of driver assistance.
pub(super) const PERIOD: f64 = 0.05;
/// The acceleration per m/s of missing speed, in 1/s.
const GAIN: f64 = 1.0;
/// The look-ahead of the steering: seconds at the car's speed, and the least and the greatest distance in metres.
const LOOK_AHEAD: (f64, f64, f64) = (0.6, 5.0, 20.0);
/// The share of the wheels' full turn below which the wheels stay straight.
const STEADY: f64 = 1e-9;

/// A controller that keeps the car at its set speed and on its way.
#[derive(Debug, Default)]
pub(super) struct Cruise {
    set_speed: f64,
    max_acceleration: f64,
    wheelbase: f64,
    max_steering_angle: f64,
    /// The distance from the middle of the car back to its rear axle, in metres.
    rear_axle: f64,
}

impl Cruise {
    /// Returns the acceleration in m/s² that brings the car to its set speed and slows the car for bends.
    pub fn acceleration(&self, observation: &Observation) -> f64 {
        let speed = observation.speed;
        let keep = self.keeping(speed);
        let bends = observation.way.ahead.iter().enumerate().filter(|(_, point)| point.curvature != 0.0);
        let slower = bends.map(|(i, point)| {
            let allowed = (SIDEWAYS / point.curvature.abs()).sqrt();
            // At the bend the car holds the bend's speed; before the bend it brakes towards that speed.
            let hold = GAIN * (allowed - speed);
            let way = Way::SPACING * i as f64;
            if way > 0.0 { ((allowed * allowed - speed * speed) / (2.0 * way)).max(hold) } else { hold }
        });
        slower.fold(keep, f64::min).max(-2.0 * COMFORT)
    }

    /// Returns the acceleration in m/s² that brings the car from a speed in m/s to its set speed.
    pub fn keeping(&self, speed: f64) -> f64 {
        (GAIN * (self.set_speed - speed)).clamp(-COMFORT, COMFORT)
    }

    /// Returns the throttle, from -1 to 1, that asks the car for an acceleration in m/s².
    pub fn throttle(&self, acceleration: f64) -> f64 {
        (acceleration / self.max_acceleration).clamp(-1.0, 1.0)
    }

    /// Returns the control for an acceleration in m/s² that also steers the car along its way.
    pub fn control(&self, acceleration: f64, observation: &Observation) -> Control {
        let way = observation.way.at(Self::looks_ahead(observation.speed));
        Control { throttle: self.throttle(acceleration), steering: self.steering(way.position) }
    }

    /// Returns the look-ahead of the steering in metres, at a speed in m/s.
    pub fn looks_ahead(speed: f64) -> f64 {
        let (seconds, least, most) = LOOK_AHEAD;
        (seconds * speed).clamp(least, most)
    }

    /// Returns the steering by pure pursuit (Coulter 1992), for the arc on which the rear axle reaches a point ahead.
    /// The point is as seen from the car's middle.
    pub fn steering(&self, target: Vector2<f64>) -> f64 {
        let (x, y) = (target.x + self.rear_axle, target.y);
        let angle = libm::atan2(2.0 * self.wheelbase * y, x * x + y * y);
        let steering = (angle / self.max_steering_angle).clamp(-1.0, 1.0);
        if steering.abs() < STEADY { 0.0 } else { steering }
    }
}

impl Driver for Cruise {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        let vehicle = &briefing.vehicle;
        *self = Self {
            set_speed: briefing.cruise_speed,
            max_acceleration: vehicle.max_acceleration,
            wheelbase: vehicle.wheelbase,
            max_steering_angle: vehicle.max_steering_angle,
            rear_axle: 0.5 * vehicle.wheelbase,
        };
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        Ok(self.control(self.acceleration(observation), observation))
    }
}
