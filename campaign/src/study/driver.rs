//! The choice of the driver: a driver of the engine, a network, a driver in an external process, or a driver of the
//! program.

use super::listed::{LATENCY, SEED};
use super::network::{CLONED, Network, is_network};
use crate::black_box::{TimeoutFlaw, checked_timeout};
use crate::process::{self, CommandFlaw};
use crate::{Error, Reason};
use paracosm_engine::driver::{self, Descriptor, Driver, DriverError, Setting};
use paracosm_rpc::{Address, AddressError, CONNECTS, OpenError, Terms};
use paracosm_space::{Record, did_you_mean, nearest};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use thiserror::Error;

/// The default driver.
const USUAL: &str = "aeb";

/// The choice of the driver under test, with the settings of the driver.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub struct DriverChoice {
    name: String,
    settings: Record<f64>,
    source: Source,
}

/// The way in which a driver is made.
#[derive(Debug, Clone, PartialEq)]
enum Source {
    /// The engine makes the driver, if it knows the name.
    Engine,
    Network(Box<Network>),
    External(External),
    Own(Own),
}

/// A driver in an external process.
#[derive(Debug, Clone, PartialEq)]
struct External {
    by: By,
    /// The time that the driver may take to answer, in seconds.
    timeout: f64,
    origin: Origin,
}

/// The origin of drivers, which is this process, a server or an external process.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// Drivers are made in this process.
    Here,
    /// A server at an address offers drivers.
    Server(Address, Terms),
    /// A process that a command starts offers drivers.
    Process(Vec<String>, Terms),
}

/// A driver in the form of campaign.json.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a driver with its settings")]
struct Written {
    name: String,
    settings: Record<f64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    external: Option<WrittenExternal>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    network: Option<Box<Network>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the origin of a driver with its time-out")]
struct WrittenExternal {
    by: By,
    timeout: f64,
}

/// The meaning of the name of a driver in an external process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum By {
    Address,
    Command,
}

/// A function of the program that makes a driver.
#[derive(Clone)]
pub(super) struct Own(Arc<dyn Fn() -> Box<dyn Driver> + Send + Sync>);

impl fmt::Debug for Own {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Own")
    }
}

impl PartialEq for Own {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// A driver that the user asked for.
#[derive(Debug, Clone)]
pub(super) enum Wish {
    /// The name of a listed driver, the file of a neural network, or the address of a server.
    Name(String),
    /// The command that starts the driver.
    Command(String),
    /// The name of a driver, and the function of the program that makes the driver.
    Own(String, Own),
}

impl Wish {
    pub fn own(name: &str, make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static) -> Self {
        Self::Own(name.to_owned(), Own(Arc::new(make)))
    }
}

/// The reason why a driver cannot be chosen or made.
#[derive(Debug, Error)]
pub enum DriverFlaw {
    /// No driver has the requested name.
    #[error("no driver is called `{name}`{}; `paracosm-fuzz list` shows all drivers", did_you_mean(.nearest))]
    Unknown {
        /// The name that no driver has.
        name: String,
        /// The most similar name of a driver; `None` if no name is similar.
        nearest: Option<&'static str>,
    },
    /// The driver of a study of a file was made by the program that ran the campaign.
    #[error(
        "no driver is called `{name}`: the program that ran the campaign made this driver, so give the driver again (in Python \
         `load(folder, driver=..)`)"
    )]
    NotHere {
        /// The name of the driver.
        name: String,
    },
    /// A driver should take the place of another driver in a study.
    #[error("found the driver `{found}`, expected `{expected}`, which drove in the campaign")]
    Another {
        /// The name of the given driver.
        found: String,
        /// The name of the driver of the study.
        expected: String,
    },
    /// The driver under test should be its own reference.
    #[error("--reference {name}: the driver under test avoids none of its own failures; name another driver")]
    OwnReference {
        /// The name of the driver.
        name: String,
    },
    /// A driver of the user's own has the name of a driver that comes with the software.
    #[error("a driver is called `{name}` already: give your driver another name")]
    Taken {
        /// The name.
        name: String,
    },
    /// The given name of the driver is the name of a file. A command has to start such a driver.
    #[error(
        "no driver is called `{name}`, which is the name of a file: --driver-command starts a driver of your own, for example \
         --driver-command {}", shell_words::quote(.command)
    )]
    File {
        /// The name of the file.
        name: String,
        /// A command that may start the driver.
        command: String,
    },
    /// The driver has no setting with the given name, or the value of the setting is out of range.
    #[error("{0}; `paracosm-fuzz list` shows all drivers with their settings")]
    Setting(DriverError),
    /// A driver that is a neural network was given a setting other than `latency`.
    #[error("driver `{driver}` is a network and has no setting `{setting}`, only `{}`", LATENCY.name)]
    NetworkSetting {
        /// The name of the driver.
        driver: String,
        /// The name of the setting.
        setting: String,
    },
    /// The file of a study names a network without its entry.
    #[error("driver `{driver}` is a network, but the entry `network` is missing")]
    NoNetwork {
        /// The name of the driver.
        driver: String,
    },
    /// A setting of a driver in an external process is out of range.
    #[error(
        "driver.{setting} is {value}, expected {} from {} to {}",
        if *whole { "a whole number" } else { "a number" }, range.0, range.1
    )]
    OutOfRange {
        /// The name of the setting.
        setting: &'static str,
        /// The value of the setting.
        value: f64,
        /// The least and the greatest allowed value of the setting.
        range: (f64, f64),
        /// True if the value of the setting has to be a whole number.
        whole: bool,
    },
    /// A setting of a driver in an external process is not a finite number.
    #[error("driver.{setting} is {value}, expected a finite number")]
    NotFinite {
        /// The name of the setting.
        setting: String,
        /// The value of the setting.
        value: f64,
    },
    /// The address of the driver's server is invalid.
    #[error("--driver {0}")]
    Address(AddressError),
    /// The command that should start the driver is invalid.
    #[error("--driver-command '{command}': {flaw}")]
    Command {
        /// The command that should start the driver.
        command: String,
        /// The error in the command.
        flaw: CommandFlaw,
    },
    /// The program was built without drivers in external processes.
    #[error("driver `{driver}` runs in a process of its own: {}", OpenError::NotBuilt)]
    NotBuilt {
        /// The address or the command of the driver.
        driver: String,
    },
    /// The time-out of the driver is out of range.
    #[error(transparent)]
    Timeout(#[from] TimeoutFlaw),
    /// The driver is in an external process, and cannot be made in this process.
    #[error("driver `{driver}` runs in a process of its own, and cannot be made in this process")]
    InAProcess {
        /// The address or the command of the driver.
        driver: String,
    },
    /// A time-out was given for a driver that is not in an external process.
    #[error("--timeout applies to a --system, a --driver-command or a driver at an address, but not to `{driver}`")]
    NoTimeout {
        /// The name of the driver.
        driver: String,
    },
}

impl Reason for DriverFlaw {}

impl From<DriverError> for DriverFlaw {
    fn from(error: DriverError) -> Self {
        match error {
            DriverError::Unknown { name, nearest: None } if name.ends_with(".py") || Path::new(&name).is_file() => {
                let command = if name.ends_with(".py") { format!("python3 {name}") } else { format!("./{name}") };
                Self::File { name, command }
            }
            DriverError::Unknown { name, nearest: None } => {
                let nearest = nearest(&name, [CLONED]);
                Self::Unknown { name, nearest }
            }
            DriverError::Unknown { name, nearest } => Self::Unknown { name, nearest },
            error => Self::Setting(error),
        }
    }
}

impl DriverChoice {
    /// Returns the default driver.
    pub(super) fn usual() -> Self {
        Self::in_engine(USUAL, &[]).expect("it comes with the engine")
    }

    /// Returns the driver that the user asked for, in a scenario, with changed settings and a time-out.
    pub(super) fn new(
        wish: &Wish,
        changes: &[(String, f64)],
        timeout: Option<f64>,
        scenario: &str,
    ) -> Result<Self, Error> {
        let choice = match wish {
            Wish::Own(name, _) if driver::find(name).is_ok() => {
                return Err(DriverFlaw::Taken { name: name.clone() }.into());
            }
            Wish::Own(name, own) => {
                let settings = Self::checked(changes.iter().cloned().collect())?;
                Self { name: name.clone(), settings, source: Source::Own(own.clone()) }
            }
            Wish::Command(command) => Self::external(command, By::Command, changes.iter().cloned().collect(), timeout)?,
            Wish::Name(name) if Address::is_meant(name) => {
                Self::external(name, By::Address, changes.iter().cloned().collect(), timeout)?
            }
            Wish::Name(name) if is_network(name) => Self::network(name, changes, scenario)?,
            Wish::Name(name) => Self::in_engine(name, changes)?,
        };
        match timeout {
            _ if choice.is_external() && !CONNECTS => {
                Err(Error::unavailable(DriverFlaw::NotBuilt { driver: choice.name }))
            }
            Some(_) if !choice.is_external() => Err(DriverFlaw::NoTimeout { driver: choice.name }.into()),
            _ => Ok(choice),
        }
    }

    fn in_engine(name: &str, changes: &[(String, f64)]) -> Result<Self, DriverFlaw> {
        let settings = driver::find(name)?.settings(changes)?;
        let settings = settings.iter().map(|(name, value)| (name.to_owned(), value)).collect();
        Ok(Self { name: name.to_owned(), settings, source: Source::Engine })
    }

    fn network(name: &str, changes: &[(String, f64)], scenario: &str) -> Result<Self, Error> {
        if let Some((setting, _)) = changes.iter().find(|(setting, _)| setting != LATENCY.name) {
            let (driver, setting) = (name.to_owned(), setting.clone());
            return Err(DriverFlaw::NetworkSetting { driver, setting }.into());
        }
        let settings: Record<f64> = changes.iter().cloned().collect();
        within(&settings, &LATENCY)?;
        let source = Source::Network(Box::new(Network::of(name, scenario)?));
        Ok(Self { name: name.to_owned(), settings, source })
    }

    /// Checks the settings of a driver that does not say which settings it has.
    fn checked(settings: Record<f64>) -> Result<Record<f64>, DriverFlaw> {
        within(&settings, &LATENCY)?;
        within(&settings, &SEED)?;
        if let Some((name, value)) = settings.iter().find(|(_, value)| !value.is_finite()) {
            return Err(DriverFlaw::NotFinite { setting: name.to_owned(), value: *value });
        }
        Ok(settings)
    }

    fn external(name: &str, by: By, settings: Record<f64>, timeout: Option<f64>) -> Result<Self, DriverFlaw> {
        let settings = Self::checked(settings)?;
        let timeout = checked_timeout(timeout)?;
        let passed_on = settings.iter().filter(|(name, _)| ![LATENCY.name, SEED.name].contains(name));
        let terms = Terms {
            seed: settings.get(SEED.name).copied().unwrap_or(0.0) as u64,
            settings: passed_on.map(|(name, value)| (name.to_owned(), *value)).collect(),
            timeout: Duration::from_secs_f64(timeout),
        };
        let origin = match by {
            By::Address => Origin::Server(name.parse().map_err(DriverFlaw::Address)?, terms),
            By::Command => {
                let wrong = |flaw| DriverFlaw::Command { command: name.to_owned(), flaw };
                Origin::Process(process::words(name).map_err(wrong)?, terms)
            }
        };
        Ok(Self { name: name.to_owned(), settings, source: Source::External(External { by, timeout, origin }) })
    }

    /// Returns the choice with another command in place of the command that starts the driver.
    pub(super) fn with_command(&self, command: &str) -> Result<Self, DriverFlaw> {
        let timeout = match &self.source {
            Source::External(external) => Some(external.timeout),
            _ => None,
        };
        Self::external(command, By::Command, self.settings.clone(), timeout)
    }

    /// Returns the choice with the function that makes the driver, which a file does not have.
    pub(super) fn made_by(
        &self,
        name: &str,
        make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static,
    ) -> Result<Self, DriverFlaw> {
        if name != self.name {
            return Err(DriverFlaw::Another { found: name.to_owned(), expected: self.name.clone() });
        }
        Ok(Self { source: Source::Own(Own(Arc::new(make))), ..self.clone() })
    }

    /// Returns the name of the driver, or the address or the command of a driver in an external process.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Makes a new instance of the chosen driver.
    ///
    /// # Errors
    /// The choice was read from a file, and the driver, network or setting does not exist; or the driver is in an
    /// external process.
    pub fn build(&self) -> Result<Box<dyn Driver>, Error> {
        match &self.source {
            Source::Own(Own(make)) => Ok(make()),
            Source::Network(network) => network.driver(&self.name),
            Source::Engine => {
                let built = driver::find(&self.name).and_then(|found: &Descriptor| found.build(&self.changes()));
                Ok(built.map_err(|error| match DriverFlaw::from(error) {
                    // Only a study of a file can have such a driver.
                    DriverFlaw::Unknown { name, nearest: None } => DriverFlaw::NotHere { name },
                    flaw => flaw,
                })?)
            }
            Source::External(_) => Err(DriverFlaw::InAProcess { driver: self.name.clone() }.into()),
        }
    }

    /// Checks the settings of a choice that was read from a file, if the driver comes with the engine.
    pub(super) fn check(&self) -> Result<(), DriverFlaw> {
        let Ok(found) = driver::find(&self.name) else { return Ok(()) };
        if matches!(self.source, Source::Engine) {
            found.settings(&self.changes())?;
        }
        Ok(())
    }

    /// Returns the settings that were changed, or that were given for a driver that is not of the engine.
    pub fn changes(&self) -> Vec<(String, f64)> {
        self.settings.iter().map(|(name, value)| (name.to_owned(), *value)).collect()
    }

    /// Returns the command that starts the driver; `None` if no command starts it.
    pub fn command(&self) -> Option<&str> {
        matches!(self.origin(), Origin::Process(..)).then_some(&self.name)
    }

    /// Returns the address of the driver; `None` if the driver does not run already.
    pub fn address(&self) -> Option<&str> {
        (self.is_external() && self.command().is_none()).then_some(&self.name)
    }

    /// Returns `true` if the driver is in an external process.
    pub fn is_external(&self) -> bool {
        matches!(self.source, Source::External(_))
    }

    /// Returns the latency that the settings add to the driver, in seconds from a question until the answer takes
    /// effect. The delays that the driver itself models are not included.
    pub fn latency(&self) -> f64 {
        let modelled = !matches!(self.source, Source::Engine);
        self.settings.get(LATENCY.name).copied().filter(|_| modelled).unwrap_or(0.0)
    }

    /// Returns the origin of the driver, which is this process, a server or an external process.
    pub fn origin(&self) -> &Origin {
        match &self.source {
            Source::External(external) => &external.origin,
            _ => &Origin::Here,
        }
    }
}

fn within(settings: &Record<f64>, setting: &Setting) -> Result<(), DriverFlaw> {
    let Setting { name, range, whole, .. } = *setting;
    let wrong = |value: &f64| !(range.0..=range.1).contains(value) || whole && value.fract() != 0.0;
    match settings.get(name).filter(|value| wrong(value)) {
        Some(&value) => Err(DriverFlaw::OutOfRange { setting: name, value, range, whole }),
        None => Ok(()),
    }
}

impl TryFrom<Written> for DriverChoice {
    type Error = DriverFlaw;

    fn try_from(written: Written) -> Result<Self, DriverFlaw> {
        let Written { name, settings, external, network } = written;
        match (external, network) {
            (Some(WrittenExternal { by, timeout }), _) => Self::external(&name, by, settings, Some(timeout)),
            (None, Some(network)) => {
                within(&settings, &LATENCY)?;
                Ok(Self { name, settings, source: Source::Network(network) })
            }
            (None, None) if is_network(&name) => Err(DriverFlaw::NoNetwork { driver: name }),
            (None, None) => Ok(Self { name, settings, source: Source::Engine }),
        }
    }
}

impl From<DriverChoice> for Written {
    fn from(choice: DriverChoice) -> Self {
        let (external, network) = match choice.source {
            Source::Engine | Source::Own(_) => (None, None),
            Source::Network(network) => (None, Some(network)),
            Source::External(External { by, timeout, .. }) => (Some(WrittenExternal { by, timeout }), None),
        };
        Self { name: choice.name, settings: choice.settings, external, network }
    }
}
