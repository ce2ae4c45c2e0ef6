//! `Stream`: the handle of values that change from tick to tick. Its methods and operators are in [`super::operators`].

use super::building::Building;
use super::extent::Extent;
use super::forward::Forward;
use super::held::Held;
use super::parameter::Parameter;
use super::wire::Wire;
use crate::error::raised;
use pyo3::prelude::*;

/// The origin of a stream.
pub enum Origin {
    Wire(Wire),
    Parameter(Parameter),
    Forward(Forward),
}

/// A value at each tick: numbers, truths, vectors, or events.
///
/// Operators make other streams: `+ - * /`, comparisons, and `& | ~` for "and", "or" and "not". They are nodes of the graph that a run
/// evaluates, so a test runs no Python code. Only `map`, `filter`, `scan` and `for_each` with a function of Python call it at every tick.
#[pyclass(frozen, module = "paracosm")]
#[derive(Clone)]
pub struct Stream {
    /// The scenario that the stream belongs to; `None` if it belongs to none.
    pub building: Option<Building>,
    pub origin: Held<Origin>,
    pub extent: Extent,
}

impl Stream {
    /// Makes a stream of a scenario.
    pub fn of(building: &Building, wire: impl Into<Wire>) -> Self {
        Self::from_origin(Some(building.clone()), Origin::Wire(wire.into()))
    }

    /// Makes a stream that is made of no other.
    pub fn from_origin(building: Option<Building>, origin: Origin) -> Self {
        Self::sized(building, origin, Extent::ONE)
    }

    /// Makes a stream with an extent.
    pub fn sized(building: Option<Building>, origin: Origin, extent: Extent) -> Self {
        Self { building, origin: Held::new(origin), extent }
    }

    /// Returns the origin.
    ///
    /// # Errors
    /// The stream belongs to the world of another test.
    pub fn origin(&self) -> PyResult<&Origin> {
        self.origin.get()
    }

    /// Returns the stream of the library.
    ///
    /// # Errors
    /// The scenario of the stream is complete, the stream has too many operators, or it is a parameter that cannot be a stream.
    pub fn wire(&self) -> PyResult<Wire> {
        self.building.as_ref().map_or(Ok(()), Building::check)?;
        self.extent.check()?;
        match self.origin()? {
            Origin::Wire(wire) => Ok(wire.clone()),
            Origin::Forward(forward) => Ok(forward.wire()),
            Origin::Parameter(Parameter::Number { parameter, .. }) => {
                // The parameter becomes a stream here, and the scenario may note a mistake.
                let wire = || Wire::Number((**parameter).clone());
                self.building.as_ref().map_or_else(|| Ok(wire()), |building| building.with(|_| wire()))
            }
            Origin::Parameter(Parameter::Word { name, .. }) => Err(raised(format!(
                "the values of the parameter `{name}` are words, so it is no stream: write `{name}.value()` for the word of this test"
            ))),
        }
    }

    /// Makes a stream of the same scenario.
    pub fn made(&self, wire: impl Into<Wire>) -> Self {
        Self::sized(self.building.clone(), Origin::Wire(wire.into()), self.extent.next())
    }
}
