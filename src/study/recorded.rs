//! Settings of cameras that record tests: they vary with the tests and stand in the log, but the world knows nothing of them.

#[cfg(feature = "camera")]
use {
    super::Study,
    crate::Error,
    paracosm_coverage::{Parameter, Space},
};

/// What their names begin with.
const CAMERA: &str = "camera.";

/// The name of the parameter that is a setting of a camera.
#[cfg(feature = "camera")]
pub(crate) fn setting_name(camera: &str, setting: &str) -> String {
    format!("{CAMERA}{camera}.{setting}")
}

/// Whether a parameter is one of the world.
pub(super) fn is_of_world(name: &str) -> bool {
    !name.starts_with(CAMERA)
}

#[cfg(feature = "camera")]
impl Study {
    /// Lets the tests vary settings of cameras that record them, after all other open parameters. To be called when those are
    /// opened, fixed and varied.
    ///
    /// # Errors
    /// Two are called the same, or one has no values.
    pub(crate) fn open_cameras(mut self, settings: impl IntoIterator<Item = Parameter>) -> Result<Self, Error> {
        self.space = Space::new(self.space.parameters().iter().cloned().chain(settings).collect())?;
        Ok(self)
    }
}
