//! Where a satellite receiver says that the car is.

use super::Descriptor;
use super::drift::Drift;
use super::error::{Checks, SensorError};
use super::{Chance, Inaccuracy, Mount, Sensor, SensorView};
use nalgebra::Vector2;

/// How lists show this kind of sensor.
pub(super) const DESCRIPTOR: Descriptor =
    Descriptor { name: "gnss", about: "the position and velocity that a satellite receiver gives" };

/// A satellite receiver, not checked yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GnssSettings {
    /// Where its antenna is.
    pub mount: Mount,
    /// Seconds between two fixes.
    pub period: f64,
    /// How far off positions are, in metres: the noise of a fix, and the slow errors of orbits and ionosphere.
    pub position: Inaccuracy,
    /// Standard deviation of the noise of each coordinate of the velocity, in m/s. It is measured by the Doppler effect and
    /// has no bias.
    pub velocity_noise: f64,
    /// How often it loses the satellites, in 1/s: 0 for never.
    pub outages: f64,
    /// How long it is without them in the mean, in seconds; how long each time is exponentially distributed.
    pub outage_duration: f64,
}

impl Default for GnssSettings {
    /// Ten fixes a second from the roof, off by 0.5 m from fix to fix and by 1 m in the long run, without outages.
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

/// What a satellite receiver knows at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fix {
    /// Where its antenna is, in metres in the plane of the world.
    pub position: Vector2<f64>,
    /// How it moves over the ground, in m/s.
    pub velocity: Vector2<f64>,
}

/// A satellite receiver (GPS). Its reading is a fix, or none during an outage.
#[derive(Debug, Clone)]
pub struct Gnss {
    settings: GnssSettings,
    drift: Drift<2>,
    /// When it was last read, and when it has satellites again.
    before: f64,
    lost_until: f64,
}

impl Gnss {
    /// A receiver with these settings.
    ///
    /// # Errors
    /// A setting is out of its range or no number.
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

    /// Whether it is without satellites at this time. Chance is drawn whether or not it matters, so that outages do not move
    /// the noise.
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
