//! Streams that are used before they are defined, by the type of their values.

use super::building::Building;
use super::called::Kind;
use super::wire::Wire;
use nalgebra::Vector2;
use paracosm::engine;
use pyo3::prelude::*;

/// A stream that is announced.
pub enum Forward {
    Number(engine::Forward<f64>),
    Truth(engine::Forward<bool>),
    Vector(engine::Forward<Vector2<f64>>),
}

/// Announces a stream in a scenario.
///
/// # Errors
/// The scenario is complete.
pub fn announced(building: &Building, name: &str, kind: Kind) -> PyResult<Forward> {
    building.with(|scenario| match kind {
        Kind::Number => Forward::Number(scenario.forward(name)),
        Kind::Truth => Forward::Truth(scenario.forward(name)),
        Kind::Vector => Forward::Vector(scenario.forward(name)),
    })
}

impl Forward {
    /// Returns the stream.
    pub fn wire(&self) -> Wire {
        match self {
            Self::Number(forward) => (**forward).clone().into(),
            Self::Truth(forward) => (**forward).clone().into(),
            Self::Vector(forward) => (**forward).clone().into(),
        }
    }

    /// Says what the stream is.
    ///
    /// # Errors
    /// The definition has values of another type.
    pub fn define(&self, definition: Wire) -> PyResult<()> {
        match self {
            Self::Number(forward) => forward.define(definition.numbers("define")?),
            Self::Truth(forward) => forward.define(definition.truths("define")?),
            Self::Vector(forward) => forward.define(definition.vectors("define")?),
        }
        Ok(())
    }
}
