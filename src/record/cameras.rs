//! The cameras of a recording: those that it has where nothing is said, and those of a file.

use super::VariedCameras;
use super::camera_file::parse;
use crate::Error;
use paracosm_engine::sensor::Cameras;
use std::fs;
use std::path::Path;

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
/// It cannot be read, is no TOML, or describes a camera that there is not; the error names the key and the line.
pub fn read_cameras(path: &Path) -> Result<VariedCameras, Error> {
    let text = fs::read_to_string(path).map_err(Error::file("read", path))?;
    parse(&text).map_err(|flaw| Error::content(path, flaw.line, flaw.message))
}
