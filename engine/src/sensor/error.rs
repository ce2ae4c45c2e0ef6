//! The errors of sensors.

use paracosm_space::plural;
use thiserror::Error;

/// An error in the settings, the attachment or the input of a sensor.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum SensorError {
    /// A setting of a sensor is out of its range.
    #[error("{sensor}: `{setting}` is {value}{}, expected {} to {}{}", spaced(.unit), range.0, range.1, spaced(.unit))]
    OutOfRange {
        /// The kind of the sensor, or the name under which the rig was to attach the sensor.
        sensor: String,
        /// The name of the setting.
        setting: String,
        /// The value of the setting.
        value: f64,
        /// The least and the greatest value of the setting.
        range: (f64, f64),
        /// The unit of the setting; empty if the setting has no unit.
        unit: &'static str,
    },
    /// The lower end of a field of view is not below the upper end.
    #[error("{sensor}: `lowest` is {lowest} rad, expected less than `highest`, which is {highest} rad")]
    EmptyField {
        /// The kind of the sensor.
        sensor: String,
        /// The lower end of the field of view in radians.
        lowest: f64,
        /// The upper end of the field of view in radians.
        highest: f64,
    },
    /// Two sensors in a rig have the same name.
    #[error("two sensors are called `{name}`; give each sensor its own name")]
    NameTaken {
        /// The name that both sensors have.
        name: String,
    },
    /// The number of pixels of a depth image differs from the number of pixels of its camera.
    #[error("the depth image has {}, expected the camera's {} x {}", plural(*found, "pixel"), size.0, size.1)]
    WrongSize {
        /// The number of pixels of the depth image.
        found: usize,
        /// The numbers of columns and rows of the camera's images.
        size: (usize, usize),
    },
}

fn spaced(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// The checks of one sensor's settings.
pub(super) struct Checks<'a>(pub &'a str);

impl Checks<'_> {
    /// Checks that the value of a setting is in its range.
    pub fn within(&self, setting: &str, value: f64, range: (f64, f64), unit: &'static str) -> Result<(), SensorError> {
        if (range.0..=range.1).contains(&value) {
            return Ok(());
        }
        Err(SensorError::OutOfRange { sensor: self.0.to_owned(), setting: setting.to_owned(), value, range, unit })
    }

    /// Checks that a setting that counts something is in its range.
    pub fn counts(&self, setting: &str, count: usize, range: (usize, usize)) -> Result<(), SensorError> {
        self.within(setting, count as f64, (range.0 as f64, range.1 as f64), "")
    }

    /// Checks that a number of seconds can be the period of a sensor.
    pub fn period(&self, seconds: f64) -> Result<(), SensorError> {
        self.within("period", seconds, (1e-4, 1e4), "s")
    }

    /// Checks that a number of metres can be the greatest distance that a sensor measures.
    pub fn range(&self, metres: f64) -> Result<(), SensorError> {
        self.within("range", metres, (0.1, 10_000.0), "m")
    }
}
