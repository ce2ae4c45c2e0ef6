//! Who drives: a driver that comes with the engine, a network, one in a process of its own, or one that the program brings.

use super::Study;
use super::network::{CLONED, Network, is_network};
use crate::black_box::checked_timeout;
use crate::{Error, process};
use paracosm_coverage::{Record, nearest};
use paracosm_engine::driver::{self, Driver, DriverError, Kind};
use paracosm_rpc::{Address, Terms};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

/// The settings that every driver in a process of its own has, which are not passed on to it as others are. Networks have the
/// first of them.
const LATENCY: &str = "latency";
const SEED: &str = "seed";

/// The longest latency in seconds.
const LONGEST_LATENCY: f64 = 100.0;

/// The greatest whole number up to which every one is a float.
const GREATEST_SEED: f64 = 9_007_199_254_740_992.0;

/// A driver with all its settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DriverChoice {
    /// Its name; of one in a process of its own, the address or the command.
    pub name: String,
    settings: Record<f64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    external: Option<External>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    network: Option<Box<Network>>,
    #[serde(skip)]
    own: Option<Own>,
}

/// How a driver is made that is not in the catalogue.
#[derive(Clone)]
struct Own(Arc<dyn Fn() -> Box<dyn Driver> + Send + Sync>);

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

/// A driver in a process of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct External {
    by: By,
    /// How long it may take to answer, in seconds.
    timeout: f64,
}

/// What the name of a driver in a process of its own is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum By {
    Address,
    Command,
}

/// The driver of that name that comes with the engine.
fn found(name: &str) -> Result<&'static Kind, DriverError> {
    driver::find(name).map_err(|error| match error {
        DriverError::Unknown { name, nearest: None } => {
            let nearest = nearest(&name, [CLONED]);
            DriverError::Unknown { name, nearest }
        }
        error => error,
    })
}

/// Where drivers come from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Origin {
    /// They are made in this process.
    Here,
    /// A server that somebody has started.
    Server(Address, Terms),
    /// A process that is started with these words.
    Process(Vec<String>, Terms),
}

impl DriverChoice {
    fn named(name: &str) -> Self {
        Self { name: name.to_owned(), settings: Record::default(), external: None, network: None, own: None }
    }

    /// The driver of that name in a scenario, or at that address; or a network.
    ///
    /// # Errors
    /// There is no such driver, network or setting, or a value is out of range.
    pub(super) fn new(name: &str, changes: &[(String, f64)], scenario: &str) -> Result<Self, Error> {
        if Address::is_meant(name) {
            return Self::external(name, By::Address, changes);
        }
        if is_network(name) {
            if let Some((setting, _)) = changes.iter().find(|(setting, _)| setting != LATENCY) {
                let message = format!("driver `{name}` is a network and has no setting `{setting}`, only `{LATENCY}`");
                return Err(Error::Usage(message));
            }
            let (network, settings) = (Network::of(name, scenario)?, changes.iter().cloned().collect());
            let choice = Self { settings, network: Some(Box::new(network)), ..Self::named(name) };
            return choice.origin().map(|_| choice);
        }
        let settings = found(name)?.settings(changes)?;
        let settings = settings.iter().map(|(name, value)| (name.to_owned(), value)).collect();
        Ok(Self { settings, ..Self::named(name) })
    }

    fn external(name: &str, by: By, changes: &[(String, f64)]) -> Result<Self, Error> {
        let external = Some(External { by, timeout: checked_timeout(None)? });
        let choice = Self { settings: changes.iter().cloned().collect(), external, ..Self::named(name) };
        choice.origin().map(|_| choice)
    }

    /// A new driver of this kind.
    ///
    /// # Errors
    /// The choice was read from a file and there is no such driver, network or setting; or it is in a process of its own.
    pub fn build(&self) -> Result<Box<dyn Driver>, Error> {
        if let Some(Own(make)) = &self.own {
            return Ok(make());
        }
        if let Some(network) = &self.network {
            return network.driver(&self.name);
        }
        let settings: Vec<_> = self.settings.iter().map(|(name, value)| (name.to_owned(), *value)).collect();
        Ok(driver::find(&self.name)?.build(&settings)?)
    }

    /// Whether it is in a process of its own.
    pub fn is_external(&self) -> bool {
        self.external.is_some()
    }

    /// Seconds from when it is asked to when its answer takes effect, beside what the driver itself makes of time.
    pub fn latency(&self) -> f64 {
        let modelled = self.is_external() || self.network.is_some();
        self.settings.get(LATENCY).copied().filter(|_| modelled).unwrap_or(0.0)
    }

    /// Where it comes from.
    ///
    /// # Errors
    /// It was read from a file and is no address or command, or has a setting out of range.
    pub(crate) fn origin(&self) -> Result<Origin, Error> {
        self.within(LATENCY, (0.0, LONGEST_LATENCY), false)?;
        let Some(External { by, timeout }) = self.external else {
            return Ok(Origin::Here);
        };
        self.within(SEED, (0.0, GREATEST_SEED), true)?;
        if let Some((name, value)) = self.settings.iter().find(|(_, value)| !value.is_finite()) {
            return Err(Error::Usage(format!("driver.{name} is {value}, expected a finite number")));
        }
        let passed_on = self.settings.iter().filter(|(name, _)| ![LATENCY, SEED].contains(name));
        let terms = Terms {
            seed: self.settings.get(SEED).copied().unwrap_or(0.0) as u64,
            settings: passed_on.map(|(name, value)| (name.to_owned(), *value)).collect(),
            timeout: Duration::from_secs_f64(checked_timeout(Some(timeout))?),
        };
        match by {
            By::Address => {
                let address = self.name.parse().map_err(|error| Error::Usage(format!("--driver {error}")))?;
                Ok(Origin::Server(address, terms))
            }
            By::Command => {
                let wrong = |what| Error::Usage(format!("--driver-command '{}': {what}", self.name));
                Ok(Origin::Process(process::words(&self.name).map_err(wrong)?, terms))
            }
        }
    }

    fn within(&self, name: &str, range: (f64, f64), whole: bool) -> Result<(), Error> {
        let wrong = |value: &f64| !(range.0..=range.1).contains(value) || whole && value.fract() != 0.0;
        let Some(value) = self.settings.get(name).filter(|value| wrong(value)) else { return Ok(()) };
        let kind = if whole { "a whole number" } else { "a number" };
        Err(Error::Usage(format!("driver.{name} is {value}, expected {kind} from {} to {}", range.0, range.1)))
    }
}

impl Study {
    /// Tests this driver, its settings changed so; `grpc://HOST:PORT` is one that listens there.
    ///
    /// A driver in a process of its own is told its settings but for two: `latency`, the seconds from when it is asked to
    /// when its answer takes effect, and `seed`, where its chance and the noise of its sensors come from.
    ///
    /// # Errors
    /// There is no such driver or setting, a value is out of range, the study is of no scenario, or a network cannot be
    /// read, is not made for driving, or was not taught for this scenario.
    pub fn driver(mut self, name: &str, changes: &[(String, f64)]) -> Result<Self, Error> {
        let simulation = self.subject.scenario_mut()?;
        simulation.driver = DriverChoice::new(name, changes, &simulation.scenario)?;
        Ok(self)
    }

    /// Tests a driver of one's own, which each worker makes for itself. Only this program can replay its tests.
    ///
    /// # Errors
    /// The study is of no scenario.
    pub fn own_driver(
        mut self,
        name: &str,
        make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        self.subject.scenario_mut()?.driver =
            DriverChoice { own: Some(Own(Arc::new(make))), ..DriverChoice::named(name) };
        Ok(self)
    }

    /// Tests the driver that this command starts, once for each worker. It is told in `PARACOSM_ADDRESS` where to listen, as
    /// HOST:PORT, and ends when its standard input does. Settings are as in [`driver`](Self::driver).
    ///
    /// # Errors
    /// The command is empty or has a quote without an end, a setting is out of range, or the study is of no scenario.
    pub fn driver_command(mut self, command: &str, changes: &[(String, f64)]) -> Result<Self, Error> {
        self.subject.scenario_mut()?.driver = DriverChoice::external(command, By::Command, changes)?;
        Ok(self)
    }

    /// Lets a driver in a process of its own take this many seconds for an answer, and ten times as long to start; without it,
    /// 60.
    ///
    /// # Errors
    /// It is no positive number of seconds, or the driver is in no process of its own.
    pub fn driver_timeout(mut self, seconds: f64) -> Result<Self, Error> {
        let driver = &mut self.subject.scenario_mut()?.driver;
        match &mut driver.external {
            Some(external) => external.timeout = checked_timeout(Some(seconds))?,
            None => {
                let message = "--timeout is for a --system, a --driver-command and a driver at an address";
                return Err(Error::Usage(format!("{message}, and `{}` is none of them", driver.name)));
            }
        }
        Ok(self)
    }
}
