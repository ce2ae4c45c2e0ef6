//! A network that drives: which it is, so that a campaign is never continued or replayed with another.

use crate::Error;
use paracosm_engine::driver::Driver;
use serde::{Deserialize, Serialize};

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
        Error::Usage(format!(
            "driver `{driver}` is a network, and this program was built without them: build it with \
             `cargo build --release --features neural`"
        ))
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
                let Self { file, hash, .. } = self;
                return Err(Error::Usage(format!(
                    "the network {file} has the hash {found}, expected {hash}: it is not the one that the campaign was run with"
                )));
            }
            let _ = self.model.set(self.read(&contents)?);
        }
        let model = self.model.get().expect("it was just read").clone();
        Ok(Box::new(paracosm_neural::Pilot::new(model)))
    }

    fn read(&self, contents: &[u8]) -> Result<paracosm_neural::Model, Error> {
        let unfit = |error: paracosm_neural::ModelError| Error::content(self.file.as_ref(), None, error.to_string());
        paracosm_neural::Model::read(contents).map_err(unfit)
    }
}

/// The network that comes with the software for a scenario.
#[cfg(feature = "neural")]
fn cloned_for(scenario: &str) -> Result<paracosm_neural::Cloned, Error> {
    let all = paracosm_neural::CLONED;
    all.iter().find(|network| network.scenarios.contains(&scenario)).copied().ok_or_else(|| {
        let known: Vec<&str> = all.iter().flat_map(|network| network.scenarios.iter().copied()).collect();
        let known = known.join(", ");
        Error::Usage(format!(
            "no network comes with the software that drives in `{scenario}`: driver `{CLONED}` drives in {known}; a network \
             of one's own is --driver MODEL.onnx"
        ))
    })
}

#[cfg(feature = "neural")]
fn contents(driver: &str, file: &str) -> Result<std::borrow::Cow<'static, [u8]>, Error> {
    if driver != CLONED {
        return Ok(std::fs::read(file).map_err(Error::file("read", file.as_ref()))?.into());
    }
    let network = paracosm_neural::CLONED.iter().find(|network| network.name == file);
    let missing = || Error::Usage(format!("no network called `{file}` comes with this version of the software"));
    Ok(network.ok_or_else(missing)?.contents.into())
}

#[cfg(feature = "neural")]
fn hash(contents: &[u8]) -> String {
    format!("{:032x}", xxhash_rust::xxh3::xxh3_128(contents))
}
