//! The drivers of one worker: drivers of the engine are made here, and drivers in an external process are asked for.
//!
//! A driver is kept from one test to the next as long as all goes well. For a driver in an external process, the worker
//! opens a session; a server can have many sessions. If a test ends in an error with a driver that has run tests
//! before, or that runs beside other tests, the error may not be due to the test. The test therefore runs again, alone
//! and with a driver in a new process. A process with an error drives no further tests. A driver whose answers depend only on the test thus gives the same trials for any number of
//! workers. A server that somebody else started cannot be started again; the effects of its end on other tests are not
//! covered by this rule.

mod late;
mod process;

use crate::study::{DriverChoice, Origin};
use crate::{Doubts, Error, Problem, ProblemKind, Reason, Supervision};
use late::Late;
use paracosm_engine::driver::Driver;
use paracosm_rpc::{Address, OpenError, Session};
use process::Launcher;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// A source of drivers for the tests of a worker, which keeps idle drivers for further tests.
pub struct Drivers<'a> {
    source: Source<'a>,
    /// True if the drivers run in an external process.
    external: bool,
    /// The drivers that are idle.
    idle: Vec<Box<dyn Driver>>,
    stop: Arc<AtomicBool>,
    doubts: Doubts,
}

/// The source of new drivers.
enum Source<'a> {
    /// A function that makes each driver in this process, or asks for a driver at an address.
    Made(Box<Make<'a>>),
    Process(Box<Launcher>),
}

/// A function that makes a driver.
type Make<'a> = dyn Fn() -> Result<Box<dyn Driver>, NoDriver> + Send + 'a;

/// The reason why no driver is available for a test.
#[derive(Debug, Error)]
pub enum NoDriver {
    /// The driver cannot be made.
    #[error(transparent)]
    Made(#[from] Error),
    /// The external process does not offer a driver.
    #[error(transparent)]
    Away(#[from] DriverAway),
}

/// The reason why an external process offers no driver.
#[derive(Debug, Error)]
pub enum DriverAway {
    /// The server does not offer a driver.
    #[error("driver {address}: {source}")]
    Server {
        /// The address of the server.
        address: Address,
        /// The error of the connection to the server.
        source: OpenError,
    },
    /// The command does not start a driver.
    #[error("driver `{command}`: {problem}")]
    Command {
        /// The command that should start the driver.
        command: String,
        /// The problem with the process of the command.
        problem: Problem,
    },
}

impl Reason for DriverAway {}

impl From<NoDriver> for Error {
    fn from(error: NoDriver) -> Self {
        match error {
            NoDriver::Made(error) => error,
            NoDriver::Away(away) => Self::unavailable(away),
        }
    }
}

impl From<NoDriver> for Problem {
    fn from(error: NoDriver) -> Self {
        let message = error.to_string();
        match error {
            NoDriver::Made(_) => Self::new(ProblemKind::Driver, message),
            NoDriver::Away(DriverAway::Server { source, .. }) => Self { message, ..Self::unopened(&source) },
            NoDriver::Away(DriverAway::Command { problem, .. }) => Self { message, ..problem },
        }
    }
}

impl Problem {
    /// Returns the problem of a server that offers no driver.
    fn unopened(error: &OpenError) -> Self {
        let cause = match error {
            OpenError::Unreachable | OpenError::UnknownHost => ProblemKind::Process,
            OpenError::Foreign | OpenError::Protocol { .. } => ProblemKind::Answer,
            OpenError::NotBuilt => ProblemKind::Driver,
            OpenError::Unusable(fault) => ProblemKind::of(fault.kind),
        };
        Self::new(cause, error.to_string())
    }
}

impl<'a> Drivers<'a> {
    /// Makes a source of drivers of the given choice. A first driver of this process is made at once, as a check;
    /// external drivers are not. Once the campaign is stopped, nobody waits for external drivers, and runs end at the next question.
    ///
    /// # Errors
    /// The choice was read from a file, and the driver or a setting of it does not exist.
    pub fn new(choice: &'a DriverChoice, supervision: Supervision) -> Result<Self, Error> {
        let (latency, stop, doubts) = (choice.latency(), supervision.stop.clone(), supervision.doubts.clone());
        let ended = stop.clone();
        let source = match choice.origin() {
            Origin::Here => {
                let made = Self::made_by(move || Ok(Box::new(Late { driver: choice.build()?, latency })));
                let mut drivers = Self { stop, doubts, ..made };
                let first = drivers.hire()?;
                drivers.dismiss(Some(first));
                return Ok(drivers);
            }
            Origin::Server(address, terms) => Source::Made(Box::new(move || {
                let session = Session::open(address, terms, ended.clone());
                let session = session.map_err(|source| DriverAway::Server { address: address.clone(), source })?;
                Ok(Box::new(Late { driver: Box::new(session), latency }))
            })),
            Origin::Process(words, terms) => {
                Source::Process(Box::new(Launcher::new(words.clone(), terms.clone(), latency, supervision)))
            }
        };
        Ok(Self { source, external: true, idle: Vec::new(), stop, doubts })
    }

    /// Makes a source of drivers that the given function makes in this process.
    pub fn made_by(make: impl Fn() -> Result<Box<dyn Driver>, NoDriver> + Send + 'a) -> Self {
        let source = Source::Made(Box::new(make));
        Self { source, external: false, idle: Vec::new(), stop: Arc::default(), doubts: Doubts::default() }
    }

    /// Returns the flag that ends runs and waiting.
    pub fn stop(&self) -> &Arc<AtomicBool> {
        &self.stop
    }

    /// Returns the doubts about the driver.
    pub fn doubts(&self) -> &Doubts {
        &self.doubts
    }

    /// Returns `true` if a driver is idle.
    pub fn any_idle(&self) -> bool {
        !self.idle.is_empty()
    }

    /// Returns an idle driver, or a new driver if no driver is idle.
    ///
    /// # Errors
    /// No driver can be made, for example because nobody listens at its address.
    pub fn hire(&mut self) -> Result<Box<dyn Driver>, NoDriver> {
        match (self.idle.pop(), &mut self.source) {
            (Some(driver), _) => Ok(driver),
            (None, Source::Made(make)) => make(),
            (None, Source::Process(launcher)) => launcher.driver(),
        }
    }

    /// Takes back a driver that has finished a test; `None` after an error, whose process drives no further tests.
    pub fn dismiss(&mut self, driver: Option<Box<dyn Driver>>) {
        match driver {
            Some(driver) => self.idle.push(driver),
            None => self.leave(),
        }
    }

    /// Drops the idle drivers, and lets their process end as soon as no test needs it: the next driver has a new process.
    pub fn leave(&mut self) {
        self.renew();
        if let Source::Process(launcher) = &mut self.source {
            launcher.leave();
        }
    }

    /// Drops the idle drivers if earlier tests could influence the answers of the drivers.
    pub fn renew(&mut self) {
        if self.external {
            self.idle.clear();
        }
    }

    /// Returns `true` if a test that ended in an error may run again with a new driver.
    pub fn gives_another_chance(&self) -> bool {
        self.external && !self.stop.load(Ordering::Relaxed)
    }
}
