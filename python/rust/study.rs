//! `Study`: the description of a campaign, which is checked once and never changes; and running it.

use crate::choices::{built, checked, deep_copy};
use crate::crew::Executor;
use crate::detached::{attached, detached, watched};
use crate::error::{raised, warn};
use crate::inquiries::{AuditChoices, audit, likelihood};
use crate::measures::duration;
use crate::outcome::{outcome_of, test_of, worst_of};
use crate::progress::Progress;
use crate::report::Report;
use crate::space::{Space, cube};
use crate::system::system_of;
use crate::test_table::tests_of;
use crate::whole::{at_once, maybe_whole, whole};
use crate::world::{Program, catalogue};
use paracosm::analysis::audit::{Screen, Source, Suite};
use paracosm::analysis::likelihood::Question;
use paracosm::campaign::{Error as LibraryError, Extension, StudyBuilder, Supervision, Worker};
use paracosm::generators::{Purpose, Strategy};
use paracosm::{Runner, Trial, notes_before};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple, PyType};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The description of a campaign: a scenario, a driver, the open parameters, the requirements, and the choice of tests.
///
/// `Study("pedestrian-crossing", driver="aeb", open={"friction": (0.3, 0.8)}, strategy="halton", budget=500, seed=0)` is checked as a whole, and
/// never changes. `study.replace(budget=1000)` is another study. The scenario is a name of the catalogue, a file of OpenSCENARIO, or a function
/// of Python with `@paracosm.scenario`. The choices are options of `paracosm-fuzz run`, with the same meaning and defaults:
///
/// - what drives: `driver`, `driver_command`, `driver_settings`, `timeout`, `vehicle`, `vehicle_settings`, `references`
/// - which parameters are open or fixed: `open`, `fix`, `continuous`
/// - files of OpenSCENARIO: `ego` is the entity that the driver gets, and `duration` limits the seconds of a run
/// - `models`: the 3D models of actors in camera images, by the names of the actors
/// - what is required: `spec`, `dense`, `requirements`
/// - which tests run: `strategy`, `budget`, `seed`, `skip`, `k`, `epsilon`, `discrete`, `delta`, `measure`, `batch`, `stop_at_first`
///
/// Raises `Error` if a choice does not exist or makes no sense.
#[pyclass(frozen, module = "paracosm")]
pub struct Study {
    subject: Subject,
    choices: Py<PyDict>,
    inner: paracosm::Study,
}

/// The scenario of a study that names none.
const USUAL: &str = "pedestrian-crossing";

/// The system under test: a driver in a scenario, or a function of Python.
enum Subject {
    Scenario(String),
    Program(Py<Program>),
    Function { name: String, function: Py<PyAny>, space: paracosm::space::Space, is_cube: bool },
}

impl Subject {
    fn another(&self, py: Python) -> Self {
        match self {
            Self::Scenario(name) => Self::Scenario(name.clone()),
            Self::Program(program) => Self::Program(program.clone_ref(py)),
            Self::Function { name, function, space, is_cube } => Self::Function {
                name: name.clone(),
                function: function.clone_ref(py),
                space: space.clone(),
                is_cube: *is_cube,
            },
        }
    }

    /// Reads a scenario: a program of Python, or a name of the catalogue or of a file.
    fn of(scenario: &Bound<PyAny>) -> PyResult<Self> {
        if let Ok(program) = scenario.cast::<Program>() {
            return Ok(Self::Program(program.clone().unbind()));
        }
        if scenario.is_callable() {
            return Err(raised("found a function, expected a scenario: write `@paracosm.scenario` above the function"));
        }
        match scenario.str() {
            Ok(name) if scenario.is_instance_of::<PyString>() || scenario.hasattr("__fspath__")? => {
                Ok(Self::Scenario(name.extract()?))
            }
            _ => Err(raised(format!(
                "found {}, expected a name or a file of a scenario, or a function",
                scenario.repr()?
            ))),
        }
    }

    /// Begins the study.
    fn study(&self, py: Python) -> PyResult<StudyBuilder> {
        Ok(match self.another(py) {
            Self::Scenario(name) => paracosm::Study::of(catalogue().find(&name).map_err(raised)?),
            Self::Program(program) => paracosm::Study::of(program.get().inner.clone()),
            Self::Function { name, function, space, is_cube } => {
                paracosm::Study::of_system(system_of(&name, function, space.clone(), is_cube), space)
            }
        })
    }
}

impl Study {
    /// Returns the study of the library.
    pub fn library(&self) -> &paracosm::Study {
        &self.inner
    }

    /// Returns the study that runs the tests of a file, or that counts the tests of a file as done, with these tests.
    fn with_tests_of(
        &self,
        py: Python,
        tests: Option<PathBuf>,
        extend: Option<PathBuf>,
    ) -> PyResult<(paracosm::Study, Option<Extension>)> {
        if tests.is_some() && extend.is_some() {
            return Err(raised("tests and extend exclude each other: tests run, or they count as done"));
        }
        let study = &self.inner;
        let Some(path) = tests.as_ref().or(extend.as_ref()) else { return Ok((study.clone(), None)) };
        let extension = Extension::read(path, study).map_err(raised)?;
        let mut sampling = study.sampling().clone();
        if tests.is_some() {
            sampling.own = None;
            sampling.strategy = Strategy::GIVEN;
            sampling.budget = extension.record().tests.max(1);
        } else if self.choices.bind(py).get_item("strategy")?.is_none_or(|strategy| strategy.is_none()) {
            sampling.strategy = Strategy::usual(Purpose::Complete);
        }
        Ok((study.sampled(sampling).map_err(raised)?, Some(extension)))
    }

    /// Checks the choices, and builds the study.
    fn made(py: Python, subject: Subject, choices: Option<&Bound<PyDict>>) -> PyResult<Self> {
        let choices = checked(py, choices)?;
        let inner = subject.study(py).and_then(|study| built(study, &choices));
        // A function that builds a world may have been interrupted.
        py.check_signals()?;
        Ok(Self { subject, choices: choices.unbind(), inner: inner? })
    }
}

#[pymethods]
impl Study {
    #[new]
    #[pyo3(signature = (scenario = None, **choices))]
    fn new(py: Python, scenario: Option<&Bound<PyAny>>, choices: Option<&Bound<PyDict>>) -> PyResult<Self> {
        let usual = || Ok(Subject::Scenario(USUAL.to_owned()));
        Self::made(py, scenario.map_or_else(usual, Subject::of)?, choices)
    }

    /// Makes the study of a function of Python over a space. The function gets each test as a dictionary, or as an array if `space` is a number of
    /// dimensions. It returns a robustness (below 0 for a failure), a dictionary with a robustness for each requirement, or a trace: a `Trace`, or
    /// columns with `time`. A trace needs the choice `spec`, a formula. An exception ends the test with the verdict "error". The answer should depend on the
    /// test alone.
    #[classmethod]
    #[pyo3(signature = (function, space, *, name = None, **choices))]
    fn of_function(
        cls: &Bound<PyType>,
        function: &Bound<PyAny>,
        space: &Bound<PyAny>,
        name: Option<String>,
        choices: Option<&Bound<PyDict>>,
    ) -> PyResult<Self> {
        if !function.is_callable() {
            return Err(raised(format!("found {}, expected a function that gets a test", function.repr()?)));
        }
        let own = || function.getattr("__name__").and_then(|name| name.extract::<String>()).ok();
        let name = name.or_else(own).unwrap_or_else(|| "function".to_owned());
        let (inner, is_cube) = match space.cast::<Space>() {
            Ok(space) => (space.get().inner.clone(), false),
            Err(_) => {
                let dims = whole(space).map_err(|_| raised("expected a Space, or a number of dimensions from 1 on"))?;
                (cube(dims)?, true)
            }
        };
        let subject = Subject::Function { name, function: function.clone().unbind(), space: inner, is_cube };
        Self::made(cls.py(), subject, choices)
    }

    /// Returns the same study with other choices. `None` gives a choice its default.
    #[pyo3(signature = (**choices))]
    fn replace(&self, py: Python, choices: Option<&Bound<PyDict>>) -> PyResult<Self> {
        let all = self.choices.bind(py).copy()?;
        let mut subject = self.subject.another(py);
        for (name, value) in choices.into_iter().flatten() {
            match (name.extract::<String>()?.as_str(), &subject) {
                ("scenario", Subject::Scenario(_) | Subject::Program(_)) => subject = Subject::of(&value)?,
                _ => all.set_item(name, value)?,
            }
        }
        Self::made(py, subject, Some(&all))
    }

    /// The scenario or its file; the name of the function for a study of a function.
    #[getter]
    fn scenario(&self) -> &str {
        match &self.subject {
            Subject::Scenario(name) | Subject::Function { name, .. } => name,
            Subject::Program(program) => program.get().inner.name(),
        }
    }

    /// The choices that were made, as a dictionary.
    #[getter]
    fn choices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        deep_copy(self.choices.bind(py))
    }

    /// The space of the open parameters.
    #[getter]
    fn space(&self) -> crate::space::Space {
        self.inner.space().clone().into()
    }

    /// The ids of the requirements.
    #[getter]
    fn requirements(&self) -> Vec<&str> {
        self.inner.requirements().iter().map(|requirement| requirement.id.as_str()).collect()
    }

    /// Runs the study, and writes the log and all results into a new folder, as `paracosm-fuzz run` does.
    ///
    /// `executor` is the number of tests that run at the same time; without it, all cores work. It may be an executor of `concurrent.futures`, a client
    /// of Dask, or a `paracosm.ray.Executor`, so that tests run in other processes and on other machines. Results do not depend on it. With
    /// `resume=True`, a campaign in the folder goes on. A terminal or a notebook shows the progress, unless `progress=False`; a function `progress(done,
    /// budget)` is called some times in a second in its place. After Ctrl-C, the folder has all tests that have ended, and `resume=True` continues
    /// from there. `tests` is a file of tests to run in place of the tests of the strategy, and `extend` is a file of tests that count as done.
    #[pyo3(signature = (
        folder, *, executor = None, resume = false, locate = None, junit = false, progress = None, tests = None, extend = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn run(
        this: &Bound<Self>,
        folder: PathBuf,
        executor: Option<&Bound<PyAny>>,
        resume: bool,
        #[pyo3(from_py_with = maybe_whole)] locate: Option<usize>,
        junit: bool,
        progress: Option<&Bound<PyAny>>,
        tests: Option<PathBuf>,
        extend: Option<PathBuf>,
    ) -> PyResult<Report> {
        let py = this.py();
        let (study, extension) = &this.get().with_tests_of(py, tests, extend)?;
        warn(py, detached(py, &AtomicBool::new(false), || notes_before(study))?.map_err(raised)?)?;
        let supervision = Supervision { threads: attached(), ..Supervision::default() };
        let stop = Arc::clone(&supervision.stop);
        let runner = Runner::new(study).until(supervision);
        let runner = match Executor::of(executor, this.as_any())? {
            Executor::Usual => runner,
            Executor::Threads(tests) => runner.jobs(tests),
            Executor::Crew(crew) => runner.with_crew(crew),
        };
        let runner = extension.iter().fold(runner, Runner::extending);
        let runner = locate.into_iter().fold(runner, Runner::locating);
        let runner = if resume { runner.resuming() } else { runner };
        let runner = if junit { runner.with_junit() } else { runner };
        let (done, budget) = (AtomicUsize::new(0), study.sampling().budget);
        // A campaign that goes on has tests already; trials come in the order of their indices.
        let mut count = |trial: &Trial| done.store(trial.index + 1, Ordering::Relaxed);
        let mut progress = Progress::of(py, progress)?;
        let mut tell = |py: Python| progress.tell(py, done.load(Ordering::Relaxed), budget);
        let report = watched(py, &stop, &mut tell, || runner.run_into(&folder, &mut [&mut count]))?.map_err(raised)?;
        tell(py)?;
        Ok(Report::new(report, folder))
    }

    /// Runs a single test, a dictionary with a value for each open parameter, and returns its result: `verdict`, `robustness` by requirement, `worst` (the
    /// smallest robustness in multiples of the scale of its requirement), `error`, `ticks` and `trace_hash`.
    fn test<'py>(&self, py: Python<'py>, test: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
        let test = test_of(&self.inner, test)?;
        let supervision = Supervision { threads: attached(), ..Supervision::default() };
        let stop = Arc::clone(&supervision.stop);
        let ran = detached(py, &stop, || Ok(Worker::until(&self.inner, supervision)?.run(0, &test).0))?;
        let trial = ran.map_err(|error: LibraryError| raised(error))?;
        outcome_of(py, &trial, worst_of(&self.inner, &trial))
    }

    /// Estimates the probability that a test fails, if the open parameters have the distributions of the space: with the keys of
    /// `paracosm-fuzz likelihood --format json`. The method is "monte-carlo", "qmc" or "subset".
    #[pyo3(signature = (*, method = "monte-carlo", budget = 1000, confidence = 0.95, seed = 0, executor = None))]
    fn likelihood<'py>(
        this: &Bound<'py, Self>,
        method: &str,
        #[pyo3(from_py_with = whole)] budget: usize,
        confidence: f64,
        #[pyo3(from_py_with = whole)] seed: u64,
        executor: Option<&Bound<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let question = Question { method: method.parse().map_err(raised)?, budget, confidence, seed };
        likelihood(this.py(), &this.get().inner, question, Executor::of(executor, this.as_any())?)
    }

    /// Puts suites of tests on trial: what would they have missed? The result has the keys of `audit.json` of `paracosm-fuzz audit`.
    ///
    /// Each suite is a table of tests, the path of a file of tests or of the folder of a campaign, `"halton:40"` for the first 40 tests of a strategy,
    /// or `"grid:4x3"` for an even grid. `mutants` is the number of drivers with defects, `screen` the number of random tests that notice them (128), and
    /// `time_limit` the seconds for each suite.
    #[pyo3(signature = (*suites, mutants = 200, screen = None, seed = 0, time_limit = None, executor = None))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn audit<'py>(
        &self,
        py: Python<'py>,
        suites: Vec<Bound<'py, PyAny>>,
        #[pyo3(from_py_with = whole)] mutants: usize,
        #[pyo3(from_py_with = maybe_whole)] screen: Option<usize>,
        #[pyo3(from_py_with = whole)] seed: u64,
        time_limit: Option<f64>,
        #[pyo3(from_py_with = at_once)] executor: Option<NonZeroUsize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if suites.is_empty() {
            return Err(raised("audit: found no suite, expected at least one, such as \"halton:40\""));
        }
        let space = Space::from(self.inner.space().clone());
        let suite = |(number, found): (usize, &Bound<PyAny>)| {
            if found.is_instance_of::<PyString>() || found.hasattr("__fspath__")? {
                let source = found.str()?.to_string().parse::<Source>().map_err(raised)?;
                return Suite::of(&source, &self.inner, &catalogue()).map_err(raised);
            }
            Suite::new(format!("suite {number}"), tests_of(found, Some(&space))?.points, &self.inner).map_err(raised)
        };
        let suites = (1..).zip(&suites).map(suite).collect::<PyResult<_>>()?;
        let time_limit = time_limit.map(duration).transpose()?;
        audit(
            py,
            &self.inner,
            suites,
            AuditChoices { mutants, screen: screen.unwrap_or(Screen::TESTS), seed, time_limit },
            executor,
        )
    }

    /// Says how to make the study again from a pickle. The function of a study has to be one that can be pickled.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (this, choices) = (py.get_type::<Self>(), self.choices.bind(py).copy()?);
        let arguments = match &self.subject {
            Subject::Scenario(name) => vec![this.into_any(), name.into_pyobject(py)?.into_any()],
            Subject::Program(program) => vec![this.into_any(), program.bind(py).clone().into_any()],
            Subject::Function { name, function, space, is_cube } => {
                choices.set_item("name", name)?;
                let space = match is_cube {
                    true => space.dims().into_pyobject(py)?.into_any(),
                    false => Bound::new(py, Space::from(space.clone()))?.into_any(),
                };
                vec![this.getattr("of_function")?, function.bind(py).clone(), space]
            }
        };
        let partial = py.import("functools")?.getattr("partial")?;
        Ok((partial.call(PyTuple::new(py, arguments)?, Some(&choices))?, PyTuple::empty(py)))
    }

    fn __repr__(&self) -> String {
        let (title, sampling) = (self.inner.title(), self.inner.sampling());
        format!("Study({title}, strategy {sampling}, {} tests)", sampling.budget)
    }
}
