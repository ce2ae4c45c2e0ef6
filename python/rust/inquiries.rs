//! Questions to a campaign that has ended: the simplest failing test, blame, what changed. They run further tests, and write nothing.

use crate::crew::Executor;
use crate::detached::detached;
use crate::error::raised;
use crate::json::to_dict;
use paracosm::analysis::audit::{Audit, Runs, Screen, Suite};
use paracosm::analysis::blame::{Inquiry, REFERENCES};
use paracosm::analysis::likelihood::{Question, of_study};
use paracosm::analysis::sensitivity::{of_model, of_tests};
use paracosm::analysis::{Difference, Sameness, Shrunk};
use paracosm::campaign::{Error, Supervision};
use paracosm::{Campaign, Log, Study, Trial};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

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
    executor: Executor,
) -> PyResult<Bound<'py, PyAny>> {
    to_dict(py, &tested(py, study, executor, |campaign| of_study(study, campaign, &question, |_| Ok(())))?)
}

/// Asks a question that further tests of a study answer.
fn tested<T: Send>(
    py: Python,
    study: &Study,
    executor: Executor,
    ask: impl FnOnce(&Campaign) -> Result<T, Error> + Send,
) -> PyResult<T> {
    let supervision = Supervision::default();
    let stop = Arc::clone(&supervision.stop);
    let answer = detached(py, &stop, || {
        let campaign = Campaign::until(study, supervision)?;
        ask(&executor.hired(campaign))
    })?;
    answer.map_err(raised)
}

/// Estimates the share of each open parameter in the failures of a campaign: with tests of its own if there is a budget.
///
/// # Errors
/// The parameters depend on each other, the budget is too small, or there is nothing to explain.
pub fn sensitivity<'py>(
    py: Python<'py>,
    log: &Log,
    budget: Option<usize>,
    seed: u64,
    jobs: Option<NonZeroUsize>,
) -> PyResult<Bound<'py, PyAny>> {
    let found = match budget {
        None => detached(py, &AtomicBool::new(false), || of_model(log, seed))?.map_err(raised)?,
        Some(budget) => tested(py, log.study(), jobs.map_or(Executor::Usual, Executor::Threads), |campaign| {
            of_tests(log, campaign, budget, seed, |_| Ok(()))
        })?,
    };
    to_dict(py, &found)
}

/// Puts suites of tests on trial: what their tests would have missed.
///
/// # Errors
/// The study cannot be audited, for example because its driver is in a process of its own.
pub fn audit<'py>(
    py: Python<'py>,
    study: &Study,
    suites: Vec<Suite>,
    choices: AuditChoices,
    jobs: Option<NonZeroUsize>,
) -> PyResult<Bound<'py, PyAny>> {
    let AuditChoices { mutants, screen, seed, time_limit } = choices;
    if mutants > 0 && screen == 0 {
        return Err(raised("screen is 0, expected at least 1 test: mutants come from the screen"));
    }
    let mut runs = Runs::default();
    runs.jobs = jobs.unwrap_or(runs.jobs);
    let stop = Arc::clone(&runs.stop);
    let report = detached(py, &stop, || {
        let mut audit = time_limit.into_iter().fold(Audit::of(study, suites)?, Audit::time_limit);
        if mutants > 0 {
            audit = audit.mutants(Screen::of(study, mutants, screen, seed, &runs)?);
        }
        audit.runs(runs).run(&mut Vec::new(), |_| Ok(()))
    })?;
    to_dict(py, &report.map_err(raised)?)
}

/// The choices of an audit.
pub struct AuditChoices {
    pub mutants: usize,
    pub screen: usize,
    pub seed: u64,
    pub time_limit: Option<Duration>,
}
