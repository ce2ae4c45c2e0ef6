//! Computes how many tests a guarantee needs.

use crate::detached::{STOP, detached};
use crate::error::{raised, warn};
use crate::json::to_dict;
use crate::measures::duration;
use crate::space::Space;
use crate::whole::maybe_whole;
use paracosm::analysis::Plan;
use paracosm::capped_strength;
use pyo3::prelude::*;

/// Computes how many tests a (k, epsilon)-covering set needs, as a dictionary with the keys of `paracosm-cover plan --format json`.
///
/// epsilon: the largest volume of an empty box. delta: the chance that a random set misses the guarantee. time_limit: the limit of all work, in
/// seconds.
#[pyfunction]
#[pyo3(signature = (space, k = None, *, epsilon = 0.1, delta = 0.05, time_limit = 60.0))]
pub fn plan<'py>(
    py: Python<'py>,
    space: &Bound<'py, Space>,
    #[pyo3(from_py_with = maybe_whole)] k: Option<usize>,
    epsilon: f64,
    delta: f64,
    time_limit: f64,
) -> PyResult<Bound<'py, PyAny>> {
    warn(py, capped_strength(k, &space.get().inner))?;
    let (space, limit) = (space.get(), duration(time_limit)?);
    let plan = detached(py, &STOP, || Plan::of(&space.inner, k, &space.demand, epsilon, delta, limit))?;
    to_dict(py, &plan.map_err(raised)?)
}
