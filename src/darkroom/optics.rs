//! A camera ready to draw with: from how it is described to what the renderer and the lens are told.

use crate::Error;
use nalgebra::Point3;
use paracosm_engine::sensor::{Cameras, Chance, Mounted};
use paracosm_render::lens::Effects;
use paracosm_render::{Camera, CameraError, Frame, Outputs};

/// The most pixels each way, so that a slip of the finger does not ask for more memory than there is.
const MOST_PIXELS: u32 = 8192;
/// How far from the car a camera may be, and how low, in metres.
const FARTHEST: f64 = 100.0;
const LOWEST: f64 = 0.05;

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

    /// The same with other noise.
    pub fn with_seed(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
    }

    /// What is drawn for it of what is wanted: light as it is, or for its lens.
    pub fn needs(&self, wanted: Outputs) -> Outputs {
        let plain = self.are_plain();
        Outputs { rgb: wanted.rgb && plain, linear: wanted.rgb && !plain, ..wanted }
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

/// Whether there is such a camera: the message names the key, what was found and what was expected.
pub(crate) fn check(mounted: &Mounted) -> Result<(), String> {
    let Mounted { resolution, position, yaw_pitch_roll, .. } = mounted;
    if !resolution.iter().all(|pixels| (1..=MOST_PIXELS).contains(pixels)) {
        return Err(format!("`resolution` is {resolution:?}, expected 1 to {MOST_PIXELS} pixels each way"));
    }
    let [x, y, z] = position;
    // Below the ground there is nothing to see but the sky.
    if ![x, y].iter().all(|along| (-FARTHEST..=FARTHEST).contains(*along)) || !(LOWEST..=FARTHEST).contains(z) {
        return Err(format!(
            "`position` is {position:?}, expected -{FARTHEST} to {FARTHEST} m ahead and to the left, and {LOWEST} to \
             {FARTHEST} m up"
        ));
    }
    if !yaw_pitch_roll.iter().all(|angle| (-360.0..=360.0).contains(angle)) {
        return Err(format!("`yaw_pitch_roll` is {yaw_pitch_roll:?}, expected -360 to 360 degrees each"));
    }
    let numbers = [
        ("focal_mm", mounted.focal_mm, (0.1, 10_000.0), " mm"),
        ("sensor_mm", mounted.sensor_mm, (0.1, 1000.0), " mm"),
        ("rate", mounted.rate, (0.001, 1000.0), " Hz"),
        ("latency", mounted.latency, (0.0, 100.0), " s"),
        ("dropped", mounted.dropped, (0.0, 1.0), ", a probability"),
        ("motion_angle", mounted.motion_angle, (-360.0, 360.0), " degrees"),
    ];
    let wrong = numbers.into_iter().find(|(_, found, (low, high), _)| !(*low..=*high).contains(found));
    if let Some((key, found, (low, high), unit)) = wrong {
        return Err(format!("`{key}` is {found}, expected {low} to {high}{unit}"));
    }
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
