//! The names of the parameters that vary settings of cameras.

/// The prefix of the names of settings of the cameras that record tests and of the cameras of perceivers. These settings vary with the tests and
/// stand in the log, but do not belong to the world.
const CAMERA: &str = "camera.";

/// Returns the name of the parameter that varies a setting of a camera.
#[cfg(feature = "camera")]
pub(crate) fn setting_name(camera: &str, setting: &str) -> String {
    format!("{CAMERA}{camera}.{setting}")
}

/// Returns `true` if a parameter varies a setting of a camera.
pub(crate) fn is_of_camera(name: &str) -> bool {
    name.starts_with(CAMERA)
}
