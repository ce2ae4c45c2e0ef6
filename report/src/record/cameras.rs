//! The cameras of a recording: those that it has where nothing is said, and those of a file.

use super::VariedCameras;
use super::camera_file::{Flaw, parse};
use paracosm_campaign::Error;
use paracosm_engine::sensor::{CameraSetting, Cameras};
use paracosm_render::camera_settings;
use std::fs;
use std::path::Path;

/// The file of the cameras of a recording without a file of its own: one camera at the front with 200 x 66 pixels, as
/// networks that drive are fed, and ten images a second. It says all settings of the lens with their defaults, for users to
/// change.
pub fn standard_cameras_file() -> String {
    let of_lens = camera_settings().iter().filter(CameraSetting::is_of_lens);
    let line = |setting: CameraSetting| {
        let said = format!("{} = {:?}", setting.key, setting.default.unwrap_or(setting.example));
        format!("{said:<34}# {}\n", setting.about)
    };
    of_lens.map(line).fold(include_str!("cameras.toml").to_owned(), |file, line| file + &line)
}

/// The cameras of a recording without a file of its own: those of [`standard_cameras_file`].
pub fn standard_cameras() -> Cameras {
    toml::from_str(&standard_cameras_file()).expect("the file that comes with the program is sound")
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
    let text = fs::read_to_string(path).map_err(Error::io("read", path))?;
    parse(&text).map_err(|Flaw { line, flaw }| Error::in_file(path, line, flaw))
}
