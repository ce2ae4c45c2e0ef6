//! The cameras of a driver: their descriptions, the moments at which they take images, and the images.
//!
//! The engine renders nothing. A [`Shutter`] records the [`Moment`] that a camera saw. The program that runs the test
//! renders an [`Image`] from it when the moment has arrived.

use super::Descriptor;
use super::{Chance, Delivery, Handle, Look, Rig, Sample, Sensor, SensorError, SensorView};
use crate::chance::mixed;
use crate::object::BodyState;
use crate::weather::Weather;
use paracosm_space::Record;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The description of cameras in lists of sensors.
pub(super) const DESCRIPTOR: Descriptor = Descriptor { name: "camera", about: "images in colour, by the renderer" };

/// The cameras on the ego vehicle.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cameras {
    /// The seed of the noise of all cameras. The noise also depends on the values of the test.
    #[serde(default)]
    pub seed: u64,
    /// The look of the images. Files name the look beside the cameras.
    #[serde(skip)]
    pub look: Look,
    /// The cameras by their names.
    #[serde(rename = "camera")]
    pub all: BTreeMap<String, CameraSpec>,
}

/// The description of a camera by its mounting and its settings. The table
/// [`CORE_CAMERA_SETTINGS`](super::CORE_CAMERA_SETTINGS) describes the numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CameraSpec {
    /// The width and the height of the images in pixels.
    pub resolution: [u32; 2],
    /// The focal length in millimetres.
    pub focal_mm: f64,
    /// The width of the sensor in millimetres.
    pub sensor_mm: f64,
    /// The position of the camera (ahead, to the left, up), in metres from the middle of the car on the ground.
    pub position: [f64; 3],
    /// The direction of the camera in degrees, as yaw to the left, then pitch downwards, then roll to the right.
    #[serde(default)]
    pub yaw_pitch_roll: [f64; 3],
    /// The number of images per second.
    pub rate: f64,
    /// The seconds between the taking of an image and its arrival at the driver.
    #[serde(default)]
    pub latency: f64,
    /// The probability that an image is lost.
    #[serde(default)]
    pub dropped: f64,
    /// The settings of the lens and the sensor by their names, such as `blur`. The engine only hands the settings on.
    /// The renderer knows the names, refuses other names, and takes the default of each absent setting. In a file the
    /// settings stand beside the other keys.
    #[serde(flatten)]
    pub lens: Record<f64>,
}

/// The state of the world at a moment at which a camera takes an image.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moment {
    /// The states of all bodies in the world, with the ego vehicle's body first.
    pub bodies: Vec<BodyState>,
    /// The changes of the bodies' speeds over the last tick, in m/s² and in the order of the bodies.
    pub accelerations: Vec<f64>,
    /// The seconds since the run began.
    pub time: f64,
    /// The weather, which is light, fog, rain and the position of the sun.
    pub weather: Weather,
    /// The speed of the ego vehicle in m/s.
    pub speed: f64,
    /// The distance that the ego vehicle has covered, in metres.
    pub travelled: f64,
}

impl Moment {
    /// Sets the moment to the state of the world in a view.
    pub fn record(&mut self, view: &SensorView<'_>) {
        self.bodies.clear();
        self.bodies.extend_from_slice(view.bodies);
        self.accelerations.clear();
        let both = view.bodies.iter().zip(view.before);
        self.accelerations.extend(both.map(|(now, before)| (now.velocity.norm() - before.velocity.norm()) / view.dt));
        self.time = view.time;
        self.weather = view.weather;
        self.speed = view.car.speed();
        self.travelled = view.car.travelled;
    }
}

/// A sensor that records the moments at which a camera takes images, at a fixed period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shutter {
    /// The seconds between two images.
    pub period: f64,
}

impl Sensor for Shutter {
    type Reading = Moment;

    fn period(&self) -> f64 {
        self.period
    }

    fn sense(&mut self, view: &SensorView<'_>, _: &mut Chance, moment: &mut Moment) {
        moment.record(view);
    }
}

/// The shutters of a set of cameras, with the recorded moments that have arrived. They form their own rig, so no camera
/// depends on the car's other sensors.
#[derive(Debug, Default)]
pub struct Shutters {
    cameras: Cameras,
    rig: Rig,
    each: Vec<Handle<Shutter>>,
}

impl Shutters {
    /// Makes the shutters of the given cameras.
    ///
    /// # Errors
    /// A camera has an impossible rate, latency or probability of losing images. The error names the camera.
    pub fn of(cameras: Cameras) -> Result<Self, SensorError> {
        let mut rig = Rig::new(cameras.seed);
        let attached = cameras.all.iter().map(|(name, camera)| {
            let delivery = Delivery { latency: camera.latency, loss: camera.dropped };
            rig.attach(name, Shutter { period: 1.0 / camera.rate }, delivery)
        });
        let each = attached.collect::<Result<_, _>>()?;
        Ok(Self { cameras, rig, each })
    }

    /// Returns the shutters for the test with the given key. Each test has its own noise and losses.
    pub(crate) fn in_test(mut self, key: u64) -> Self {
        self.cameras.seed = mixed(mixed(self.cameras.seed) ^ key);
        self.rig.reseed(self.cameras.seed);
        self
    }

    /// Returns the descriptions of the shutters' cameras. During a run, their seed depends on the original seed and on
    /// the values of the test.
    pub fn cameras(&self) -> &Cameras {
        &self.cameras
    }

    /// Returns the moments that have arrived since the last question to the driver, each with the index of its camera.
    /// Cameras are in the order of their names, and the moments of a camera in the order of time.
    pub fn arrived(&self) -> impl Iterator<Item = (usize, &Sample<Moment>)> {
        let each = self.each.iter().enumerate();
        each.flat_map(|(camera, shutter)| self.rig.arrived(shutter).iter().map(move |sample| (camera, sample)))
    }

    /// Returns `true` if there is no camera.
    pub(crate) fn is_empty(&self) -> bool {
        self.rig.is_empty()
    }

    /// Returns the rig that holds the shutters.
    pub(crate) fn rig(&mut self) -> &mut Rig {
        &mut self.rig
    }
}

/// An image of a camera that has arrived at the driver.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// The index of the camera in the order of the cameras' names.
    pub camera: usize,
    /// The number k of the image, which is due after k periods of the camera.
    pub number: u64,
    /// The time at which the image was taken, in seconds since the run began.
    pub time: f64,
    /// The width of the image in pixels.
    pub width: u32,
    /// The height of the image in pixels.
    pub height: u32,
    /// The colours in sRGB, three bytes a pixel, row by row from the top left.
    pub rgb: Vec<u8>,
}
