//! Networks as drivers, with the hash of their files, so that a campaign never continues or replays with another
//! network.

#[cfg(feature = "neural")]
use crate::executor::WORKER;
use crate::{Error, Reason};
use paracosm_engine::driver::Driver;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The name of the networks that come with the software, each for its scenarios.
pub(super) const CLONED: &str = "cnn";
/// The ending of the names of network files.
const ENDING: &str = ".onnx";

/// A network that drives.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Network {
    /// The file of the network, or the name of a network that comes with the software.
    file: String,
    /// The hash of the file, which is the 128-bit XXH3.
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

/// The reason why a neural network cannot be used as a driver.
#[derive(Debug, Error)]
pub enum NetworkFlaw {
    /// The program was built without neural networks.
    #[error(
        "driver `{driver}` is a network, but this program was built without networks: build it with \
         `cargo build --release --features neural`"
    )]
    NotBuilt {
        /// The name of the driver.
        driver: String,
    },
    /// The file of the network has changed since the campaign was run.
    #[error("the network {file} has the hash {found}, expected {expected}: the campaign was run with another network")]
    Changed {
        /// The path of the network's file, or the name of a network that comes with the software.
        file: String,
        /// The present hash of the file.
        found: String,
        /// The hash of the file when the campaign was run.
        expected: String,
    },
    /// The file of the network is a folder, a device or a pipe.
    #[error("{file} is no regular file, expected the file of a network")]
    NoFile {
        /// The path of the network's file.
        file: String,
    },
    /// No network that comes with the software was trained for the scenario.
    #[error(
        "no network comes with the software that drives in `{scenario}`: driver `{CLONED}` drives in {}; a network of your \
         own is --driver MODEL.onnx", known.join(", ")
    )]
    NotTaught {
        /// The name of the scenario.
        scenario: String,
        /// The names of the scenarios for which a network exists.
        known: Vec<&'static str>,
    },
    /// No network with the given name comes with the software.
    #[error("no network called `{file}` comes with this version of the software")]
    Unknown {
        /// The name that no network has.
        file: String,
    },
}

impl Reason for NetworkFlaw {}

/// Returns `true` if a driver's name is that of a network.
pub(super) fn is_network(driver: &str) -> bool {
    driver == CLONED || driver.to_lowercase().ends_with(ENDING)
}

#[cfg(not(feature = "neural"))]
impl Network {
    /// Returns the error that the program was built without neural networks.
    pub fn of(driver: &str, _scenario: &str) -> Result<Self, Error> {
        Err(Self::missing(driver))
    }

    /// Returns the error that the program was built without neural networks.
    pub fn driver(&self, name: &str) -> Result<Box<dyn Driver>, Error> {
        Err(Self::missing(name))
    }

    fn missing(driver: &str) -> Error {
        Error::unavailable(NetworkFlaw::NotBuilt { driver: driver.to_owned() })
    }
}

#[cfg(feature = "neural")]
impl Network {
    /// Reads the network for a driver's name, which is a file or a network that comes with the software.
    pub fn of(driver: &str, scenario: &str) -> Result<Self, Error> {
        let file = if driver == CLONED { cloned_for(scenario)?.name.to_owned() } else { driver.to_owned() };
        let contents = contents_of(driver, &file)?;
        let network = Self { file, hash: hash(&contents), model: std::sync::OnceLock::new() };
        let _ = network.model.set(network.read(&contents)?);
        Ok(network)
    }

    /// Makes a driver that the network controls.
    pub fn driver(&self, name: &str) -> Result<Box<dyn Driver>, Error> {
        if self.model.get().is_none() {
            let contents = contents_of(name, &self.file)?;
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
        in_worker(&self.file, || paracosm_neural::Model::read(contents))
    }
}

/// Reads a network in a thread in which a panic of the library that reads networks is not printed.
#[cfg(feature = "neural")]
pub(super) fn in_worker<T: Send>(
    file: &str,
    read: impl FnOnce() -> Result<T, paracosm_neural::ModelError> + Send,
) -> Result<T, Error> {
    let thread = std::thread::Builder::new().name(WORKER.to_owned());
    let read = std::thread::scope(|scope| thread.spawn_scoped(scope, read).map(std::thread::ScopedJoinHandle::join));
    match read.map_err(Error::io("read", file.as_ref()))? {
        Ok(read) => read.map_err(|error| Error::in_file(file.as_ref(), None, error)),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// Returns the network that comes with the software for a scenario.
#[cfg(feature = "neural")]
fn cloned_for(scenario: &str) -> Result<paracosm_neural::Cloned, Error> {
    let all = paracosm_neural::CLONED;
    all.iter().find(|network| network.scenarios.contains(&scenario)).copied().ok_or_else(|| {
        let known = all.iter().flat_map(|network| network.scenarios.iter().copied()).collect();
        NetworkFlaw::NotTaught { scenario: scenario.to_owned(), known }.into()
    })
}

#[cfg(feature = "neural")]
fn contents_of(driver: &str, file: &str) -> Result<std::borrow::Cow<'static, [u8]>, Error> {
    if driver != CLONED {
        return contents(file).map(Into::into);
    }
    let network = paracosm_neural::CLONED.iter().find(|network| network.name == file);
    let missing = || NetworkFlaw::Unknown { file: file.to_owned() };
    Ok(network.ok_or_else(missing)?.contents.into())
}

/// Reads the file of a network.
#[cfg(feature = "neural")]
pub(super) fn contents(file: &str) -> Result<Vec<u8>, Error> {
    let there = std::fs::metadata(file).map_err(Error::io("read", file.as_ref()))?;
    if !there.is_file() {
        return Err(NetworkFlaw::NoFile { file: file.to_owned() }.into());
    }
    // A file that is too large is refused before it is read.
    if there.len() > (paracosm_neural::MOST_MEBIBYTES as u64) << 20 {
        let error = paracosm_neural::ModelError::from(paracosm_neural::Limit::Size);
        return Err(Error::in_file(file.as_ref(), None, error));
    }
    std::fs::read(file).map_err(Error::io("read", file.as_ref()))
}

#[cfg(feature = "neural")]
pub(super) fn hash(contents: &[u8]) -> String {
    format!("{:032x}", xxhash_rust::xxh3::xxh3_128(contents))
}
