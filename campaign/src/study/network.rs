//! A network that drives: which it is, so that a campaign is never continued or replayed with another.

use crate::{Error, Reason};
use paracosm_engine::driver::Driver;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The name of the networks that come with the software, each for its scenarios.
pub(super) const CLONED: &str = "cnn";
/// What the names of files with networks end in.
const ENDING: &str = ".onnx";

/// A network.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Network {
    /// The file that it is in, or the name of one that comes with the software.
    file: String,
    /// The hash of the file: XXH3, 128 bits.
    hash: String,
    #[cfg(feature = "neural")]
    #[serde(skip)]
    model: std::sync::OnceLock<paracosm_neural::Model>,
}

impl PartialEq for Network {
    fn eq(&self, other: &Self) -> bool {
        (&self.file, &self.hash) == (&other.file, &other.hash)
    }
}

/// Why there is no such network.
#[derive(Debug, Error)]
pub enum NetworkFlaw {
    /// This program has no networks.
    #[error(
        "driver `{driver}` is a network, and this program was built without them: build it with \
         `cargo build --release --features neural`"
    )]
    NotBuilt {
        /// The driver.
        driver: String,
    },
    /// The file is another one than it was.
    #[error(
        "the network {file} has the hash {found}, expected {expected}: it is not the one that the campaign was run with"
    )]
    Changed {
        /// The file.
        file: String,
        /// Its hash.
        found: String,
        /// The hash that it had.
        expected: String,
    },
    /// No network was taught for the scenario.
    #[error(
        "no network comes with the software that drives in `{scenario}`: driver `{CLONED}` drives in {}; a network of one's \
         own is --driver MODEL.onnx", known.join(", ")
    )]
    NotTaught {
        /// The scenario.
        scenario: String,
        /// The scenarios for which there is one.
        known: Vec<&'static str>,
    },
    /// No network of that name comes with the software.
    #[error("no network called `{file}` comes with this version of the software")]
    Unknown {
        /// The name.
        file: String,
    },
}

impl Reason for NetworkFlaw {}

/// Whether a driver of this name is a network.
pub(super) fn is_network(driver: &str) -> bool {
    driver == CLONED || driver.to_lowercase().ends_with(ENDING)
}

#[cfg(not(feature = "neural"))]
impl Network {
    /// The network that a driver's name stands for in a scenario.
    pub fn of(driver: &str, _scenario: &str) -> Result<Self, Error> {
        Err(Self::missing(driver))
    }

    /// A driver that does as it says.
    pub fn driver(&self, name: &str) -> Result<Box<dyn Driver>, Error> {
        Err(Self::missing(name))
    }

    fn missing(driver: &str) -> Error {
        Error::unavailable(NetworkFlaw::NotBuilt { driver: driver.to_owned() })
    }
}

#[cfg(feature = "neural")]
impl Network {
    /// The network that a driver's name stands for in a scenario.
    pub fn of(driver: &str, scenario: &str) -> Result<Self, Error> {
        let file = if driver == CLONED { cloned_for(scenario)?.name.to_owned() } else { driver.to_owned() };
        let contents = contents(driver, &file)?;
        let network = Self { file, hash: hash(&contents), model: std::sync::OnceLock::new() };
        let _ = network.model.set(network.read(&contents)?);
        Ok(network)
    }

    /// A driver that does as it says.
    pub fn driver(&self, name: &str) -> Result<Box<dyn Driver>, Error> {
        if self.model.get().is_none() {
            let contents = contents(name, &self.file)?;
            let found = hash(&contents);
            if found != self.hash {
                let (file, expected) = (self.file.clone(), self.hash.clone());
                return Err(NetworkFlaw::Changed { file, found, expected }.into());
            }
            let _ = self.model.set(self.read(&contents)?);
        }
        let model = self.model.get().expect("it was just read").clone();
        Ok(Box::new(paracosm_neural::Pilot::new(model)))
    }

    fn read(&self, contents: &[u8]) -> Result<paracosm_neural::Model, Error> {
        let unfit = |error| Error::in_file(self.file.as_ref(), None, error);
        paracosm_neural::Model::read(contents).map_err(unfit)
    }
}

/// The network that comes with the software for a scenario.
#[cfg(feature = "neural")]
fn cloned_for(scenario: &str) -> Result<paracosm_neural::Cloned, Error> {
    let all = paracosm_neural::CLONED;
    all.iter().find(|network| network.scenarios.contains(&scenario)).copied().ok_or_else(|| {
        let known = all.iter().flat_map(|network| network.scenarios.iter().copied()).collect();
        NetworkFlaw::NotTaught { scenario: scenario.to_owned(), known }.into()
    })
}

#[cfg(feature = "neural")]
fn contents(driver: &str, file: &str) -> Result<std::borrow::Cow<'static, [u8]>, Error> {
    if driver != CLONED {
        return Ok(std::fs::read(file).map_err(Error::io("read", file.as_ref()))?.into());
    }
    let network = paracosm_neural::CLONED.iter().find(|network| network.name == file);
    let missing = || NetworkFlaw::Unknown { file: file.to_owned() };
    Ok(network.ok_or_else(missing)?.contents.into())
}

#[cfg(feature = "neural")]
fn hash(contents: &[u8]) -> String {
    format!("{:032x}", xxhash_rust::xxh3::xxh3_128(contents))
}
