//! Lists of the named scenarios, strategies, drivers, measures, sensors and camera settings, read from their
//! descriptors. `paracosm-fuzz list` and the tables of documents show these lists.

use crate::Catalogue;
use crate::campaign::study::ListedDriver;
use crate::coverage::Measure;
use crate::engine::{Program, sensor};
use crate::generators::Strategy;

/// Lists of the named scenarios, strategies, drivers, measures, sensors and camera settings.
#[derive(Debug, Clone)]
pub struct Lists {
    /// The scenarios of the catalogue.
    pub scenarios: Vec<Program>,
    /// The strategies, which choose tests.
    pub strategies: Vec<Strategy>,
    /// The drivers, which are systems under test.
    pub drivers: Vec<ListedDriver>,
    /// The measures of the coverage of a space by tests.
    pub measures: Vec<Measure>,
    /// The sensors that drivers can use.
    pub sensors: Vec<sensor::Descriptor>,
    /// The settings that a camera can have.
    #[cfg(feature = "camera")]
    pub cameras: Vec<sensor::CameraSetting>,
}

impl Lists {
    /// Returns the lists of the scenarios of a catalogue, and of all strategies and other named parts.
    pub fn of(catalogue: &Catalogue) -> Self {
        Self {
            scenarios: catalogue.programs().to_vec(),
            strategies: Strategy::all().collect(),
            drivers: ListedDriver::all().collect(),
            measures: Measure::all().collect(),
            sensors: sensor::ALL.to_vec(),
            #[cfg(feature = "camera")]
            cameras: crate::render::camera_settings().iter().collect(),
        }
    }
}
