//! `Study`: the description of a campaign, which is checked once and never changes; and running it.

use crate::choices::{built, checked, deep_copy};
use crate::detached::{attached, watched};
use crate::error::raised;
use crate::inquiries::likelihood;
use crate::report::Report;
use crate::space::{Space, cube};
use crate::system::system_of;
use crate::world::{Program, catalogue};
use paracosm::analysis::likelihood::Question;
use paracosm::campaign::{StudyBuilder, Supervision};
use paracosm::{Runner, Trial};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple, PyType};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The description of a campaign: a scenario, a driver, the open parameters, the requirements, and the choice of tests.
///
/// `Study("pedestrian-crossing", driver="aeb", open={"friction": (0.3, 0.8)}, strategy="halton", budget=500, seed=0)` is checked as a whole, and
/// never changes. `study.replace(budget=1000)` is another study. The scenario is a name of the catalogue, a file of OpenSCENARIO, or a function
/// of Python with `@paracosm.scenario`. The choices are the options of `paracosm-fuzz run`, with the same meaning and defaults.
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
                let dims = space.extract::<usize>();
                let dims = dims.map_err(|_| raised("expected a Space, or a number of dimensions from 1 on"))?;
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
    /// `executor` is the number of tests that run at the same time; without it, all cores work. Results do not depend on it. With
    /// `resume=True`, a campaign in the folder goes on. `progress(done, budget)` is called some times in a second. After Ctrl-C, the folder has
    /// all tests that have ended, and `resume=True` continues from there.
    #[pyo3(signature = (folder, *, executor = None, resume = false, locate = None, junit = false, progress = None))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn run(
        &self,
        py: Python,
        folder: PathBuf,
        executor: Option<NonZeroUsize>,
        resume: bool,
        locate: Option<usize>,
        junit: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Report> {
        let supervision = Supervision { threads: attached(), ..Supervision::default() };
        let stop = Arc::clone(&supervision.stop);
        let runner = Runner::new(&self.inner).until(supervision);
        let runner = executor.into_iter().fold(runner, Runner::jobs);
        let runner = locate.into_iter().fold(runner, Runner::locating);
        let runner = if resume { runner.resuming() } else { runner };
        let runner = if junit { runner.with_junit() } else { runner };
        let (done, budget) = (AtomicUsize::new(0), self.inner.sampling().budget);
        let mut count = |_: &Trial| {
            done.fetch_add(1, Ordering::Relaxed);
        };
        let mut told = None;
        let mut tell = |py: Python| {
            let now = Some(done.load(Ordering::Relaxed));
            if now != told {
                told = now;
                progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, (now, budget)).map(drop))?;
            }
            Ok(())
        };
        let report = watched(py, &stop, &mut tell, || runner.run_into(&folder, &mut [&mut count]))?.map_err(raised)?;
        tell(py)?;
        Ok(Report::new(report, folder))
    }

    /// Estimates the probability that a test fails, if the open parameters have the distributions of the space: with the keys of
    /// `paracosm-fuzz likelihood --format json`. The method is "monte-carlo", "qmc" or "subset".
    #[pyo3(signature = (*, method = "monte-carlo", budget = 1000, confidence = 0.95, seed = 0, executor = None))]
    fn likelihood<'py>(
        &self,
        py: Python<'py>,
        method: &str,
        budget: usize,
        confidence: f64,
        seed: u64,
        executor: Option<NonZeroUsize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let question = Question { method: method.parse().map_err(raised)?, budget, confidence, seed };
        likelihood(py, &self.inner, question, executor)
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
