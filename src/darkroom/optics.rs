//! A camera ready to draw with: from how it is described to what the renderer and the lens are told.

use crate::Error;
use nalgebra::Point3;
use paracosm_engine::sensor::{Cameras, Chance, Mounted};
use paracosm_render::lens::Effects;
use paracosm_render::{Camera, CameraError, Frame};

/// The most pixels each way, so that a slip of the finger does not ask for more memory than there is.
const MOST_PIXELS: u32 = 8192;

/// A camera with its lens and its noise.
#[derive(Debug, Clone)]
pub(crate) struct Optics {
    pub name: String,
    pub camera: Camera,
    effects: Effects,
    seed: u64,
}

impl Optics {
    /// All of a set, in the order of their names.
    ///
    /// # Errors
    /// There is no such camera; the error names it.
    pub fn of(cameras: &Cameras) -> Result<Vec<Self>, Error> {
        let ready = |(name, mounted): (&String, &Mounted)| {
            let camera = check(mounted).and_then(|()| camera(mounted).map_err(|error| error.to_string()));
            let camera = camera.map_err(|message| Error::Usage(format!("camera `{name}`: {message}")))?;
            Ok(Self { name: name.clone(), camera, effects: effects(mounted), seed: cameras.seed })
        };
        cameras.all.iter().map(ready).collect()
    }

    /// Whether colours go through it as they are.
    pub fn are_plain(&self) -> bool {
        self.effects.are_none()
    }

    /// What comes of linear light, with the noise of this image.
    pub fn develop(&self, frame: &Frame, number: u64) -> Option<Vec<u8>> {
        self.effects.develop(frame, &mut self.chance("noise", number))
    }

    /// The chance of something in an image of this number.
    pub fn chance(&self, what: &str, number: u64) -> Chance {
        Chance::of(self.seed, &format!("{}, {what}", self.name), number)
    }
}

/// Whether there is such a camera.
pub(crate) fn check(mounted: &Mounted) -> Result<(), String> {
    let within = |what: &str, value: f64, (low, high): (f64, f64), unit: &str| {
        let fine = (low..=high).contains(&value);
        (!fine).then(|| format!("{what} is {value}, expected {low} to {high} {unit}")).map_or(Ok(()), Err)
    };
    if let Some(pixels) = mounted.resolution.iter().find(|pixels| **pixels > MOST_PIXELS) {
        return Err(format!("resolution has {pixels} pixels, expected at most {MOST_PIXELS} each way"));
    }
    within("rate", mounted.rate, (0.001, 1000.0), "Hz")?;
    within("latency", mounted.latency, (0.0, 100.0), "s")?;
    within("dropped", mounted.dropped, (0.0, 1.0), "as a probability")?;
    camera(mounted).map(drop).map_err(|error| error.to_string())?;
    effects(mounted).check().map_err(|error| error.to_string())
}

/// The camera as the renderer has it.
pub(crate) fn camera(mounted: &Mounted) -> Result<Camera, CameraError> {
    let [width, height] = mounted.resolution;
    let [yaw, pitch, roll] = mounted.yaw_pitch_roll.map(f64::to_radians);
    let camera = Camera::new(width, height, mounted.focal_mm, mounted.sensor_mm)?;
    camera.mounted(Point3::from(mounted.position), yaw, pitch, roll)
}

/// What its lens and its sensor do.
fn effects(mounted: &Mounted) -> Effects {
    Effects {
        motion: mounted.motion,
        motion_angle: mounted.motion_angle.to_radians(),
        defocus: mounted.defocus,
        blur: mounted.blur,
        vignetting: mounted.vignetting,
        exposure: mounted.exposure,
        full_well: mounted.full_well,
        read_noise: mounted.read_noise,
    }
}
