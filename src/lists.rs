//! Everything that can be chosen by name, read from the descriptors: behind `paracosm-fuzz list`, and behind the tables that
//! documents have.

use crate::campaign::study::ListedDriver;
use crate::coverage::Measure;
use crate::engine::{Program, sensor};
use crate::generators::Strategy;
use crate::scenarios;

/// Everything that can be chosen by name.
#[derive(Debug, Clone)]
pub struct Lists {
    /// The scenarios of the catalogue.
    pub scenarios: Vec<Program>,
    /// How tests are chosen.
    pub strategies: Vec<Strategy>,
    /// The systems under test that can be driven with.
    pub drivers: Vec<ListedDriver>,
    /// How well tests cover a space.
    pub measures: Vec<Measure>,
    /// What a driver can perceive with.
    pub sensors: Vec<sensor::Descriptor>,
    /// The numbers that describe a camera.
    #[cfg(feature = "camera")]
    pub cameras: Vec<sensor::CameraSetting>,
}

impl Lists {
    /// All that comes with the software.
    pub fn of_this_software() -> Self {
        Self {
            scenarios: scenarios::ALL.iter().copied().cloned().collect(),
            strategies: Strategy::all().collect(),
            drivers: ListedDriver::all().collect(),
            measures: Measure::all().collect(),
            sensors: sensor::ALL.to_vec(),
            #[cfg(feature = "camera")]
            cameras: crate::render::camera_settings().iter().collect(),
        }
    }
}
