//! The cameras of a recording, as a file describes them.

use crate::Error;
use nalgebra::Point3;
use paracosm_render::lens::Effects;
use paracosm_render::{Camera, CameraError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The most pixels each way, so that a slip of the finger does not ask for more memory than there is.
const MOST_PIXELS: u32 = 8192;

/// The cameras on the car under test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cameras {
    /// Where the noise of all of them comes from.
    #[serde(default)]
    pub seed: u64,
    /// Each by its name.
    #[serde(rename = "camera")]
    pub all: BTreeMap<String, Mounted>,
}

/// A camera, where it is mounted, and how it takes images.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mounted {
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
    /// The pixels over which motion smears the image.
    #[serde(default)]
    pub motion: f64,
    /// Which way that is, in degrees counter-clockwise from the right.
    #[serde(default)]
    pub motion_angle: f64,
    /// The radius of the disc that a point becomes out of focus, in pixels.
    #[serde(default)]
    pub defocus: f64,
    /// The standard deviation of the lens's blur, in pixels.
    #[serde(default)]
    pub blur: f64,
    /// From 0, none, to 1: how much darker it gets towards the corners.
    #[serde(default)]
    pub vignetting: f64,
    /// Stops.
    #[serde(default)]
    pub exposure: f64,
    /// Electrons; 0 for no shot noise.
    #[serde(default)]
    pub full_well: f64,
    /// Electrons.
    #[serde(default)]
    pub read_noise: f64,
}

impl Cameras {
    /// What a recording has where nothing else is said, as the text of a file: one camera at the front with 200 x 66
    /// pixels, as networks that drive are fed, and ten images a second.
    pub const DEFAULT: &str = include_str!("cameras.toml");

    /// Reads and checks a file.
    ///
    /// # Errors
    /// It cannot be read, is no TOML, or describes a camera that there is not; the error names it.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(Error::file("read", path))?;
        let cameras: Self = toml::from_str(&text).map_err(|error| {
            let line = error.span().map(|span| text[..span.start].matches('\n').count() + 1);
            Error::content(path, line, error.message().to_owned())
        })?;
        cameras.check().map_err(|message| Error::content(path, None, message))?;
        Ok(cameras)
    }

    /// A camera at the front for people to look at: 640 x 480 pixels.
    pub fn for_people() -> Self {
        let mut cameras = Self::default();
        for camera in cameras.all.values_mut() {
            camera.resolution = [640, 480];
        }
        cameras
    }

    fn check(&self) -> Result<(), String> {
        if self.all.is_empty() {
            return Err("found no camera, expected a table [camera.NAME]".to_owned());
        }
        let plain =
            |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
        for (name, camera) in &self.all {
            if !plain(name) {
                return Err(format!(
                    "camera `{name}`: expected a name of letters, digits, - and _, which becomes that of a folder"
                ));
            }
            camera.check().map_err(|message| format!("camera `{name}`: {message}"))?;
        }
        Ok(())
    }
}

impl Default for Cameras {
    fn default() -> Self {
        toml::from_str(Self::DEFAULT).expect("the file that comes with the program is sound")
    }
}

impl Mounted {
    fn check(&self) -> Result<(), String> {
        let within = |what: &str, value: f64, (low, high): (f64, f64), unit: &str| {
            let fine = (low..=high).contains(&value);
            (!fine).then(|| format!("{what} is {value}, expected {low} to {high} {unit}")).map_or(Ok(()), Err)
        };
        if let Some(pixels) = self.resolution.iter().find(|pixels| **pixels > MOST_PIXELS) {
            return Err(format!("resolution has {pixels} pixels, expected at most {MOST_PIXELS} each way"));
        }
        within("rate", self.rate, (0.001, 1000.0), "Hz")?;
        within("latency", self.latency, (0.0, 100.0), "s")?;
        within("dropped", self.dropped, (0.0, 1.0), "as a probability")?;
        self.camera().map(drop).map_err(|error| error.to_string())?;
        self.effects().check().map_err(|error| error.to_string())
    }

    /// The camera.
    ///
    /// # Errors
    /// There is no such camera.
    pub fn camera(&self) -> Result<Camera, CameraError> {
        let [width, height] = self.resolution;
        let [yaw, pitch, roll] = self.yaw_pitch_roll.map(f64::to_radians);
        Camera::new(width, height, self.focal_mm, self.sensor_mm)?.mounted(
            Point3::from(self.position),
            yaw,
            pitch,
            roll,
        )
    }

    /// What its lens and its sensor do.
    pub fn effects(&self) -> Effects {
        Effects {
            motion: self.motion,
            motion_angle: self.motion_angle.to_radians(),
            defocus: self.defocus,
            blur: self.blur,
            vignetting: self.vignetting,
            exposure: self.exposure,
            full_well: self.full_well,
            read_noise: self.read_noise,
        }
    }
}
