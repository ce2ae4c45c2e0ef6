//! The cameras of a recording, as a file describes them.

use crate::Error;
use crate::darkroom::check;
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
fn check_cameras(cameras: &Cameras) -> Result<(), String> {
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
