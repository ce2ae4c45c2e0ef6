//! An inertial measurement unit, which measures the car's own motion.

use super::Descriptor;
use super::drift::Drift;
use super::error::{Checks, SensorError};
use super::{Chance, Inaccuracy, Sensor, SensorView};
use nalgebra::{Vector1, Vector2};

/// The description of inertial measurement units in lists of sensors.
pub(super) const DESCRIPTOR: Descriptor =
    Descriptor { name: "imu", about: "accelerations and the yaw rate of the car" };

/// The settings of an inertial measurement unit, not checked yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuSettings {
    /// The seconds between two readings.
    pub period: f64,
    /// The inaccuracy of measured accelerations, in m/s².
    pub acceleration: Inaccuracy,
    /// The inaccuracy of measured yaw rates, in rad/s.
    pub yaw_rate: Inaccuracy,
}

impl Default for ImuSettings {
    /// Returns the settings of a usual automotive sensor. It gives a hundred readings a second, with errors of 0.05
    /// m/s² and 0.1 °/s from reading to reading, and equal errors in the long run.
    fn default() -> Self {
        Self {
            period: 0.01,
            acceleration: Inaccuracy { noise: 0.05, bias: 0.05, walk: 0.001 },
            yaw_rate: Inaccuracy { noise: 0.0017, bias: 0.0017, walk: 5e-5 },
        }
    }
}

/// The reading of an inertial measurement unit at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inertia {
    /// The acceleration of the car's centre of gravity over the last tick in m/s² (x ahead, y to the left). It does not
    /// include gravity, because the world is flat.
    pub acceleration: Vector2<f64>,
    /// The yaw rate of the car, to the left, in rad/s.
    pub yaw_rate: f64,
}

/// An inertial measurement unit at the car's centre of gravity.
#[derive(Debug, Clone)]
pub struct Imu {
    period: f64,
    acceleration: Drift<2>,
    yaw_rate: Drift<1>,
}

impl Imu {
    /// Makes an inertial measurement unit with the given settings.
    ///
    /// # Errors
    /// A setting is out of its range or is not a number.
    pub fn new(settings: ImuSettings) -> Result<Self, SensorError> {
        let ImuSettings { period, acceleration, yaw_rate } = settings;
        let checks = Checks("imu");
        checks.period(period)?;
        acceleration.check(&checks, "acceleration", "m/s^2")?;
        yaw_rate.check(&checks, "yaw_rate", "rad/s")?;
        Ok(Self { period, acceleration: Drift::new(acceleration), yaw_rate: Drift::new(yaw_rate) })
    }
}

impl Sensor for Imu {
    type Reading = Inertia;

    fn period(&self) -> f64 {
        self.period
    }

    fn reset(&mut self) {
        self.acceleration.reset();
        self.yaw_rate.reset();
    }

    fn sense(&mut self, view: &SensorView<'_>, chance: &mut Chance, reading: &mut Inertia) {
        reading.acceleration = self.acceleration.measured(view.car.acceleration, view.time, chance);
        reading.yaw_rate = self.yaw_rate.measured(Vector1::new(view.car.yaw_rate), view.time, chance).x;
    }
}
