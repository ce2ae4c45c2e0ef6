//! Operands of streams: streams, numbers, truths, and pairs of numbers.

use super::building::Building;
use super::extent::Extent;
use super::stream::Stream;
use super::wire::Wire;
use crate::error::raised;
use crate::value::is_truth;
use nalgebra::Vector2;
use paracosm::engine;
use pyo3::prelude::*;
use pyo3::types::PyInt;

/// A value that stands for a stream: a stream, a number, or a truth.
pub struct Operand {
    pub building: Option<Building>,
    pub wire: Wire,
    pub extent: Extent,
}

impl Operand {
    /// Reads a stream, a number, a truth, or a pair of numbers.
    ///
    /// # Errors
    /// The object is none of these; `place` begins the message.
    pub fn of(found: &Bound<PyAny>, place: &str) -> PyResult<Self> {
        if let Ok(stream) = found.cast::<Stream>() {
            let stream = stream.get();
            return Ok(Self { building: stream.building.clone(), wire: stream.wire()?, extent: stream.extent });
        }
        let constant = |wire| Ok(Self { building: None, wire, extent: Extent::ONE });
        if is_truth(found) {
            return constant(Wire::Truth(engine::Stream::constant(found.is_truthy()?)));
        }
        if let Ok(number) = found.extract::<f64>() {
            return constant(Wire::Number(engine::Stream::constant(number)));
        }
        if let Ok([x, y]) = found.extract::<[f64; 2]>() {
            return constant(Wire::Vector(engine::Stream::constant(Vector2::new(x, y))));
        }
        if found.is_instance_of::<PyInt>() {
            return Err(raised(format!("{place}: found an integer that is too large for a number")));
        }
        if found.is_callable() {
            let name = found.getattr("__name__").map(|name| name.to_string()).unwrap_or_default();
            return Err(raised(format!("{place}: found a method, expected what it returns: write `{name}()`")));
        }
        let kind = found.get_type().name()?;
        Err(raised(format!("{place}: found a value of the type {kind}, expected a stream or a number")))
    }

    /// Returns `true` if the object is a stream, or if [`of`](Self::of) makes one of it.
    pub fn is_one(found: &Bound<PyAny>) -> bool {
        found.cast::<Stream>().is_ok() || Self::of(found, "").is_ok()
    }

    /// Reads a stream of numbers, or a number.
    pub fn numbers(found: &Bound<PyAny>, place: &str) -> PyResult<engine::Stream<f64>> {
        Self::of(found, place)?.wire.numbers(place)
    }
}
