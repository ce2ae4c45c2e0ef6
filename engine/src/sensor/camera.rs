//! Cameras as a driver has them: how they are described, when they open their shutters, and what comes of it.
//!
//! The engine draws nothing. A [`Shutter`] notes the [`Moment`] that a camera saw, and whoever runs the test develops it to
//! an [`Image`] when it has arrived.

use super::Descriptor;
use super::{Chance, Delivery, Handle, Rig, Sample, Sensor, SensorError, SensorView};
use crate::chance::mixed;
use crate::object::BodyState;
use crate::weather::Weather;
use paracosm_space::Record;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How lists show this kind of sensor.
pub(super) const DESCRIPTOR: Descriptor = Descriptor { name: "camera", about: "images in colour, by the renderer" };

/// The cameras on the car under test.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cameras {
    /// Where the noise of all of them comes from, together with the values of the test.
    #[serde(default)]
    pub seed: u64,
    /// Each by its name.
    #[serde(rename = "camera")]
    pub all: BTreeMap<String, CameraSpec>,
}

/// A camera: where it is mounted, and how it takes images. The table [`CORE_CAMERA_SETTINGS`](super::CORE_CAMERA_SETTINGS)
/// describes its numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CameraSpec {
    /// Pixels across and down.
    pub resolution: [u32; 2],
    /// Millimetres.
    pub focal_mm: f64,
    /// The width of the sensor in millimetres.
    pub sensor_mm: f64,
    /// Metres from the middle of the car, on the ground: ahead, to the left, up.
    pub position: [f64; 3],
    /// Degrees: yaw to the left, then pitch downwards, then roll to the right.
    #[serde(default)]
    pub yaw_pitch_roll: [f64; 3],
    /// Images per second.
    pub rate: f64,
    /// Seconds from when an image is taken to when it is there.
    #[serde(default)]
    pub latency: f64,
    /// The probability that an image is lost.
    #[serde(default)]
    pub dropped: f64,
    /// The settings of the lens and the sensor by their names, such as `blur`. The engine only hands them on: the renderer
    /// knows the names, refuses others, and takes the default of each setting that is absent. In a file they stand beside
    /// the other keys.
    #[serde(flatten)]
    pub lens: Record<f64>,
}

/// A moment as a camera sees it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moment {
    /// All bodies, that of the car first.
    pub bodies: Vec<BodyState>,
    /// Light, fog, rain and the sun.
    pub weather: Weather,
    /// Of the car in m/s.
    pub speed: f64,
    /// The length of the way that the car has come, in metres.
    pub travelled: f64,
}

/// Opens the shutter of a camera every so many seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shutter {
    /// Seconds between two images.
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

/// The shutters of a set of cameras, with the moments that have arrived: a rig of their own, so that no camera depends on
/// what else the car carries.
#[derive(Debug, Default)]
pub struct Shutters {
    cameras: Cameras,
    rig: Rig,
    each: Vec<Handle<Shutter>>,
}

impl Shutters {
    /// The shutters of these cameras.
    ///
    /// # Errors
    /// A camera has a rate, a latency or a probability of losing images that there is not; the error names it.
    pub fn of(cameras: Cameras) -> Result<Self, SensorError> {
        let mut rig = Rig::new(cameras.seed);
        let attached = cameras.all.iter().map(|(name, camera)| {
            let delivery = Delivery { latency: camera.latency, loss: camera.dropped };
            rig.attach(name, Shutter { period: 1.0 / camera.rate }, delivery)
        });
        let each = attached.collect::<Result<_, _>>()?;
        Ok(Self { cameras, rig, each })
    }

    /// The same in a test of this key: another test has other noise and loses other images, so that nobody learns them.
    pub(crate) fn in_test(mut self, key: u64) -> Self {
        self.cameras.seed = mixed(mixed(self.cameras.seed) ^ key);
        self.rig.reseed(self.cameras.seed);
        self
    }

    /// The cameras that they belong to. In a run their seed is that of its own noise: it depends on the seed that they were
    /// given and on the values of the test.
    pub fn cameras(&self) -> &Cameras {
        &self.cameras
    }

    /// The moments that have arrived since the driver was last asked, each with the place of its camera among the names:
    /// camera by camera, and the earliest first.
    pub fn arrived(&self) -> impl Iterator<Item = (usize, &Sample<Moment>)> {
        let each = self.each.iter().enumerate();
        each.flat_map(|(camera, shutter)| self.rig.arrived(shutter).iter().map(move |sample| (camera, sample)))
    }

    /// All their moments go through it.
    pub(crate) fn rig(&mut self) -> &mut Rig {
        &mut self.rig
    }
}

/// What a camera gives: an image that has arrived.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Which of the driver's cameras, in the order of their names.
    pub camera: usize,
    /// Which of the camera's images: the k-th is due at k periods.
    pub number: u64,
    /// When it was taken, in seconds since the run began.
    pub time: f64,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// sRGB, three bytes a pixel, row by row from the top left.
    pub rgb: Vec<u8>,
}
