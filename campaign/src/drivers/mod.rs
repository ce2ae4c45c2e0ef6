//! Drivers for one worker: those that come with the engine are made, those in a process of their own are asked for.
//!
//! A driver is kept from one test to the next as long as all goes well. A driver in a process of its own begins a session
//! for it, of which a server can have many. A test that ends in an error with a driver that has a past, or beside other
//! tests, is not held against it: it is run again with a driver that is new, and alone. So a driver whose answers depend on
//! the test alone gives the same trials for any number of workers. A server that somebody else has started cannot be
//! started again, and what its end does to others is outside of that.

mod late;
mod process;

use crate::study::{DriverChoice, Origin};
use crate::{Error, Problem, ProblemKind, Reason};
use late::Late;
use paracosm_engine::driver::Driver;
use paracosm_rpc::{Address, OpenError, Session};
use process::Launcher;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// The drivers of a worker.
pub struct Drivers<'a> {
    source: Source<'a>,
    /// Whether they run in a process of their own.
    external: bool,
    /// Those that have nothing to do.
    idle: Vec<Box<dyn Driver>>,
    stop: Arc<AtomicBool>,
}

/// Where drivers come from.
enum Source<'a> {
    /// Each is made, or asked for at an address.
    Made(Box<Make<'a>>),
    Process(Box<Launcher>),
}

/// Makes a driver.
type Make<'a> = dyn Fn() -> Result<Box<dyn Driver>, NoDriver> + Send + 'a;

/// Why there is no driver for a test.
#[derive(Debug, Error)]
pub enum NoDriver {
    /// It cannot be made.
    #[error(transparent)]
    Made(#[from] Error),
    /// Its process does not offer one.
    #[error(transparent)]
    Away(#[from] DriverAway),
}

/// Why a process offers no driver.
#[derive(Debug, Error)]
pub enum DriverAway {
    /// Its server does not offer one.
    #[error("driver {address}: {source}")]
    Server {
        /// The address of the server.
        address: Address,
        /// What is wrong.
        source: OpenError,
    },
    /// Its command does not start one.
    #[error("driver `{command}`: {problem}")]
    Command {
        /// The command.
        command: String,
        /// What is wrong.
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
    /// What is wrong where a server offers no driver.
    fn unopened(error: &OpenError) -> Self {
        let cause = match error {
            OpenError::Unreachable | OpenError::UnknownHost => ProblemKind::Process,
            OpenError::Foreign | OpenError::Protocol { .. } => ProblemKind::Answer,
            OpenError::Unusable(fault) => ProblemKind::of(fault.kind),
        };
        Self::new(cause, error.to_string())
    }
}

impl<'a> Drivers<'a> {
    /// Drivers as they were chosen, none of which is made or asked for yet. None is waited for any more once `stop` is set.
    ///
    /// # Errors
    /// The choice was read from a file, and there is no such driver or setting.
    pub fn new(choice: &'a DriverChoice, stop: Arc<AtomicBool>) -> Result<Self, Error> {
        let (latency, ended) = (choice.latency(), stop.clone());
        let source = match choice.origin() {
            Origin::Here => {
                let mut drivers = Self::made_by(move || Ok(Box::new(Late { driver: choice.build()?, latency })));
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
                Source::Process(Box::new(Launcher::new(words.clone(), terms.clone(), latency, ended)))
            }
        };
        Ok(Self { source, external: true, idle: Vec::new(), stop })
    }

    /// Drivers in this process.
    pub fn made_by(make: impl Fn() -> Result<Box<dyn Driver>, NoDriver> + Send + 'a) -> Self {
        Self { source: Source::Made(Box::new(make)), external: false, idle: Vec::new(), stop: Arc::default() }
    }

    /// Whether there is one that has nothing to do.
    pub fn any_idle(&self) -> bool {
        !self.idle.is_empty()
    }

    /// A driver that has nothing to do, or a new one.
    ///
    /// # Errors
    /// There is none to be had: nobody listens at its address, say.
    pub fn hire(&mut self) -> Result<Box<dyn Driver>, NoDriver> {
        match (self.idle.pop(), &mut self.source) {
            (Some(driver), _) => Ok(driver),
            (None, Source::Made(make)) => make(),
            (None, Source::Process(launcher)) => launcher.driver(),
        }
    }

    /// Takes back a driver that has nothing to do any more.
    pub fn dismiss(&mut self, driver: Option<Box<dyn Driver>>) {
        self.idle.extend(driver);
    }

    /// Keeps no driver that has a past, if that could make a difference.
    pub fn renew(&mut self) {
        if self.external {
            self.idle.clear();
        }
    }

    /// Whether a test that broke may be run again: it may be the fault of something else than the test.
    pub fn gives_another_chance(&self) -> bool {
        self.external && !self.stop.load(Ordering::Relaxed)
    }
}
