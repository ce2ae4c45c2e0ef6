//! The table of the settings of cameras: first the settings of the engine, then those of the lens effects, in the order
//! in which light passes them. Readers of files, checks, variation from test to test and documents all use this table.

use crate::CameraError;
use crate::lens::{EFFECTS, LensEffect};
use paracosm_engine::sensor::{CORE_CAMERA_SETTINGS, CameraSetting, CameraSpec, Cameras};
use paracosm_space::{Record, did_you_mean, nearest};
use thiserror::Error;

/// The key of the resolution in a file of cameras. The resolution is not a single number and has no row in the table.
pub const RESOLUTION: &str = "resolution";

/// The most pixels each way, so that a typing error does not ask for more memory than there is.
const MOST_PIXELS: u32 = 8192;

/// Returns the table of all settings of a camera and its lens.
pub fn camera_settings() -> CameraSettings {
    CameraSettings::with(EFFECTS)
}

/// A table of the settings of a camera and its lens, with their ranges and defaults.
#[derive(Debug, Clone, Copy)]
pub struct CameraSettings {
    effects: &'static [&'static LensEffect],
}

/// The error for a camera whose description is not valid, with the name of the camera.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("camera `{camera}`: {flaw}")]
pub struct NoCamera {
    /// The name of the camera with the flaw.
    pub camera: String,
    /// The flaw in the description of the camera.
    pub flaw: CameraFlaw,
}

/// The reason why the description of a camera is not valid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CameraFlaw {
    /// The width or the height of the image has too few or too many pixels.
    #[error("`{RESOLUTION}` is {found:?}, expected 1 to {MOST_PIXELS} pixels each way")]
    Resolution {
        /// The given width and height of the image, in pixels.
        found: [u32; 2],
    },
    /// The value of a setting is out of the setting's range.
    #[error("`{}` is {}, expected {}", settings[0].key, listed(found), ranges(settings))]
    OutOfRange {
        /// The settings that belong to the key with the wrong value.
        settings: Vec<CameraSetting>,
        /// The given values of the settings that belong to the key.
        found: Vec<f64>,
    },
    /// The description has a key that is not a camera setting.
    #[error("a {part} has no key `{key}`{}; its keys are {}", did_you_mean(nearest), known.join(", "))]
    UnknownKey {
        /// The part of the description that has the key: `camera` or `lens`.
        part: &'static str,
        /// The unknown key in the description.
        key: String,
        /// The most similar known key, if any key is similar.
        nearest: Option<&'static str>,
        /// All known keys of a camera description.
        known: Vec<&'static str>,
    },
    /// The renderer cannot make a pinhole camera from the description.
    #[error(transparent)]
    Refused(#[from] CameraError),
}

impl CameraFlaw {
    /// Returns the key in the camera description that is wrong; `None` if the flaw has no key.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::Resolution { .. } => Some(RESOLUTION),
            Self::OutOfRange { settings, .. } => settings.first().map(|setting| setting.key),
            Self::UnknownKey { key, .. } => Some(key),
            Self::Refused(_) => None,
        }
    }
}

/// Makes the flaw of a key that a part of a camera's description does not have.
fn unknown(part: &'static str, key: &str, known: Vec<&'static str>) -> CameraFlaw {
    CameraFlaw::UnknownKey { part, key: key.to_owned(), nearest: nearest(key, known.iter().copied()), known }
}

impl CameraSettings {
    /// Makes a table of the settings of a camera whose lens has the given effects.
    pub const fn with(effects: &'static [&'static LensEffect]) -> Self {
        Self { effects }
    }

    /// Returns the effects of the lens and the sensor, in the order in which light passes them.
    pub fn effects(self) -> &'static [&'static LensEffect] {
        self.effects
    }

    /// Returns all settings in the order of their keys in camera files. The settings of one key are adjacent.
    pub fn iter(self) -> impl Iterator<Item = CameraSetting> {
        let of_lens = self.effects.iter().flat_map(|effect| effect.settings);
        CORE_CAMERA_SETTINGS.iter().chain(of_lens).copied()
    }

    /// Returns the keys of a camera description, in their order in camera files. [`RESOLUTION`] comes first, then the
    /// keys of all settings.
    pub fn keys(self) -> Vec<&'static str> {
        let mut keys: Vec<_> = std::iter::once(RESOLUTION).chain(self.iter().map(|setting| setting.key)).collect();
        keys.dedup();
        keys
    }

    /// Returns all settings that a key of a camera description sets. A key whose value is a list has several.
    ///
    /// # Errors
    /// There is no such key.
    pub fn of_key(self, key: &str) -> Result<Vec<CameraSetting>, CameraFlaw> {
        let settings: Vec<_> = self.iter().filter(|setting| setting.key == key).collect();
        if settings.is_empty() { Err(unknown("camera", key, self.keys())) } else { Ok(settings) }
    }

    /// Checks that all settings of a camera description exist and are in their ranges.
    ///
    /// # Errors
    /// A number is out of its range, or the lens has a setting that does not exist.
    pub fn check(self, camera: &CameraSpec) -> Result<(), CameraFlaw> {
        if !camera.resolution.iter().all(|pixels| (1..=MOST_PIXELS).contains(pixels)) {
            return Err(CameraFlaw::Resolution { found: camera.resolution });
        }
        if let Some(wrong) = self.iter().find(|setting| !setting.admits(setting.value(camera))) {
            let settings = self.of_key(wrong.key)?;
            let found = settings.iter().map(|setting| setting.value(camera)).collect();
            return Err(CameraFlaw::OutOfRange { settings, found });
        }
        let of_lens = |name: &str| self.iter().any(|setting| setting.is_of_lens() && setting.name == name);
        match camera.lens.iter().find(|(name, _)| !of_lens(name)) {
            Some((key, _)) => {
                let of_lens = self.iter().filter(CameraSetting::is_of_lens);
                Err(unknown("lens", key, of_lens.map(|setting| setting.name).collect()))
            }
            None => Ok(()),
        }
    }

    /// Adds the missing settings of the lens to each camera, with their defaults. Settings that a camera does not
    /// mention get their defaults. Two sets of cameras that take the same images are then equal, and are written alike.
    pub fn complete(self, cameras: &mut Cameras) {
        for camera in cameras.all.values_mut() {
            let said = std::mem::replace(&mut camera.lens, Record::EMPTY);
            let all = self.iter().filter(CameraSetting::is_of_lens);
            let defaults = all.filter_map(|setting| Some((setting.name, setting.default?)));
            defaults.for_each(|(name, default)| camera.lens.set(name, default));
            said.iter().for_each(|(name, value)| camera.lens.set(name, *value));
        }
    }
}

/// Formats the values of a key as a single number or as a list.
fn listed(found: &[f64]) -> String {
    match found {
        [alone] => alone.to_string(),
        several => format!("{several:?}"),
    }
}

/// Formats the ranges of the settings of one key, with their units.
fn ranges(settings: &[CameraSetting]) -> String {
    let alike = |a: &CameraSetting, b: &CameraSetting| (a.range, a.unit) == (b.range, b.unit);
    match settings {
        [alone] if alone.unit.is_empty() => format!("{} ({})", range(alone), alone.about),
        [alone] => range(alone),
        [first, others @ ..] if others.iter().all(|other| alike(first, other)) => format!("{} each", range(first)),
        several => {
            let names = |alike: &[CameraSetting]| alike.iter().map(|setting| setting.name).collect::<Vec<_>>();
            let group = |alike: &[CameraSetting]| format!("{} {}", range(&alike[0]), names(alike).join(" and "));
            several.chunk_by(alike).map(group).collect::<Vec<_>>().join(", and ")
        }
    }
}

/// Formats the range of a setting, with its unit.
fn range(setting: &CameraSetting) -> String {
    let number = |number: f64| if number.abs() < 1e6 { number.to_string() } else { format!("{number:e}") };
    let (low, high) = setting.range;
    format!("{} to {} {}", number(low), number(high), setting.unit).trim_end().to_owned()
}

#[cfg(test)]
mod tests;
