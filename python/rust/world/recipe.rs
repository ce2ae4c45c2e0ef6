//! Objects that are not placed yet. They may stand outside of the function of a scenario, and then each thread makes its own of them.

use super::operand::Operand;
use super::stream::Stream;
use paracosm::engine;
use pyo3::prelude::*;
use std::sync::Arc;

/// The way to make an object of the library.
pub struct Recipe<T> {
    make: Arc<dyn Fn() -> T + Send + Sync>,
    changes: Vec<Change<T>>,
}

/// A change of an object, by a method of Python.
type Change<T> = Arc<dyn Fn(T) -> PyResult<T> + Send + Sync>;

impl<T> Recipe<T> {
    /// Describes an object.
    pub fn new(make: impl Fn() -> T + Send + Sync + 'static) -> Self {
        Self { make: Arc::new(make), changes: Vec::new() }
    }

    /// Describes the object with a change.
    pub fn then(&self, change: impl Fn(T) -> PyResult<T> + Send + Sync + 'static) -> Self {
        let change: Change<T> = Arc::new(change);
        Self { make: Arc::clone(&self.make), changes: self.changes.iter().cloned().chain([change]).collect() }
    }

    /// Makes the object.
    ///
    /// # Errors
    /// A stream of the object belongs to another scenario.
    pub fn make(&self) -> PyResult<T> {
        self.changes.iter().try_fold((self.make)(), |made, change| change(made))
    }
}

/// A number, or a stream of numbers.
#[derive(Clone)]
pub enum Quantity {
    Number(f64),
    Stream(Stream),
}

impl Quantity {
    /// Reads a number or a stream of numbers.
    ///
    /// # Errors
    /// The object is neither; `place` begins the message.
    pub fn of(found: &Bound<PyAny>, place: &str) -> PyResult<Self> {
        // The operand says what is wrong with any object. A number is stored as a number, because a stream would belong to one thread.
        Operand::numbers(found, place)?;
        match found.cast::<Stream>() {
            Ok(stream) => Ok(Self::Stream(stream.get().clone())),
            Err(_) => found.extract().map(Self::Number),
        }
    }

    /// Returns the stream of the library.
    ///
    /// # Errors
    /// The stream belongs to another scenario.
    pub fn stream(&self) -> PyResult<engine::Stream<f64>> {
        match self {
            Self::Number(number) => Ok(engine::Stream::constant(*number)),
            Self::Stream(stream) => stream.wire()?.numbers("a number"),
        }
    }
}
