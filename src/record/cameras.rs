//! The cameras of a recording, as a file describes them, and what they come to when they are drawn.

use crate::Error;
use nalgebra::Point3;
use paracosm_engine::sensor::{Cameras, Mounted};
use paracosm_render::lens::Effects;
use paracosm_render::{Camera, CameraError};
use std::fs;
use std::path::Path;

/// The most pixels each way, so that a slip of the finger does not ask for more memory than there is.
const MOST_PIXELS: u32 = 8192;

/// What a recording has where nothing else is said, as the text of a file: one camera at the front with 200 x 66
/// pixels, as networks that drive are fed, and ten images a second.
pub const STANDARD_CAMERAS: &str = include_str!("cameras.toml");

/// The cameras that a recording has where nothing else is said: [`STANDARD_CAMERAS`].
pub fn standard_cameras() -> Cameras {
    toml::from_str(STANDARD_CAMERAS).expect("the file that comes with the program is sound")
}

/// A camera at the front for people to look at: 640 x 480 pixels.
pub fn cameras_for_people() -> Cameras {
    let mut cameras = standard_cameras();
    for camera in cameras.all.values_mut() {
        camera.resolution = [640, 480];
    }
    cameras
}

/// Reads and checks a file.
///
/// # Errors
/// It cannot be read, is no TOML, or describes a camera that there is not; the error names it.
pub fn read_cameras(path: &Path) -> Result<Cameras, Error> {
    let text = fs::read_to_string(path).map_err(Error::file("read", path))?;
    let cameras: Cameras = toml::from_str(&text).map_err(|error| {
        let line = error.span().map(|span| text[..span.start].matches('\n').count() + 1);
        Error::content(path, line, error.message().to_owned())
    })?;
    if cameras.all.is_empty() {
        return Err(Error::content(path, None, "found no camera, expected a table [camera.NAME]"));
    }
    check_cameras(&cameras).map_err(|message| Error::content(path, None, message))?;
    Ok(cameras)
}

/// Whether there are such cameras; the message names the one that is not.
pub(crate) fn check_cameras(cameras: &Cameras) -> Result<(), String> {
    let plain =
        |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    for (name, camera) in &cameras.all {
        if !plain(name) {
            return Err(format!(
                "camera `{name}`: expected a name of letters, digits, - and _, which becomes that of a folder"
            ));
        }
        check(camera).map_err(|message| format!("camera `{name}`: {message}"))?;
    }
    Ok(())
}

fn check(mounted: &Mounted) -> Result<(), String> {
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
pub(crate) fn effects(mounted: &Mounted) -> Effects {
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
