//! `Temporal`: statements about a whole run.

use super::extent::Extent;
use super::held::Held;
use super::operand::Operand;
use super::stream::Stream;
use crate::error::raised;
use paracosm::engine;
use paracosm::oracles::Interval;
use pyo3::prelude::*;

/// A statement about a run, made of streams of truths by `always`, `eventually`, `never`, `historically`, `once` and `until`, and by `&`, `|`, `~`
/// and `implies`. A comparison of streams keeps its distance to a violation as the robustness.
#[pyclass(frozen, module = "paracosm")]
#[derive(Clone)]
pub struct Temporal {
    pub inner: Held<engine::Temporal>,
    extent: Extent,
}

/// Reads a statement, or a stream of truths, which is a statement about each tick.
///
/// # Errors
/// The object is neither; `place` begins the message.
pub fn statement(found: &Bound<PyAny>, place: &str) -> PyResult<Temporal> {
    if let Ok(temporal) = found.cast::<Temporal>() {
        return Ok(temporal.get().clone());
    }
    let operand = Operand::of(found, place)?;
    Ok(Temporal { inner: Held::new(operand.wire.truths(place)?.into()), extent: operand.extent })
}

impl Temporal {
    /// Makes the statement that a stream of truths is true at a tick.
    ///
    /// # Errors
    /// The stream has values of another type.
    pub fn of_stream(stream: &Stream, place: &str) -> PyResult<Self> {
        Ok(Self { inner: Held::new(stream.wire()?.truths(place)?.into()), extent: stream.extent })
    }

    /// Makes a statement of this statement alone.
    fn made(self, make: impl FnOnce(engine::Temporal) -> engine::Temporal) -> PyResult<Self> {
        let extent = self.extent.next();
        extent.check()?;
        Ok(Self { inner: Held::new(make(self.inner.get()?.clone())), extent })
    }

    /// Makes a statement of two statements.
    fn joined(
        self,
        other: Self,
        join: impl FnOnce(engine::Temporal, engine::Temporal) -> engine::Temporal,
    ) -> PyResult<Self> {
        let extent = self.extent.with(other.extent);
        extent.check()?;
        let (own, other) = (self.inner.get()?.clone(), other.inner.get()?.clone());
        Ok(Self { inner: Held::new(join(own, other)), extent })
    }
}

/// Reads the interval of an operator: `None` for the whole run, or two numbers of seconds.
fn interval(within: Option<Bound<PyAny>>) -> PyResult<Interval> {
    let read = |within: Bound<PyAny>| {
        let found = || within.repr().map(|text| text.to_string()).unwrap_or_default();
        within.extract::<[f64; 2]>().map_err(|_| {
            raised(format!("within is {}, expected a pair of numbers of seconds, such as (0, 5)", found()))
        })
    };
    let within = within.map(read).transpose()?;
    let Some([start, end]) = within else { return Ok((..).into()) };
    if start >= 0.0 && start <= end {
        return Ok((start..=end).into());
    }
    Err(raised(format!("within is ({start}, {end}), expected two numbers of seconds from 0 on, the smaller one first")))
}

#[pymethods]
impl Temporal {
    fn __and__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.clone().joined(statement(other, "`&`")?, engine::Temporal::and)
    }

    fn __rand__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        statement(other, "`&`")?.joined(self.clone(), engine::Temporal::and)
    }

    fn __or__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.clone().joined(statement(other, "`|`")?, engine::Temporal::or)
    }

    fn __ror__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        statement(other, "`|`")?.joined(self.clone(), engine::Temporal::or)
    }

    fn __invert__(&self) -> PyResult<Self> {
        self.clone().made(|holds| !holds)
    }

    fn __bool__(&self) -> PyResult<bool> {
        Err(raised(
            "a statement about a run is neither true nor false before the run: write `&`, `|` and `~` for `and`, `or` and `not`",
        ))
    }

    /// Returns the statement that `other` holds if this statement holds.
    pub fn implies(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.clone().joined(statement(other, "implies")?, engine::Temporal::implies)
    }
}

/// Returns the statement that `holds` holds at every tick; with `within=(0, 5)`, at every tick of the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn always(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    let within = interval(within)?;
    statement(holds, "always")?.made(|holds| holds.always(within))
}

/// Returns the statement that `holds` holds at no tick; with `within=(0, 5)`, at no tick of the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn never(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    let within = interval(within)?;
    statement(holds, "never")?.made(|holds| (!holds).always(within))
}

/// Returns the statement that `holds` holds at some tick; with `within=(0, 5)`, at some tick of the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn eventually(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    let within = interval(within)?;
    statement(holds, "eventually")?.made(|holds| holds.eventually(within))
}

/// Returns the statement that `holds` held at every tick up to now; with `within=(0, 5)`, at every tick of the 5 s before.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn historically(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    let within = interval(within)?;
    statement(holds, "historically")?.made(|holds| holds.historically(within))
}

/// Returns the statement that `holds` held at some tick up to now; with `within=(0, 5)`, at some tick of the 5 s before.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn once(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    let within = interval(within)?;
    statement(holds, "once")?.made(|holds| holds.once(within))
}

/// Returns the statement that `holds` holds until `goal` holds; with `within=(0, 5)`, `goal` holds within the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, goal, *, within = None))]
pub fn until(holds: &Bound<PyAny>, goal: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    let (holds, goal) = (statement(holds, "until")?, statement(goal, "until")?);
    let within = interval(within)?;
    holds.joined(goal, |holds, goal| holds.until(within, goal))
}
