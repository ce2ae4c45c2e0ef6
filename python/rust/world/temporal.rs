//! `Temporal`: statements about a whole run.

use super::operand::Operand;
use crate::error::raised;
use paracosm::engine;
use paracosm::oracles::Interval;
use pyo3::prelude::*;

/// A statement about a run, made of streams of truths by `always`, `eventually`, `never`, `historically`, `once` and `until`, and by `&`, `|`, `~`
/// and `implies`. A comparison of streams keeps its distance to a violation as the robustness.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Temporal {
    pub inner: engine::Temporal,
}

/// Reads a statement, or a stream of truths, which is a statement about each tick.
///
/// # Errors
/// The object is neither; `place` begins the message.
pub fn statement(found: &Bound<PyAny>, place: &str) -> PyResult<engine::Temporal> {
    match found.cast::<Temporal>() {
        Ok(temporal) => Ok(temporal.try_borrow()?.inner.clone()),
        Err(_) => Ok(Operand::of(found, place)?.wire.truths(place)?.into()),
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
        Ok(Self { inner: self.inner.clone().and(statement(other, "`&`")?) })
    }

    fn __rand__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        Ok(Self { inner: statement(other, "`&`")?.and(self.inner.clone()) })
    }

    fn __or__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        Ok(Self { inner: self.inner.clone().or(statement(other, "`|`")?) })
    }

    fn __ror__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        Ok(Self { inner: statement(other, "`|`")?.or(self.inner.clone()) })
    }

    fn __invert__(&self) -> Self {
        Self { inner: !self.inner.clone() }
    }

    fn __bool__(&self) -> PyResult<bool> {
        Err(raised(
            "a statement about a run is neither true nor false before the run: write `&`, `|` and `~` for `and`, `or` and `not`",
        ))
    }

    /// Returns the statement that `other` holds if this statement holds.
    fn implies(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        Ok(Self { inner: self.inner.clone().implies(statement(other, "implies")?) })
    }
}

/// Returns the statement that `holds` holds at every tick; with `within=(0, 5)`, at every tick of the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn always(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    Ok(Temporal { inner: statement(holds, "always")?.always(interval(within)?) })
}

/// Returns the statement that `holds` holds at no tick; with `within=(0, 5)`, at no tick of the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn never(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    Ok(Temporal { inner: (!statement(holds, "never")?).always(interval(within)?) })
}

/// Returns the statement that `holds` holds at some tick; with `within=(0, 5)`, at some tick of the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn eventually(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    Ok(Temporal { inner: statement(holds, "eventually")?.eventually(interval(within)?) })
}

/// Returns the statement that `holds` held at every tick up to now; with `within=(0, 5)`, at every tick of the 5 s before.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn historically(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    Ok(Temporal { inner: statement(holds, "historically")?.historically(interval(within)?) })
}

/// Returns the statement that `holds` held at some tick up to now; with `within=(0, 5)`, at some tick of the 5 s before.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn once(holds: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    Ok(Temporal { inner: statement(holds, "once")?.once(interval(within)?) })
}

/// Returns the statement that `holds` holds until `goal` holds; with `within=(0, 5)`, `goal` holds within the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, goal, *, within = None))]
pub fn until(holds: &Bound<PyAny>, goal: &Bound<PyAny>, within: Option<Bound<PyAny>>) -> PyResult<Temporal> {
    let (holds, goal) = (statement(holds, "until")?, statement(goal, "until")?);
    Ok(Temporal { inner: holds.until(interval(within)?, goal) })
}
