//! `Handle`: something in the world of a scenario.

use super::building::Building;
use super::held::Held;
use super::stream::Stream;
use super::wire::Wire;
use pyo3::prelude::*;

/// Something in the world of a scenario, which can be used while the scenario is built.
pub struct Handle<T: 'static> {
    building: Building,
    inner: Held<T>,
}

impl<T> Handle<T> {
    /// Makes the handle of something in a scenario.
    pub fn new(building: &Building, inner: T) -> Self {
        Self { building: building.clone(), inner: Held::new(inner) }
    }

    /// Calls a function with the object. A mistake that the scenario notes is raised.
    ///
    /// # Errors
    /// The scenario has noted a mistake, or it is complete.
    pub fn with<R>(&self, act: impl FnOnce(&T) -> R) -> PyResult<R> {
        self.building.with(|_| self.inner.get().map(act))?
    }

    /// Derives another object of the same scenario.
    ///
    /// # Errors
    /// As [`with`](Self::with).
    pub fn made<U>(&self, make: impl FnOnce(&T) -> U) -> PyResult<Handle<U>> {
        Ok(Handle::new(&self.building, self.with(make)?))
    }

    /// Derives a stream of the same scenario.
    ///
    /// # Errors
    /// As [`with`](Self::with).
    pub fn stream<W: Into<Wire>>(&self, make: impl FnOnce(&T) -> W) -> PyResult<Stream> {
        Ok(Stream::of(&self.building, self.with(make)?))
    }
}
