//! What the car feels of its own motion.

use super::Descriptor;
use super::drift::Drift;
use super::error::{Checks, SensorError};
use super::{Chance, Inaccuracy, Sensor, SensorView};
use nalgebra::{Vector1, Vector2};

/// How lists show this kind of sensor.
pub(super) const DESCRIPTOR: Descriptor =
    Descriptor { name: "imu", about: "accelerations and the yaw rate of the car" };

/// An inertial measurement unit, not checked yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuSettings {
    /// Seconds between two readings.
    pub period: f64,
    /// How far off accelerations are, in m/s².
    pub acceleration: Inaccuracy,
    /// How far off yaw rates are, in rad/s.
    pub yaw_rate: Inaccuracy,
}

impl Default for ImuSettings {
    /// A hundred readings a second from a sensor as cars have them: off by 0.05 m/s² and 0.1 °/s from reading to reading, and
    /// as much in the long run.
    fn default() -> Self {
        Self {
            period: 0.01,
            acceleration: Inaccuracy { noise: 0.05, bias: 0.05, walk: 0.001 },
            yaw_rate: Inaccuracy { noise: 0.0017, bias: 0.0017, walk: 5e-5 },
        }
    }
}

/// What an inertial measurement unit measures at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inertia {
    /// The acceleration of the car's centre of gravity over the last tick in m/s², as seen from the car: x ahead, y to the
    /// left. Without gravity, for the world is flat.
    pub acceleration: Vector2<f64>,
    /// How fast it turns to the left, in rad/s.
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
    /// A unit with these settings.
    ///
    /// # Errors
    /// A setting is out of its range or no number.
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
