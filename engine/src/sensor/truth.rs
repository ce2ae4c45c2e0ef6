//! What a perfect sensor would know: the labels that readings of others are held against.

use super::Descriptor;
use super::error::{Checks, SensorError};
use super::sight::hidden;
use super::{Chance, Mount, Sensor, SensorView};
use crate::geometry::wrapped;
use crate::object::{Class, gap};
use nalgebra::{Vector2, Vector3};

/// How lists show this kind of sensor.
pub(super) const DESCRIPTOR: Descriptor =
    Descriptor { name: "ground truth", about: "every body as it is, but for what hides it" };

/// A sensor that knows the truth, not checked yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundTruthSettings {
    /// From where it looks, as to what hides what.
    pub mount: Mount,
    /// Seconds between two readings.
    pub period: f64,
    /// Up to how many metres of free space from the car it knows of bodies.
    pub range: f64,
}

impl Default for GroundTruthSettings {
    /// Ten times a second, up to 100 m, seen from the roof.
    fn default() -> Self {
        Self { mount: Mount::above(1.5), period: 0.1, range: 100.0 }
    }
}

/// A body as it truly is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueBody {
    /// Its index among the bodies of the run, where the car under test is 0.
    pub body: usize,
    /// What it is.
    pub class: Class,
    /// The middle of its box as seen from the middle of the car's on the ground: x ahead, y to the left, z up, in metres.
    pub position: Vector3<f64>,
    /// Length, width and height of its box in metres.
    pub size: Vector3<f64>,
    /// Where it points, in radians counter-clockwise from the car's heading.
    pub heading: f64,
    /// Its velocity over the ground in m/s, in the car's directions.
    pub velocity: Vector2<f64>,
    /// Metres of free space between it and the car.
    pub distance: f64,
    /// Whether something large stands between the sensor and its middle.
    pub hidden: bool,
}

/// A sensor that knows the truth of all bodies around the car, the hidden ones included, in the order of the bodies.
#[derive(Debug, Clone)]
pub struct GroundTruth {
    settings: GroundTruthSettings,
}

impl GroundTruth {
    /// A sensor with these settings.
    ///
    /// # Errors
    /// A setting is out of its range or no number.
    pub fn new(settings: GroundTruthSettings) -> Result<Self, SensorError> {
        let checks = Checks("ground truth");
        settings.mount.check(&checks)?;
        checks.period(settings.period)?;
        checks.range(settings.range)?;
        Ok(Self { settings })
    }
}

impl Sensor for GroundTruth {
    type Reading = Vec<TrueBody>;

    fn period(&self) -> f64 {
        self.settings.period
    }

    fn sense(&mut self, view: &SensorView<'_>, _chance: &mut Chance, reading: &mut Vec<TrueBody>) {
        reading.clear();
        let Some(car) = view.bodies.first() else { return };
        let eye = self.settings.mount.pose(view.car).position;
        reading.extend(view.others().filter_map(|(index, state)| {
            let distance = gap((&car.body.outline, &car.pose), (&state.body.outline, &state.pose));
            (distance <= self.settings.range).then(|| {
                let middle = car.pose.to_local(state.pose.position);
                let half = state.body.outline.half_extent();
                TrueBody {
                    body: index,
                    class: state.body.class,
                    position: Vector3::new(middle.x, middle.y, state.altitude + 0.5 * state.body.height),
                    size: Vector3::new(2.0 * half.x, 2.0 * half.y, state.body.height),
                    heading: wrapped(state.pose.heading - car.pose.heading),
                    velocity: car.pose.turn_to_local(state.velocity),
                    distance,
                    hidden: hidden(view.bodies, index, eye, state.pose.position),
                }
            })
        }));
    }
}
