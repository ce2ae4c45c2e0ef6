//! `Effect`: a function of Python that a run calls at every tick at which a stream has a value.

use super::building::Building;
use super::called::Called;
use super::stream::Stream;
use super::wire::each;
use pyo3::prelude::*;

/// A call of a function of Python at every tick at which a stream has a value.
#[pyclass(frozen, module = "paracosm")]
pub struct Effect {
    pub stream: Stream,
    pub called: Called,
}

impl Effect {
    /// Places the effect in a scenario.
    ///
    /// # Errors
    /// The stream belongs to a scenario that is complete.
    pub fn place(&self, building: &Building) -> PyResult<()> {
        let called = self.called.clone();
        each!(self.stream.wire()?, stream => building.with(|s| s.place(stream.for_each(move |value| called.told(value)))))
    }
}
