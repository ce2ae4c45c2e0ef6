//! `Report`: the results of a campaign; and `Trial`: a test that can be run again.

use crate::detached::detached;
use crate::driver::{given_again, of_python};
use crate::error::raised;
use crate::failure_map::FailureMap;
use crate::formula::Trace;
use crate::inquiries;
use crate::json::to_dict;
use crate::notebook::{self, counts};
use crate::threads::with_threads;
use crate::trials::Trials;
use crate::value::to_python;
use crate::whole::{at_once, maybe_whole, whole};
use crate::world::catalogue;
use paracosm::campaign::{Error as LibraryError, Supervision, Trust, Worker};
use paracosm::oracles::Verdict;
use paracosm::report::html::Runs;
use paracosm::{Beside, Log};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

/// The results of a campaign: its tests, its coverage, and where tests fail.
///
/// `len(report)` is the number of tests, and `report[17]` is test 17.
#[pyclass(frozen, module = "paracosm")]
pub struct Report {
    inner: Arc<Results>,
}

struct Results {
    report: paracosm::Report,
    folder: PathBuf,
}

impl Report {
    /// Makes the report of a campaign in a folder.
    pub fn new(report: paracosm::Report, folder: PathBuf) -> Self {
        Self { inner: Arc::new(Results { report, folder }) }
    }

    fn log(&self) -> &Log {
        &self.inner.report.log
    }

    fn trial_at(&self, index: usize) -> TrialView {
        TrialView { results: Arc::clone(&self.inner), index }
    }
}

/// Reads the results of a campaign from its folder.
///
/// A campaign may run a command of its own as driver or system. Its tests are only run again with `trust=True`, because the folder may be that of a
/// stranger. A driver that was an object of Python is not in the folder: give the driver again (`driver=Mine()`) to run tests again.
#[pyfunction]
#[pyo3(signature = (folder, *, trust = false, driver = None))]
pub fn load(py: Python, folder: PathBuf, trust: bool, driver: Option<&Bound<PyAny>>) -> PyResult<Report> {
    let trust = if trust { Trust::all() } else { Trust::NOTHING };
    let driver = driver.map(|driver| {
        let own = of_python(driver)?;
        own.ok_or_else(|| {
            raised("driver: found the name of a driver, expected the Driver or the function that drove in the campaign")
        })
    });
    let driver = driver.transpose()?;
    let mut log = py
        .detach(|| with_threads(|| Log::read(&folder, &catalogue().trusting(&trust))))
        .map_err(raised)?
        .trusting(&trust);
    if let Some(driver) = driver {
        log = given_again(&log, driver)?;
    }
    let report = py.detach(|| with_threads(|| paracosm::Report::read(log, &folder))).map_err(raised)?;
    Ok(Report::new(report, folder))
}

#[pymethods]
impl Report {
    /// The folder of the campaign.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.inner.folder.clone()
    }

    /// The number of tests with each verdict.
    #[getter]
    fn verdicts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let summary = &self.inner.report.summary;
        Verdict::ALL.iter().try_for_each(|verdict| dict.set_item(verdict.to_string(), summary.count(*verdict)))?;
        Ok(dict)
    }

    /// The tests with their verdicts, robustness and metrics: a table with the columns of `trials.csv`, whose rows are the lines of `trials.jsonl`.
    #[getter]
    fn trials<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, Trials>> {
        Bound::new(py, Trials::new(self.log()))
    }

    /// The tests that violate a requirement.
    #[getter]
    fn failures(&self) -> Vec<TrialView> {
        let failing = self.log().trials().iter().enumerate().filter(|(_, trial)| trial.is_failure());
        failing.map(|(index, _)| self.trial_at(index)).collect()
    }

    /// The worst test: it violates a requirement most, or is nearest to a violation. `None` if no test has a robustness.
    #[getter]
    fn worst(&self) -> Option<TrialView> {
        let worst = self.inner.report.summary.worst(self.log().scales())?;
        Some(self.trial_at(worst.index))
    }

    /// The coverage of the space, with the keys of `coverage.json`.
    #[getter]
    fn coverage<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_dict(py, &self.inner.report.coverage)
    }

    /// The doubts about the programs of the campaign in words, which its tests do not show. For example, a test ended in an error, and had a result
    /// when it ran again.
    #[getter]
    fn doubts(&self) -> Vec<String> {
        self.inner.report.doubts.clone()
    }

    /// The failure modes, with the keys of `modes.json`.
    #[getter]
    fn modes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_dict(py, &self.inner.report.modes)
    }

    /// The explanation of the failures, with the keys of `explanation.json`. `None` if too few tests failed or passed.
    #[getter]
    fn explanation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_dict(py, &self.inner.report.explanation)
    }

    /// The open parameters that changed nothing, and how this is known, with the keys of `effects.json`. `None` if this is not known.
    #[getter]
    fn effects<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_dict(py, &self.inner.report.effects)
    }

    /// Says for each failing test which reference drivers would have avoided the failure, with the keys of `blame.json`. `drivers` are the reference
    /// drivers, and `executor` is the number of tests that run at the same time.
    #[pyo3(signature = (drivers = None, *, executor = None))]
    fn blame<'py>(
        &self,
        py: Python<'py>,
        drivers: Option<Vec<String>>,
        #[pyo3(from_py_with = at_once)] executor: Option<NonZeroUsize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        inquiries::blame(py, self.log(), drivers, executor)
    }

    /// Compares the same tests under this campaign and a later one, for example of another version of a driver: new failures, mended ones and
    /// changed margins, with the keys of `paracosm-fuzz diff --format json`.
    #[pyo3(signature = (after, /))]
    fn diff<'py>(&self, py: Python<'py>, after: &Self) -> PyResult<Bound<'py, PyAny>> {
        inquiries::difference(py, self.log(), after.log())
    }

    /// Estimates how much each open parameter matters: Sobol indices, with the keys of `paracosm-fuzz sensitivity --format json`. Without a budget,
    /// the model of the campaign's failures is asked, and no test runs; with one, up to so many tests run.
    #[pyo3(signature = (*, budget = None, seed = 0, executor = None))]
    fn sensitivity<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = maybe_whole)] budget: Option<usize>,
        #[pyo3(from_py_with = whole)] seed: u64,
        #[pyo3(from_py_with = at_once)] executor: Option<NonZeroUsize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        inquiries::sensitivity(py, self.log(), budget, seed, executor)
    }

    /// Draws the map of the campaign over two continuous parameters. Without names, they are the two that separate failing tests from passing tests
    /// best. `show` is "failures", or "severity" for the speeds of impacts.
    #[pyo3(signature = (x = None, y = None, *, show = "failures"))]
    fn map(&self, py: Python, x: Option<&str>, y: Option<&str>, show: &str) -> PyResult<FailureMap> {
        py.detach(|| with_threads(|| FailureMap::of(self.log(), &self.inner.folder, [x, y], show)))
    }

    /// Writes the report page, one HTML file with runs to play. `max_mb` is its greatest size.
    #[pyo3(signature = (path, *, max_mb = 8.0))]
    fn page(&self, py: Python, path: PathBuf, max_mb: f64) -> PyResult<()> {
        let supervision = Supervision::default();
        let stop = Arc::clone(&supervision.stop);
        let Results { report, folder } = &*self.inner;
        let html = detached(py, &stop, || -> Result<String, LibraryError> {
            let page = report.page(folder, "paracosm-fuzz", Beside::default())?;
            let runs = match Runs::of(&page, &supervision, |_, _| ()) {
                // The page is worth something without runs, for example if the driver is not trusted.
                Err(error) if !matches!(error, LibraryError::Interrupted) => Runs::none(error.to_string()),
                runs => runs?,
            };
            page.html(&runs, max_mb)
        })?;
        std::fs::write(&path, html.map_err(raised)?)
            .map_err(|error| raised(format!("cannot write {}: {error}", path.display())))
    }

    fn __len__(&self) -> usize {
        self.log().trials().len()
    }

    fn __getitem__(&self, index: isize) -> PyResult<TrialView> {
        let len = self.__len__();
        let at = usize::try_from(if index < 0 { index + len as isize } else { index }).ok().filter(|at| *at < len);
        at.map(|at| self.trial_at(at))
            .ok_or_else(|| PyIndexError::new_err(format!("test {index} of a campaign with {len} tests")))
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let trials: Vec<TrialView> = (0..self.__len__()).map(|index| self.trial_at(index)).collect();
        Ok(PyList::new(py, trials.into_iter().map(|trial| Bound::new(py, trial)).collect::<PyResult<Vec<_>>>()?)?
            .try_iter()?
            .into_any())
    }

    fn __repr__(&self) -> String {
        let Results { report, folder } = &*self.inner;
        format!("Report({}: {}, in {})", report.log.study().title(), counts(report), folder.display())
    }

    /// Returns the verdicts, the doubts, the failure map and the failure modes, for notebooks.
    fn _repr_html_(&self) -> String {
        notebook::page(&self.inner.report, &self.inner.folder)
    }
}

/// A test of a campaign with its result.
#[pyclass(frozen, name = "Trial", module = "paracosm")]
pub struct TrialView {
    results: Arc<Results>,
    index: usize,
}

impl TrialView {
    fn trial(&self) -> &paracosm::Trial {
        &self.results.report.log.trials()[self.index]
    }
}

#[pymethods]
impl TrialView {
    /// The position of the test in the campaign, from 0.
    #[getter]
    fn index(&self) -> usize {
        self.trial().index
    }

    /// The values of the open parameters.
    #[getter]
    fn test<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let space = self.results.report.log.study().space();
        let dict = PyDict::new(py);
        for (name, value) in self.trial().test.iter() {
            let is_of_choice = space.find(name).is_some_and(|parameter| parameter.levels().is_some());
            dict.set_item(name, to_python(py, value, is_of_choice)?)?;
        }
        Ok(dict)
    }

    /// The verdict: "pass", "fail", "unpreventable", "inconclusive", "invalid" or "error".
    #[getter]
    fn verdict(&self) -> String {
        self.trial().verdict.to_string()
    }

    /// The robustness of each requirement; below 0 if the test violates it.
    #[getter]
    fn robustness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let trial = self.trial();
        trial.requirements().try_for_each(|id| dict.set_item(id, trial.robustness(id)))?;
        Ok(dict)
    }

    /// The reason why the test has no result; `None` if it has one.
    #[getter]
    fn error(&self) -> Option<&str> {
        self.trial().error()
    }

    /// The metrics of the run, such as the distance that the car has travelled: numbers, words and truths.
    #[getter]
    fn metrics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let line: serde_json::Value = serde_json::from_str(&self.trial().as_line()).map_err(raised)?;
        to_dict(py, &line["metrics"])
    }

    /// The number of ticks of the run.
    #[getter]
    fn ticks(&self) -> usize {
        self.trial().ticks
    }

    /// The hash of the trace; `None` if the test has no trace.
    #[getter]
    fn trace_hash(&self) -> Option<&str> {
        self.trial().trace_hash.as_deref()
    }

    /// Finds the simplest test near this failing test that still fails, with the keys of `paracosm-fuzz shrink --format json`. `same_mode=True` keeps
    /// the failure mode, and `budget` is the greatest number of tests to run.
    #[pyo3(signature = (*, same_mode = false, budget = None))]
    fn shrink<'py>(
        &self,
        py: Python<'py>,
        same_mode: bool,
        #[pyo3(from_py_with = maybe_whole)] budget: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        inquiries::shrink(py, &self.results.report.log, self.trial(), same_mode, budget)
    }

    /// Runs the test again, and returns its trace.
    ///
    /// Raises `Error` if the test does not end as in the log, or has no trace.
    fn replay(&self, py: Python) -> PyResult<Trace> {
        let supervision = Supervision::default();
        let stop = Arc::clone(&supervision.stop);
        let (log, logged) = (&self.results.report.log, self.trial());
        let ran = detached(py, &stop, || -> Result<_, LibraryError> {
            let mut worker = Worker::until(log.study(), supervision)?;
            worker.start()?;
            worker.check_repeats(log, logged)?;
            Ok(worker.replay(log, logged, |_| ()).1)
        })?;
        match ran.map_err(raised)? {
            Some(inner) => Ok(Trace { inner }),
            None => Err(raised(format!(
                "test {} has no trace: {}",
                self.index,
                self.error().unwrap_or("the system answered with robustness alone")
            ))),
        }
    }

    fn __repr__(&self) -> String {
        let values = self.trial().test.iter().map(|(name, value)| format!("{name}={value}"));
        format!("Trial({}: {}, {})", self.index, self.trial().verdict, values.collect::<Vec<_>>().join(", "))
    }
}
