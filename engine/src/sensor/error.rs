//! The errors of sensors.

use thiserror::Error;

/// The reason why a sensor is impossible as it is described, or cannot be attached.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum SensorError {
    /// A setting is out of its range.
    #[error("{sensor}: `{setting}` is {value}{}, expected {} to {}{}", spaced(.unit), range.0, range.1, spaced(.unit))]
    OutOfRange {
        /// The kind of the sensor, or the name under which it was to be attached.
        sensor: String,
        /// The name of the setting.
        setting: String,
        /// The value of the setting.
        value: f64,
        /// The least and the greatest value of the setting.
        range: (f64, f64),
        /// The unit of the setting; empty if it has none.
        unit: &'static str,
    },
    /// The lower end of a field of view is not below its upper end.
    #[error("{sensor}: `lowest` is {lowest} rad, expected less than `highest`, which is {highest} rad")]
    EmptyField {
        /// The kind of the sensor.
        sensor: String,
        /// The lower end in radians.
        lowest: f64,
        /// The upper end in radians.
        highest: f64,
    },
    /// Two sensors in a rig have the same name.
    #[error("two sensors are called `{name}`; give each sensor its own name")]
    NameTaken {
        /// The common name.
        name: String,
    },
    /// An image has another number of pixels than its camera.
    #[error("the depth image has {found} pixels, expected the camera's {} x {}", size.0, size.1)]
    WrongSize {
        /// The number of pixels of the image.
        found: usize,
        /// The columns and rows of the camera.
        size: (usize, usize),
    },
}

fn spaced(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// The checks of one sensor's settings.
pub(super) struct Checks<'a>(pub &'a str);

impl Checks<'_> {
    /// Checks that a value is a number in its range.
    pub fn within(&self, setting: &str, value: f64, range: (f64, f64), unit: &'static str) -> Result<(), SensorError> {
        if (range.0..=range.1).contains(&value) {
            return Ok(());
        }
        Err(SensorError::OutOfRange { sensor: self.0.to_owned(), setting: setting.to_owned(), value, range, unit })
    }

    /// Checks that a count is in its range.
    pub fn counts(&self, setting: &str, count: usize, range: (usize, usize)) -> Result<(), SensorError> {
        self.within(setting, count as f64, (range.0 as f64, range.1 as f64), "")
    }

    /// Checks that this can be the period of a sensor.
    pub fn period(&self, seconds: f64) -> Result<(), SensorError> {
        self.within("period", seconds, (1e-4, 1e4), "s")
    }

    /// Checks that this can be the greatest distance in metres that a sensor measures.
    pub fn range(&self, metres: f64) -> Result<(), SensorError> {
        self.within("range", metres, (0.1, 10_000.0), "m")
    }
}
