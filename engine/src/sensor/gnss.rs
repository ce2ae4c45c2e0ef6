//! A satellite receiver, which measures the car's position and velocity.

use super::Descriptor;
use super::drift::Drift;
use super::error::{Checks, SensorError};
use super::{Chance, Inaccuracy, Mount, Sensor, SensorView};
use nalgebra::Vector2;

/// The description of satellite receivers in lists of sensors.
pub(super) const DESCRIPTOR: Descriptor =
    Descriptor { name: "gnss", about: "the position and velocity that a satellite receiver gives" };

/// The settings of a satellite receiver, not checked yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GnssSettings {
    /// The mounting of the antenna.
    pub mount: Mount,
    /// The seconds between two fixes.
    pub period: f64,
    /// The inaccuracy of positions in metres, by the noise of a fix and the slow errors of orbits and ionosphere.
    pub position: Inaccuracy,
    /// The standard deviation of the noise of each coordinate of the velocity, in m/s. The velocity is measured by the
    /// Doppler effect and has no bias.
    pub velocity_noise: f64,
    /// The rate of outages in 1/s; 0 for no outages.
    pub outages: f64,
    /// The mean duration of an outage in seconds. Durations are distributed exponentially.
    pub outage_duration: f64,
}

impl Default for GnssSettings {
    /// Returns the settings of a receiver with ten fixes a second, noise of 0.5 m, slow errors of 1 m and no outages.
    fn default() -> Self {
        Self {
            mount: Mount::above(1.5),
            period: 0.1,
            position: Inaccuracy { noise: 0.5, bias: 1.0, walk: 0.05 },
            velocity_noise: 0.05,
            outages: 0.0,
            outage_duration: 5.0,
        }
    }
}

/// The position and velocity that a satellite receiver gives at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fix {
    /// The position of the antenna, in metres in the plane of the world.
    pub position: Vector2<f64>,
    /// The velocity of the antenna over the ground, in m/s.
    pub velocity: Vector2<f64>,
}

/// A satellite receiver (GPS), whose reading is a fix, or `None` during an outage.
#[derive(Debug, Clone)]
pub struct Gnss {
    settings: GnssSettings,
    drift: Drift<2>,
    /// The time of the last reading, and the time at which the last outage ends.
    before: f64,
    lost_until: f64,
}

impl Gnss {
    /// Makes a satellite receiver with the given settings.
    ///
    /// # Errors
    /// A setting is out of its range or is not a number.
    pub fn new(settings: GnssSettings) -> Result<Self, SensorError> {
        let checks = Checks("gnss");
        settings.mount.check(&checks)?;
        checks.period(settings.period)?;
        settings.position.check(&checks, "position", "m")?;
        checks.within("velocity_noise", settings.velocity_noise, (0.0, 1000.0), "m/s")?;
        checks.within("outages", settings.outages, (0.0, 1000.0), "1/s")?;
        checks.within("outage_duration", settings.outage_duration, (0.0, 1e6), "s")?;
        Ok(Self { drift: Drift::new(settings.position), settings, before: f64::NAN, lost_until: f64::NEG_INFINITY })
    }

    /// Returns `true` if there is an outage at this time. The random numbers are drawn at every reading, so outages do
    /// not change the noise.
    fn is_lost(&mut self, time: f64, chance: &mut Chance) -> bool {
        let passed = (time - self.before).max(0.0);
        self.before = time;
        let begins = chance.happens(1.0 - libm::exp(-self.settings.outages * passed));
        let duration = chance.exponential(self.settings.outage_duration);
        if begins && time >= self.lost_until {
            self.lost_until = time + duration;
        }
        time < self.lost_until
    }
}

impl Sensor for Gnss {
    type Reading = Option<Fix>;

    fn period(&self) -> f64 {
        self.settings.period
    }

    fn reset(&mut self) {
        self.drift.reset();
        self.before = f64::NAN;
        self.lost_until = f64::NEG_INFINITY;
    }

    fn sense(&mut self, view: &SensorView<'_>, chance: &mut Chance, reading: &mut Option<Fix>) {
        let lost = self.is_lost(view.time, chance);
        let GnssSettings { mount, velocity_noise, .. } = self.settings;
        let position = self.drift.measured(mount.pose(view.car).position, view.time, chance);
        let noise = Vector2::new(chance.normal(), chance.normal()) * velocity_noise;
        let velocity = mount.velocity(view.car) + noise;
        *reading = (!lost).then_some(Fix { position, velocity });
    }
}
