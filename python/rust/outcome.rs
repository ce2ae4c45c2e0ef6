//! A single test and its result, as dictionaries of Python.

use crate::error::raised;
use crate::json::to_dict;
use crate::value::value_of;
use paracosm::Trial;
use paracosm::campaign::{Learned, Scales};
use paracosm::space::Values;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::BTreeMap;

/// Returns the smallest robustness of a test, in multiples of the scale of its requirement; `None` if the test has no result or decided nothing. A
/// requirement without a scale has the scale 1, because a single test teaches none.
pub fn worst_of(study: &paracosm::Study, trial: &Trial) -> Option<f64> {
    Scales::of(study, Learned::new()).worst(trial).map(|(_, worst)| worst)
}

/// Reads a test from a dictionary, and checks that it is one of the space.
///
/// # Errors
/// A parameter is missing or unknown, a value is not in its domain, or the test breaks a constraint.
pub fn test_of(study: &paracosm::Study, test: &Bound<PyDict>) -> PyResult<Values> {
    let value = |(name, value): (Bound<PyAny>, Bound<PyAny>)| {
        let name: String = name.extract()?;
        let value = value_of(&value, &format!("parameter `{name}`"))?;
        PyResult::Ok((name, value))
    };
    let test: Values = test.iter().map(value).collect::<PyResult<_>>()?;
    let point = study.space().encode(&test).map_err(raised)?;
    if let Some(constraint) = study.space().broken(&point) {
        return Err(raised(format!("the test breaks the constraint `{}`", constraint.text())));
    }
    Ok(test)
}

/// Returns the result of a test, with its worst robustness in multiples of a scale.
pub fn outcome_of<'py>(py: Python<'py>, trial: &Trial, worst: Option<f64>) -> PyResult<Bound<'py, PyAny>> {
    let robustness: BTreeMap<&str, Option<f64>> = trial.requirements().map(|id| (id, trial.robustness(id))).collect();
    let outcome = serde_json::json!({
        "verdict": trial.verdict.to_string(),
        "robustness": robustness,
        "worst": worst,
        "error": trial.error(),
        "ticks": trial.ticks,
        "trace_hash": trial.trace_hash,
    });
    to_dict(py, &outcome)
}
