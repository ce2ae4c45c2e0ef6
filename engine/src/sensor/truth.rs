//! A perfect sensor, whose readings are the labels for the readings of other sensors.

use super::Descriptor;
use super::error::{Checks, SensorError};
use super::sight::hidden;
use super::{Chance, Mount, Sensor, SensorView};
use crate::object::{Class, gap};
use nalgebra::{Vector2, Vector3};
use paracosm_road::wrapped;

/// The description of the ground truth sensor in lists of sensors.
pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "ground truth",
    about: "all bodies around the car as they truly are, and whether each is hidden",
};

/// The settings of a sensor that knows the ground truth, not checked yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundTruthSettings {
    /// The mounting of the sensor, which determines which bodies are hidden.
    pub mount: Mount,
    /// The seconds between two readings.
    pub period: f64,
    /// The greatest distance in metres between the outlines of the car and of a body that the sensor measures.
    pub range: f64,
}

impl Default for GroundTruthSettings {
    /// Returns the settings of a sensor on the roof that measures ten times a second, up to 100 m.
    fn default() -> Self {
        Self { mount: Mount::above(1.5), period: 0.1, range: 100.0 }
    }
}

/// The true state of a body, as seen from the car.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueBody {
    /// The index of the body among the bodies of the run, of which the ego vehicle has the index 0.
    pub body: usize,
    /// The class of the body.
    pub class: Class,
    /// The middle of the body's box, in metres from the car's middle on the ground (x ahead, y to the left, z up).
    pub position: Vector3<f64>,
    /// The length, width and height of the body's box in metres.
    pub size: Vector3<f64>,
    /// The direction in which the body points, in radians counter-clockwise from the car's heading.
    pub heading: f64,
    /// The velocity of the body over the ground in m/s, along the axes of the car.
    pub velocity: Vector2<f64>,
    /// The distance between the outlines of the body and of the car, in metres.
    pub distance: f64,
    /// True if a large body stands between the sensor and the middle of the observed body.
    pub hidden: bool,
}

/// A sensor that measures the true states of all bodies around the car, hidden or not, in the order of the bodies.
#[derive(Debug, Clone)]
pub struct GroundTruth {
    settings: GroundTruthSettings,
}

impl GroundTruth {
    /// Makes a ground truth sensor with the given settings.
    ///
    /// # Errors
    /// A setting is out of its range or is not a number.
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
