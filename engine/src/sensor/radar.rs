//! An automotive radar, which gives a list of detections.
//!
//! A body echoes from its nearest point. The probability of a detection follows from the radar equation: the
//! signal-to-noise ratio falls with the fourth power of the distance and rises with the radar cross-section, and a
//! fluctuating target (Swerling I, a single look) is detected with the probability P_fa^(1 / (1 + SNR)) (Richards,
//! Fundamentals of Radar Signal Processing, section 6.3). A body behind something large is not seen. Fog does not
//! affect radars. Rain, which takes some decibels over 200 m, is left out; there are no multiple reflections.

use super::Descriptor;
use super::error::{Checks, SensorError};
use super::sight::hidden;
use super::{Chance, Mount, Sensor, SensorView};
use crate::object::{BodyState, Class, Outline};
use nalgebra::Vector2;
use paracosm_road::wrapped;
use std::f64::consts::{FRAC_PI_3, LN_2, TAU};

/// The description of radars in lists of sensors.
pub(super) const DESCRIPTOR: Descriptor =
    Descriptor { name: "radar", about: "distance, direction and closing speed of bodies" };

/// The logarithm of the probability of a false alarm by noise alone, 1e-6.
const LN_FALSE_ALARM: f64 = -13.815_510_557_964_274;

/// The settings of a radar, not checked yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadarSettings {
    /// The mounting of the antenna.
    pub mount: Mount,
    /// The seconds between two sweeps.
    pub period: f64,
    /// The greatest distance in metres that the radar measures.
    pub range: f64,
    /// The horizontal opening angle of the radar in radians.
    pub field_of_view: f64,
    /// The distance in metres at which a car is detected in half of the sweeps.
    pub half_range: f64,
    /// The standard deviation of the noise of a measured range, in metres.
    pub range_noise: f64,
    /// The standard deviation of the noise of a measured range rate, in m/s.
    pub range_rate_noise: f64,
    /// The standard deviation of the noise of a measured azimuth, in radians.
    pub azimuth_noise: f64,
    /// The mean number of false detections in a sweep, evenly distributed over ranges and directions.
    pub clutter: f64,
    /// The greatest absolute range rate of a false detection in m/s.
    pub clutter_range_rate: f64,
}

impl Default for RadarSettings {
    /// Returns the settings of a long-range radar in the front bumper. It makes twenty sweeps a second over 60 degrees,
    /// with a car at 160 m in half of the sweeps and 0.5 false detections a sweep.
    fn default() -> Self {
        Self {
            mount: Mount::ahead(2.25, 0.5),
            period: 0.05,
            range: 200.0,
            field_of_view: FRAC_PI_3,
            half_range: 160.0,
            range_noise: 0.2,
            range_rate_noise: 0.1,
            azimuth_noise: 0.005,
            clutter: 0.5,
            clutter_range_rate: 30.0,
        }
    }
}

/// A detection of a radar, which is a point from which an echo seems to come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// The distance of the point, in metres.
    pub range: f64,
    /// The rate at which the distance grows, in m/s; negative for bodies that come closer.
    pub range_rate: f64,
    /// The azimuth of the point, in radians counter-clockwise from the direction of the radar.
    pub azimuth: f64,
    /// The index of the detected body; `None` for a false detection. Only for comparisons: no real radar knows this.
    pub body: Option<usize>,
}

/// A radar, whose reading is the list of detections of a sweep. Detections of bodies come before false detections.
#[derive(Debug, Clone)]
pub struct Radar {
    settings: RadarSettings,
}

impl Radar {
    /// Makes a radar with the given settings.
    ///
    /// # Errors
    /// A setting is out of its range or is not a number.
    pub fn new(settings: RadarSettings) -> Result<Self, SensorError> {
        let checks = Checks("radar");
        settings.mount.check(&checks)?;
        checks.period(settings.period)?;
        checks.range(settings.range)?;
        checks.within("field_of_view", settings.field_of_view, (1e-3, TAU), "rad")?;
        checks.within("half_range", settings.half_range, (0.1, 10_000.0), "m")?;
        checks.within("range_noise", settings.range_noise, (0.0, 100.0), "m")?;
        checks.within("range_rate_noise", settings.range_rate_noise, (0.0, 100.0), "m/s")?;
        checks.within("azimuth_noise", settings.azimuth_noise, (0.0, 1.0), "rad")?;
        checks.within("clutter", settings.clutter, (0.0, 10_000.0), "")?;
        checks.within("clutter_range_rate", settings.clutter_range_rate, (0.0, 1000.0), "m/s")?;
        Ok(Self { settings })
    }

    /// Returns the probability that a sweep detects an unhidden body of a given class at a given distance in metres.
    pub fn probability(&self, class: Class, range: f64) -> f64 {
        let nearer = self.settings.half_range / range;
        // At the half range, a car has the signal-to-noise ratio that gives a probability of one half.
        let at_half = -LN_FALSE_ALARM / LN_2 - 1.0;
        let ratio = at_half * (cross_section(class) / cross_section(Class::Car)) * (nearer * nearer * nearer * nearer);
        libm::exp(LN_FALSE_ALARM / (1.0 + ratio))
    }

    /// Returns the true values of a body's detection, if the body is in the field of view and not hidden.
    fn echo(&self, view: &SensorView<'_>, index: usize, state: &BodyState) -> Option<Detection> {
        let RadarSettings { mount, range, field_of_view, .. } = self.settings;
        let pose = mount.pose(view.car);
        let nearest = nearest(state, pose.position);
        let seen = pose.to_local(nearest);
        let (distance, azimuth) = (seen.norm(), libm::atan2(seen.y, seen.x));
        let in_field = distance > 0.0 && distance <= range && azimuth.abs() <= 0.5 * field_of_view;
        if !in_field || hidden(view.bodies, index, pose.position, nearest) {
            return None;
        }
        let relative = state.velocity - mount.velocity(view.car);
        let range_rate = relative.dot(&(nearest - pose.position)) / distance;
        Some(Detection { range: distance, range_rate, azimuth, body: Some(index) })
    }

    fn clutter(&self, chance: &mut Chance) -> Detection {
        let RadarSettings { range, field_of_view, clutter_range_rate, .. } = self.settings;
        Detection {
            range: chance.between(0.0, range),
            range_rate: chance.between(-clutter_range_rate, clutter_range_rate),
            azimuth: chance.between(-0.5 * field_of_view, 0.5 * field_of_view),
            body: None,
        }
    }
}

impl Sensor for Radar {
    type Reading = Vec<Detection>;

    fn period(&self) -> f64 {
        self.settings.period
    }

    fn sense(&mut self, view: &SensorView<'_>, chance: &mut Chance, reading: &mut Vec<Detection>) {
        reading.clear();
        let RadarSettings { range_noise, range_rate_noise, azimuth_noise, .. } = self.settings;
        // The random numbers are drawn for all bodies, so a body out of sight does not change the noise of the others.
        for (index, state) in view.bodies.iter().enumerate().skip(1) {
            let luck = chance.unit();
            let noise = [chance.normal(), chance.normal(), chance.normal()];
            if !state.present {
                continue;
            }
            let Some(echo) = self.echo(view, index, state) else { continue };
            if luck < self.probability(state.body.class, echo.range) {
                reading.push(Detection {
                    range: (echo.range + noise[0] * range_noise).max(0.0),
                    range_rate: echo.range_rate + noise[1] * range_rate_noise,
                    azimuth: wrapped(echo.azimuth + noise[2] * azimuth_noise),
                    ..echo
                });
            }
        }
        let clutter = chance.poisson(self.settings.clutter);
        reading.extend((0..clutter).map(|_| self.clutter(chance)));
    }
}

/// Returns the radar cross-section in m² of a body of this class at 77 GHz, as the order of magnitude of measurements
/// and a mean over all aspects.
fn cross_section(class: Class) -> f64 {
    match class {
        Class::Car => 10.0,
        Class::Van => 20.0,
        Class::Truck | Class::Bus => 50.0,
        Class::Motorcycle => 5.0,
        Class::Bicycle => 2.0,
        Class::Pedestrian => 0.5,
        Class::Building => 100.0,
        Class::Tree => 1.0,
        Class::Sign => 5.0,
        Class::Prop => 1.0,
    }
}

/// Returns the point of a body's outline or its inside that is nearest to another point.
fn nearest(state: &BodyState, to: Vector2<f64>) -> Vector2<f64> {
    let seen = state.pose.to_local(to);
    let local = match state.body.outline {
        Outline::Rectangle { .. } => {
            let half = state.body.outline.half_extent();
            seen.sup(&-half).inf(&half)
        }
        Outline::Disc { radius } => {
            let distance = seen.norm();
            if distance > radius { seen * (radius / distance) } else { seen }
        }
    };
    state.pose.position + state.pose.turn_to_plane(local)
}
