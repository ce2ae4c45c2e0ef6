//! The cameras of recordings and of perception networks: the standard cameras, and cameras from a file. Their settings may
//! vary from test to test.

mod file;
#[cfg(test)]
mod tests;
mod varied;

pub use file::CameraFileFlaw;
pub use varied::VariedCameras;

use crate::Error;
use crate::files::read_text;
use file::{Flaw, parse};
use paracosm_engine::sensor::{CameraSetting, Cameras};
use paracosm_render::camera_settings;
use std::path::Path;

/// Returns the text of the standard camera file, which a recording uses if the user names no file. The file has one
/// camera at the front with 640 x 360 pixels and ten images a second.
/// It lists all settings of the lens with their defaults, so that users can change them.
pub fn standard_cameras_file() -> String {
    let of_lens = camera_settings().iter().filter(CameraSetting::is_of_lens);
    let line = |setting: CameraSetting| {
        let said = format!("{} = {:?}", setting.key, setting.default.unwrap_or(setting.example));
        format!("{said:<34}# {}\n", setting.about)
    };
    of_lens.map(line).fold(include_str!("standard.toml").to_owned(), |file, line| file + &line)
}

/// Returns the cameras of the standard camera file that [`standard_cameras_file`] returns.
pub fn standard_cameras() -> Cameras {
    let Ok(cameras) = parse(&standard_cameras_file()) else { panic!("the file that comes with the program is sound") };
    cameras.nominal().clone()
}

/// Reads and checks a file that describes cameras.
///
/// # Errors
/// Returns an error if the file cannot be read, is not TOML, or describes a camera that cannot be built. The error
/// names the key and the line.
pub fn read_cameras(path: &Path) -> Result<VariedCameras, Error> {
    let text = read_text(path)?;
    parse(&text).map_err(|Flaw { line, flaw }| Error::in_file(path, line, flaw))
}
