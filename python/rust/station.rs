//! A study that travels: what it needs of its files and choices, and `Station`, which runs its tests in another process for a campaign.

use crate::choices::SAMPLING;
use crate::detached::{attached, detached};
use crate::error::raised;
use crate::study::Study;
use paracosm::campaign::{Doubts, Error, Supervision, Worker};
use paracosm::space::Values;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use self_cell::self_cell;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

/// The idle workers of a station, which keep their drivers from one call to the next.
type Idle<'a> = Mutex<Vec<Worker<'a>>>;

self_cell!(
    struct Bench {
        owner: paracosm::Study,
        #[not_covariant]
        dependent: Idle,
    }
);

/// A study that runs tests for a campaign in another process.
#[pyclass(frozen, module = "paracosm._core")]
pub struct Station {
    bench: Bench,
    stop: Arc<AtomicBool>,
    doubts: Doubts,
}

#[pymethods]
impl Station {
    #[new]
    fn new(study: &Study) -> Self {
        let bench = Bench::new(study.library().clone(), |_| Mutex::default());
        Self { bench, stop: Arc::default(), doubts: Doubts::default() }
    }

    /// Runs tests. The first test has the index `first`. Returns the trials, and the errors that did not repeat since the last call. Tests, trials
    /// and errors are JSON in one line.
    fn run(&self, py: Python, first: usize, tests: Vec<String>) -> PyResult<(Vec<String>, String)> {
        let read = |text: &String| serde_json::from_str::<Values>(text).map_err(raised);
        let tests = tests.iter().map(read).collect::<PyResult<Vec<_>>>()?;
        let ran = detached(py, &self.stop, || {
            Python::attach(|py| {
                py.detach(|| self.bench.with_dependent(|study, idle| self.ran(study, idle, first, &tests)))
            })
        })?;
        let lines = ran.map_err(raised)?;
        let recovered = serde_json::to_string(&self.doubts.take_recovered()).expect("texts are always JSON");
        Ok((lines, recovered))
    }
}

impl Station {
    fn ran<'a>(
        &self,
        study: &'a paracosm::Study,
        idle: &Idle<'a>,
        first: usize,
        tests: &[Values],
    ) -> Result<Vec<String>, Error> {
        let there = idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let supervision = || Supervision {
            threads: attached(),
            stop: Arc::clone(&self.stop),
            doubts: self.doubts.clone(),
            ..Supervision::default()
        };
        let mut worker = there.map_or_else(|| Worker::until(study, supervision()), Ok)?;
        let lines = (first..).zip(tests).map(|(index, test)| worker.run(index, test).0.as_line()).collect();
        idle.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
        Ok(lines)
    }
}

/// Returns the study without its choices of tests. Other processes run tests that they are given, so they need no strategy.
#[pyfunction]
pub fn without_sampling<'py>(study: &Bound<'py, Study>) -> PyResult<Bound<'py, PyAny>> {
    let nothing = PyDict::new(study.py());
    SAMPLING.iter().try_for_each(|name| nothing.set_item(name, study.py().None()))?;
    study.call_method("replace", (), Some(&nothing))
}

/// Returns the paths of the files that the scenario of a study reads.
#[pyfunction]
pub fn scenario_files(study: &Study) -> PyResult<Vec<PathBuf>> {
    Ok(study.library().scenario_files().map_err(raised)?.into_iter().collect())
}
