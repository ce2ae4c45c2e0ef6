//! The cameras of a driver: their descriptions, the moments at which they take images, and the images.
//!
//! The engine renders nothing. A [`Shutter`] records the [`Moment`] that a camera saw. The program that runs the test
//! renders an [`Image`] from it when the moment has arrived.

use super::Descriptor;
use super::{Chance, Delivery, Handle, Rig, Sample, Sensor, SensorError, SensorView};
use crate::chance::mixed;
use crate::object::BodyState;
use crate::weather::Weather;
use paracosm_space::Record;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The entry of this kind of sensor in lists.
pub(super) const DESCRIPTOR: Descriptor = Descriptor { name: "camera", about: "images in colour, by the renderer" };

/// The cameras on the ego vehicle.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cameras {
    /// The seed of the noise of all cameras, which also depends on the values of the test.
    #[serde(default)]
    pub seed: u64,
    /// The cameras by their names.
    #[serde(rename = "camera")]
    pub all: BTreeMap<String, CameraSpec>,
}

/// A camera: its mounting, and how it takes images. The table [`CORE_CAMERA_SETTINGS`](super::CORE_CAMERA_SETTINGS)
/// describes its numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CameraSpec {
    /// The size of the images in pixels, across and down.
    pub resolution: [u32; 2],
    /// The focal length in millimetres.
    pub focal_mm: f64,
    /// The width of the sensor in millimetres.
    pub sensor_mm: f64,
    /// The position of the camera, in metres from the middle of the car on the ground: ahead, to the left, up.
    pub position: [f64; 3],
    /// The direction of the camera in degrees: yaw to the left, then pitch downwards, then roll to the right.
    #[serde(default)]
    pub yaw_pitch_roll: [f64; 3],
    /// The number of images per second.
    pub rate: f64,
    /// The seconds from when an image is taken to when it arrives.
    #[serde(default)]
    pub latency: f64,
    /// The probability that an image is lost.
    #[serde(default)]
    pub dropped: f64,
    /// The settings of the lens and the sensor by their names, such as `blur`. The engine only hands them on. The
    /// renderer knows the names, refuses others, and takes the default of each absent setting. In a file they stand
    /// beside the other keys.
    #[serde(flatten)]
    pub lens: Record<f64>,
}

/// The state of the world at a moment, as a camera sees it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moment {
    /// All bodies, the car's first.
    pub bodies: Vec<BodyState>,
    /// Light, fog, rain and the sun.
    pub weather: Weather,
    /// The speed of the car in m/s.
    pub speed: f64,
    /// The distance that the car has covered, in metres.
    pub travelled: f64,
}

/// Records a moment for a camera at a fixed period.
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
        moment.bodies.clear();
        moment.bodies.extend_from_slice(view.bodies);
        moment.weather = view.weather;
        moment.speed = view.car.speed();
        moment.travelled = view.car.travelled;
    }
}

/// The shutters of a set of cameras, with the moments that have arrived. They form their own rig, so no camera depends
/// on the car's other sensors.
#[derive(Debug, Default)]
pub struct Shutters {
    cameras: Cameras,
    rig: Rig,
    each: Vec<Handle<Shutter>>,
}

impl Shutters {
    /// Makes the shutters of these cameras.
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

    /// Returns the shutters for a test with this key: each has other noise and losses, so that nobody learns them.
    pub(crate) fn in_test(mut self, key: u64) -> Self {
        self.cameras.seed = mixed(mixed(self.cameras.seed) ^ key);
        self.rig.reseed(self.cameras.seed);
        self
    }

    /// Returns the cameras of these shutters. During a run, their seed depends on the original seed and on the values
    /// of the test.
    pub fn cameras(&self) -> &Cameras {
        &self.cameras
    }

    /// Returns the moments that have arrived since the driver was last asked, each with the index of its camera in the
    /// order of names: camera by camera, and the earliest first.
    pub fn arrived(&self) -> impl Iterator<Item = (usize, &Sample<Moment>)> {
        let each = self.each.iter().enumerate();
        each.flat_map(|(camera, shutter)| self.rig.arrived(shutter).iter().map(move |sample| (camera, sample)))
    }

    /// Returns the rig that all moments go through.
    pub(crate) fn rig(&mut self) -> &mut Rig {
        &mut self.rig
    }
}

/// An image of a camera that has arrived.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// The index of the camera in the order of the cameras' names.
    pub camera: usize,
    /// The number of the image: the k-th image is due at k periods.
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
