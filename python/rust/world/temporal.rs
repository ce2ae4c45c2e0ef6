//! `Temporal`: statements about a whole run; and `Monitor`: usual requirements of drives.

use super::ego::Car;
use super::wire::Operand;
use crate::error::raised;
use paracosm::engine::{self, Monitor as Stated};
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
fn interval(within: Option<[f64; 2]>) -> PyResult<Interval> {
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
pub fn always(holds: &Bound<PyAny>, within: Option<[f64; 2]>) -> PyResult<Temporal> {
    Ok(Temporal { inner: statement(holds, "always")?.always(interval(within)?) })
}

/// Returns the statement that `holds` holds at no tick; with `within=(0, 5)`, at no tick of the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn never(holds: &Bound<PyAny>, within: Option<[f64; 2]>) -> PyResult<Temporal> {
    Ok(Temporal { inner: (!statement(holds, "never")?).always(interval(within)?) })
}

/// Returns the statement that `holds` holds at some tick; with `within=(0, 5)`, at some tick of the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn eventually(holds: &Bound<PyAny>, within: Option<[f64; 2]>) -> PyResult<Temporal> {
    Ok(Temporal { inner: statement(holds, "eventually")?.eventually(interval(within)?) })
}

/// Returns the statement that `holds` held at every tick up to now; with `within=(0, 5)`, at every tick of the 5 s before.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn historically(holds: &Bound<PyAny>, within: Option<[f64; 2]>) -> PyResult<Temporal> {
    Ok(Temporal { inner: statement(holds, "historically")?.historically(interval(within)?) })
}

/// Returns the statement that `holds` held at some tick up to now; with `within=(0, 5)`, at some tick of the 5 s before.
#[pyfunction]
#[pyo3(signature = (holds, *, within = None))]
pub fn once(holds: &Bound<PyAny>, within: Option<[f64; 2]>) -> PyResult<Temporal> {
    Ok(Temporal { inner: statement(holds, "once")?.once(interval(within)?) })
}

/// Returns the statement that `holds` holds until `goal` holds; with `within=(0, 5)`, `goal` holds within the 5 s from now on.
#[pyfunction]
#[pyo3(signature = (holds, goal, *, within = None))]
pub fn until(holds: &Bound<PyAny>, goal: &Bound<PyAny>, within: Option<[f64; 2]>) -> PyResult<Temporal> {
    let (holds, goal) = (statement(holds, "until")?, statement(goal, "until")?);
    Ok(Temporal { inner: holds.until(interval(within)?, goal) })
}

/// A usual requirement of a drive, for `s.monitor(..)`.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Monitor {
    pub inner: Stated,
}

#[pymethods]
impl Monitor {
    /// Requires that the car touches nobody.
    #[staticmethod]
    fn no_collision(car: &Car) -> Self {
        Self { inner: Stated::no_collision(&car.inner) }
    }

    /// Requires that the car travels at least some metres.
    #[staticmethod]
    fn progress(car: &Car, metres: f64) -> Self {
        Self { inner: Stated::progress(&car.inner, metres) }
    }

    /// Requires that the car comes within some metres of the end of its way.
    #[staticmethod]
    fn route_completion(car: &Car, metres: f64) -> Self {
        Self { inner: Stated::route_completion(&car.inner, metres) }
    }

    /// Requires that the car never stands still for some seconds.
    #[staticmethod]
    fn activity(car: &Car, seconds: f64) -> Self {
        Self { inner: Stated::activity(&car.inner, seconds) }
    }

    /// Requires that the car keeps at least some metres away from all other bodies.
    #[staticmethod]
    fn clearance(car: &Car, metres: f64) -> Self {
        Self { inner: Stated::clearance(&car.inner, metres) }
    }

    /// Requires that the car is never faster than a speed in m/s.
    #[staticmethod]
    fn speed_limit(car: &Car, limit: f64) -> Self {
        Self { inner: Stated::speed_limit(&car.inner, limit) }
    }

    /// Requires that the time to collision is never below some seconds.
    #[staticmethod]
    fn time_to_collision(car: &Car, seconds: f64) -> Self {
        Self { inner: Stated::time_to_collision(&car.inner, seconds) }
    }

    /// Requires that the time headway to the body straight ahead is never below some seconds.
    #[staticmethod]
    fn headway(car: &Car, seconds: f64) -> Self {
        Self { inner: Stated::headway(&car.inner, seconds) }
    }

    /// Requires that the whole car stays in a lane of its own direction.
    #[staticmethod]
    fn lane_keeping(car: &Car) -> Self {
        Self { inner: Stated::lane_keeping(&car.inner) }
    }

    /// Requires that the car's middle stays within some metres of its way.
    #[staticmethod]
    fn on_its_way(car: &Car, metres: f64) -> Self {
        Self { inner: Stated::on_its_way(&car.inner, metres) }
    }

    /// Requires that the acceleration along the heading never changes faster than a limit in m/s³.
    #[staticmethod]
    fn jerk(car: &Car, limit: f64) -> Self {
        Self { inner: Stated::jerk(&car.inner, limit) }
    }

    /// Requires that nobody with the right of way reaches the car's place in an intersection within some seconds.
    #[staticmethod]
    fn right_of_way(car: &Car, seconds: f64) -> Self {
        Self { inner: Stated::right_of_way(&car.inner, seconds) }
    }
}
