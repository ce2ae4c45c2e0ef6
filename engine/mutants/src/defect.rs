//! A defect: a kind with a size.

use crate::acting::brakes::WEAK_BRAKES;
use crate::error::DefectError;
use crate::kind::Kind;
use crate::kinds::find;
use paracosm_engine::driver::Driver;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A defect of a driver or of its sensors, with a size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Entry", into = "Entry")]
pub struct Defect {
    kind: &'static Kind,
    size: f64,
}

/// The defect of a driver that never brakes: `weak-brakes` of 100 %.
pub const NO_BRAKES: Defect = Defect { kind: &WEAK_BRAKES, size: 100.0 };

impl Defect {
    /// Makes a defect of the kind with the given name.
    ///
    /// # Errors
    /// No kind has the name, or the size is not in the range of the kind.
    pub fn new(kind: &str, size: f64) -> Result<Self, DefectError> {
        let kind = find(kind)?;
        let range = kind.range();
        if !(range.0..=range.1).contains(&size) {
            return Err(DefectError::OutOfRange { kind: kind.name, size, range, unit: kind.unit });
        }
        Ok(Self { kind, size })
    }

    /// Returns the defects of a kind with the sizes of its ladder, from slight to gross.
    pub fn all_of(kind: &'static Kind) -> impl Iterator<Item = Self> {
        kind.sizes.iter().map(move |&size| Self { kind, size })
    }

    /// Returns the kind of the defect.
    pub fn kind(&self) -> &'static Kind {
        self.kind
    }

    /// Returns the size of the defect, in the unit of the kind.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Puts the defect into a driver.
    pub fn in_driver(&self, driver: Box<dyn Driver>) -> Box<dyn Driver> {
        (self.kind.make)(self.size, driver)
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.kind.name, self.size, self.kind.unit)
    }
}

/// A defect as it is written in a file. It is not checked yet.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    kind: String,
    size: f64,
}

impl TryFrom<Entry> for Defect {
    type Error = DefectError;

    fn try_from(entry: Entry) -> Result<Self, DefectError> {
        Self::new(&entry.kind, entry.size)
    }
}

impl From<Defect> for Entry {
    fn from(defect: Defect) -> Self {
        Self { kind: defect.kind.name.to_owned(), size: defect.size }
    }
}
