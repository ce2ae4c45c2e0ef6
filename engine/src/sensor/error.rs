//! Why a sensor cannot be.

use thiserror::Error;

/// Why a sensor cannot be as it is described, or cannot be attached.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum SensorError {
    /// A setting out of its range.
    #[error("{sensor}: `{setting}` is {value}{}, expected {} to {}{}", spaced(.unit), range.0, range.1, spaced(.unit))]
    OutOfRange {
        /// The kind of sensor, or the name that it was to be attached by.
        sensor: String,
        /// The setting.
        setting: String,
        /// Its value.
        value: f64,
        /// Least and greatest value.
        range: (f64, f64),
        /// The unit of all of them, empty where there is none.
        unit: &'static str,
    },
    /// A field of view whose lower end is not below its upper one.
    #[error("{sensor}: `lowest` is {lowest} rad, expected less than `highest`, which is {highest} rad")]
    EmptyField {
        /// The kind of sensor.
        sensor: String,
        /// The lower end in radians.
        lowest: f64,
        /// The upper end in radians.
        highest: f64,
    },
    /// Two sensors of one name in a rig.
    #[error("two sensors are called `{name}`")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// An image that does not have as many pixels as its camera.
    #[error("the depth image has {found} pixels, expected {} x {}", size.0, size.1)]
    WrongSize {
        /// The number of its pixels.
        found: usize,
        /// Columns and rows of the camera.
        size: (usize, usize),
    },
}

fn spaced(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// The checks of one sensor's settings.
pub(super) struct Checks<'a>(pub &'a str);

impl Checks<'_> {
    /// Whether a value is in its range, and a number.
    pub fn within(&self, setting: &str, value: f64, range: (f64, f64), unit: &'static str) -> Result<(), SensorError> {
        if (range.0..=range.1).contains(&value) {
            return Ok(());
        }
        Err(SensorError::OutOfRange { sensor: self.0.to_owned(), setting: setting.to_owned(), value, range, unit })
    }

    /// Whether a count is in its range.
    pub fn counts(&self, setting: &str, count: usize, range: (usize, usize)) -> Result<(), SensorError> {
        self.within(setting, count as f64, (range.0 as f64, range.1 as f64), "")
    }

    /// Whether this can be the period of a sensor.
    pub fn period(&self, seconds: f64) -> Result<(), SensorError> {
        self.within("period", seconds, (1e-4, 1e4), "s")
    }

    /// Whether this can be the distance in metres up to which a sensor measures.
    pub fn range(&self, metres: f64) -> Result<(), SensorError> {
        self.within("range", metres, (0.1, 10_000.0), "m")
    }
}
