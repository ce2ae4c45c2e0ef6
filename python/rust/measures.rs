//! Measures of coverage, as functions of arrays and tables.

use crate::bracket::Bracket;
use crate::detached::{STOP, detached};
use crate::error::raised;
use crate::json::to_dict;
use crate::space::Space;
use crate::test_table::tests_of;
use crate::whole::maybe_whole;
use paracosm::analysis::{Coverage, Limit};
use paracosm::coverage::Measure;
use paracosm::coverage::measure::Computation;
use pyo3::prelude::*;
use std::time::Duration;

/// Reads a time limit in seconds. Without one, the limit is an amount of work that is the same on every machine.
///
/// # Errors
/// The time is no number of seconds.
pub fn limit(seconds: Option<f64>) -> PyResult<Limit> {
    Ok(match seconds {
        None => Limit::USUAL,
        Some(seconds) if seconds == f64::INFINITY => Limit::None,
        Some(seconds) => Limit::Time(duration(seconds)?),
    })
}

/// Reads a number of seconds.
///
/// # Errors
/// The number is negative or not finite.
pub fn duration(seconds: f64) -> PyResult<Duration> {
    Duration::try_from_secs_f64(seconds)
        .map_err(|_| raised(format!("time_limit is {seconds}, expected a number of seconds from 0 on")))
}

/// Returns the name and the meaning of each measure.
#[pyfunction]
pub fn measures() -> Vec<(&'static str, &'static str)> {
    Measure::all().map(|measure| (measure.name(), measure.descriptor().about)).collect()
}

/// Measures the coverage of a space by tests, and returns the result as a dictionary with the keys of `coverage.json`.
///
/// tests: an array of points of the unit cube; `Tests`; or, with `space`, a dictionary or a data frame with a column for each parameter.
/// k: the number of parameters in each combination (2).
/// measures: the names of the measures; `measures()` lists all. By default, all are taken.
/// time_limit: the limit of all measures in seconds. Without it, the limit is an amount of work that is the same on every machine.
#[pyfunction]
#[pyo3(signature = (tests, space = None, *, k = None, measures = None, time_limit = None))]
pub fn coverage<'py>(
    py: Python<'py>,
    tests: &Bound<'py, PyAny>,
    space: Option<&Bound<'py, Space>>,
    #[pyo3(from_py_with = maybe_whole)] k: Option<usize>,
    measures: Option<Vec<String>>,
    time_limit: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let asked =
        measures.map(|names| names.iter().map(|name| name.parse().map_err(raised)).collect::<PyResult<Vec<Measure>>>());
    let asked = asked.unwrap_or_else(|| Ok(Measure::all().collect()))?;
    to_dict(py, &taken(py, tests, space, k, &asked, time_limit)?)
}

/// Takes one measure by its name.
#[pyfunction]
#[pyo3(signature = (name, tests, space = None, *, k = None, time_limit = None))]
pub fn measure<'py>(
    py: Python<'py>,
    name: &str,
    tests: &Bound<'py, PyAny>,
    space: Option<&Bound<'py, Space>>,
    #[pyo3(from_py_with = maybe_whole)] k: Option<usize>,
    time_limit: Option<f64>,
) -> PyResult<Bracket> {
    let measure: Measure = name.parse().map_err(raised)?;
    let coverage = taken(py, tests, space, k, &[measure], time_limit)?;
    let found = match measure.descriptor().method {
        Computation::Combinations => coverage.discrete.flatten().map(|discrete| Bracket::exact(discrete.ratio)),
        Computation::KwiseHole => coverage.k_wise_dispersion.as_ref().map(Bracket::of_hole),
        _ => coverage.continuous.as_ref().and_then(|found| found.measured(measure)).and_then(Bracket::of),
    };
    found.ok_or_else(|| {
        let of =
            if matches!(measure.descriptor().method, Computation::Combinations) { "discrete" } else { "continuous" };
        raised(format!(
            "{name} is not known: there are no tests, the time was too short, or the space has no {of} parameters"
        ))
    })
}

fn taken<'py>(
    py: Python<'py>,
    tests: &Bound<'py, PyAny>,
    space: Option<&Bound<'py, Space>>,
    k: Option<usize>,
    measures: &[Measure],
    time_limit: Option<f64>,
) -> PyResult<Coverage> {
    let (tests, limit) = (tests_of(tests, space.map(Bound::get))?, limit(time_limit)?);
    detached(py, &STOP, || Coverage::stoppable(&tests, measures, k, limit, &STOP))?.map_err(raised)
}
