//! Stands in for the client in programs that were built without it, so that everything else need not know.

use crate::{Address, OpenError, Terms};
use paracosm_engine::driver::{Driver, Fault};
use paracosm_engine::{Briefing, Control, Observation};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A driver in another process. This program was built without the feature `connect`, so there is none.
pub enum Session {}

impl Session {
    /// Refuses to begin a session.
    ///
    /// # Errors
    /// Always [`OpenError::NotBuilt`].
    pub fn open(_: &Address, _: &Terms, _: Arc<AtomicBool>) -> Result<Self, OpenError> {
        Err(OpenError::NotBuilt)
    }

    /// Returns the name that the driver gives itself.
    pub fn name(&self) -> &str {
        match *self {}
    }

    /// Returns `true` if the driver's server is gone or does not answer.
    pub fn is_lost(&self) -> bool {
        match *self {}
    }
}

impl Driver for Session {
    fn period(&self) -> f64 {
        match *self {}
    }

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        match *self {}
    }

    fn step(&mut self, _: &Observation) -> Result<Control, Fault> {
        match *self {}
    }
}
