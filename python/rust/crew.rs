//! The executor of a campaign: threads of this process, or an executor of Python that runs tests in other processes and on other machines.

use crate::busy;
use crate::error::raised;
use crate::system::in_words;
use paracosm::Trial;
use paracosm::campaign::reasons::LogFlaw;
use paracosm::campaign::{Campaign, Crew, Error, Reason, Supervision};
use paracosm::space::Values;
use pyo3::prelude::*;
use pyo3::types::PyBool;
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// The executor of the tests of a campaign.
pub enum Executor {
    /// All cores of this machine.
    Usual,
    /// A number of threads.
    Threads(NonZeroUsize),
    /// An executor of Python.
    Crew(Arc<dyn Crew>),
}

impl Executor {
    /// Reads the `executor` of a study.
    ///
    /// # Errors
    /// It is no number of tests and no executor, or the study cannot travel.
    pub fn of(given: Option<&Bound<PyAny>>, study: &Bound<PyAny>) -> PyResult<Self> {
        let Some(given) = given else { return Ok(Self::Usual) };
        let number = if given.is_instance_of::<PyBool>() { None } else { given.extract::<i64>().ok() };
        if let Some(number) = number {
            let threads = usize::try_from(number).ok().and_then(NonZeroUsize::new);
            let flaw = || raised(format!("executor is {number}, expected at least 1 test at the same time"));
            return threads.map(Self::Threads).ok_or_else(flaw);
        }
        let inner = given.py().import("paracosm._crew")?.getattr("Crew")?.call1((study, given))?.unbind();
        Ok(Self::Crew(Arc::new(OfPython { inner })))
    }

    /// Lets the executor run the tests of a campaign.
    pub fn hired<'a>(self, campaign: Campaign<'a>) -> Campaign<'a> {
        match self {
            Self::Usual => campaign,
            Self::Threads(tests) => campaign.jobs(tests),
            Self::Crew(crew) => campaign.with_crew(crew),
        }
    }
}

/// A crew in Python.
struct OfPython {
    inner: Py<PyAny>,
}

impl fmt::Debug for OfPython {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OfPython").finish_non_exhaustive()
    }
}

impl Crew for OfPython {
    fn run(
        &self,
        first: usize,
        tests: &[Values],
        supervision: &Supervision,
        take: &mut dyn FnMut(Trial),
    ) -> Result<(), Error> {
        let tests: Vec<String> = tests.iter().map(written).collect();
        let begin = |py: Python| Ok(self.inner.bind(py).call_method1("begin", (first, &tests))?.unbind());
        let batch = calling(begin)?;
        let ended = self.collected(&batch, supervision, take);
        // The executor should not go on with tests that nobody waits for.
        let cancelled = calling(|py| batch.bind(py).call_method0("cancel").map(drop));
        ended.and(cancelled)
    }
}

impl OfPython {
    /// Takes the trials of a batch until all have come, or until the flag is set.
    fn collected(
        &self,
        batch: &Py<PyAny>,
        supervision: &Supervision,
        take: &mut dyn FnMut(Trial),
    ) -> Result<(), Error> {
        while !supervision.stop.load(Ordering::Relaxed) {
            let results =
                |py: Python| batch.bind(py).call_method0("results")?.extract::<Option<Vec<(Vec<String>, String)>>>();
            let Some(parts) = calling(results)? else { break };
            for (lines, recovered) in parts {
                let recovered = serde_json::from_str(&recovered).map_err(ExecutorFlaw::NoDoubts)?;
                supervision.doubts.add_recovered(recovered);
                for line in lines {
                    take(Trial::of_line(&line).map_err(ExecutorFlaw::NoTrial)?);
                }
            }
        }
        Ok(())
    }
}

/// The error that an executor of Python ran no tests.
#[derive(Debug)]
enum ExecutorFlaw {
    /// An exception of Python.
    Raised(PyErr),
    /// A line that is no trial.
    NoTrial(LogFlaw),
    /// A text that holds no errors that did not repeat.
    NoDoubts(serde_json::Error),
}

impl fmt::Display for ExecutorFlaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Raised(error) => f.write_str(&Python::attach(|py| in_words(py, error))),
            Self::NoTrial(flaw) => write!(f, "the executor returned no trial: {flaw}"),
            Self::NoDoubts(flaw) => write!(f, "the executor returned no errors that did not repeat: {flaw}"),
        }
    }
}

impl std::error::Error for ExecutorFlaw {}
impl Reason for ExecutorFlaw {}

/// Calls a function of Python.
fn calling<T>(call: impl FnOnce(Python) -> PyResult<T>) -> Result<T, Error> {
    Python::attach(|py| busy::calling(py, || call(py)).map_err(|error| ExecutorFlaw::Raised(error).into()))
}

/// Returns a test as JSON.
fn written(test: &Values) -> String {
    serde_json::to_string(test).expect("a test is always JSON")
}
