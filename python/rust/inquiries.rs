//! Questions to a campaign that has ended: the simplest failing test, blame, what changed. They run further tests, and write nothing.

use crate::detached::detached;
use crate::error::raised;
use crate::json::to_dict;
use paracosm::analysis::blame::{Inquiry, REFERENCES};
use paracosm::analysis::likelihood::{Question, of_study};
use paracosm::analysis::{Difference, Sameness, Shrunk};
use paracosm::campaign::Supervision;
use paracosm::{Campaign, Log, Study, Trial};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Finds the simplest test near a failing test that still fails.
///
/// # Errors
/// The test did not fail, or does not fail again.
pub fn shrink<'py>(
    py: Python<'py>,
    log: &Log,
    failing: &Trial,
    same_mode: bool,
    budget: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    let same = if same_mode { Sameness::Mode } else { Sameness::Requirements };
    let supervision = Supervision::default();
    let stop = Arc::clone(&supervision.stop);
    let budget = budget.unwrap_or(Shrunk::BUDGET);
    let shrunk = detached(py, &stop, || Shrunk::until(log, failing, same, budget, &supervision))?.map_err(raised)?;
    let found = to_dict(py, &shrunk)?;
    found.set_item("sentence", shrunk.sentence())?;
    Ok(found)
}

/// Says for each failing test which reference drivers would have avoided the failure.
///
/// # Errors
/// The system under test is no driver in a scenario, a reference driver does not exist, or a test ends otherwise now.
pub fn blame<'py>(
    py: Python<'py>,
    log: &Log,
    drivers: Option<Vec<String>>,
    jobs: Option<NonZeroUsize>,
) -> PyResult<Bound<'py, PyAny>> {
    let drivers = drivers.unwrap_or_else(|| REFERENCES.map(str::to_owned).to_vec());
    let references: Vec<&str> = drivers.iter().map(String::as_str).collect();
    let stop = Supervision::default().stop;
    let inquiry = Inquiry::new(log.study(), &references).map_err(raised)?.until(Arc::clone(&stop));
    let inquiry = jobs.into_iter().fold(inquiry, Inquiry::jobs);
    let blame = detached(py, &stop, || inquiry.run(log, |_| ()))?.map_err(raised)?;
    to_dict(py, &blame)
}

/// Compares the same tests of two campaigns.
///
/// # Errors
/// The campaigns have different tests.
pub fn difference<'py>(py: Python<'py>, before: &Log, after: &Log) -> PyResult<Bound<'py, PyAny>> {
    to_dict(py, &Difference::of(before, after).map_err(raised)?)
}

/// Estimates the probability that a test of a study fails.
///
/// # Errors
/// The question is not valid, or no test could be judged.
pub fn likelihood<'py>(
    py: Python<'py>,
    study: &Study,
    question: Question,
    jobs: Option<NonZeroUsize>,
) -> PyResult<Bound<'py, PyAny>> {
    let supervision = Supervision::default();
    let stop = Arc::clone(&supervision.stop);
    let estimated = detached(py, &stop, || {
        let campaign = Campaign::until(study, supervision)?;
        let campaign = jobs.into_iter().fold(campaign, Campaign::jobs);
        of_study(study, &campaign, &question, |_| Ok(()))
    })?;
    to_dict(py, &estimated.map_err(raised)?)
}
