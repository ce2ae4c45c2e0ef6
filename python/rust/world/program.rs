//! `Program`: a scenario that a function of Python builds.

use super::building::{Building, Files};
use super::scenario::Scenario;
use crate::busy;
use crate::error::raised;
use crate::json::to_dict;
use crate::system::in_words;
use paracosm::campaign::{Holds, Reader, Reason};
use paracosm::{Catalogue, engine};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// The scenarios of this process by their names. The latest of a name counts, because a cell of a notebook runs again.
static PROGRAMS: Mutex<BTreeMap<String, engine::Program>> = Mutex::new(BTreeMap::new());

/// Returns the catalogue of the library with the scenarios of this process, which also reads files of Python.
pub fn catalogue() -> Catalogue {
    let programs = PROGRAMS.lock().unwrap_or_else(PoisonError::into_inner);
    programs.values().cloned().fold(paracosm::catalogue(), Catalogue::with).reading(Reader {
        ending: "py",
        about: "scenarios of Python",
        holds: Holds::Programs,
        read: |file, part| read(file, part).map_err(|error| BrokenFile { error }.into()),
        tests: None,
    })
}

/// Returns the name of each scenario of the catalogue, and its description in one line.
#[pyfunction]
pub fn scenarios() -> Vec<(String, String)> {
    let catalogue = paracosm::catalogue();
    catalogue.programs().iter().map(|program| (program.name().to_owned(), program.about().to_owned())).collect()
}

/// Runs a file of Python, and returns one of its scenarios.
fn read(file: &Path, part: Option<&str>) -> PyResult<engine::Program> {
    Python::attach(|py| {
        let found = py.import("paracosm._scenarios")?.call_method1("_read", (file, part))?;
        Ok(found.cast::<Program>()?.get().inner.clone())
    })
}

/// The error that a Python file has no scenario that can be used.
#[derive(Debug)]
struct BrokenFile {
    error: PyErr,
}

impl fmt::Display for BrokenFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&Python::attach(|py| in_words(py, &self.error)))
    }
}

impl std::error::Error for BrokenFile {}
impl Reason for BrokenFile {}

/// A scenario that a function of Python builds. `@paracosm.scenario` makes it.
#[pyclass(frozen, module = "paracosm")]
pub struct Program {
    pub inner: engine::Program,
    function: Arc<Py<PyAny>>,
    hash: Option<String>,
}

#[pymethods]
impl Program {
    #[new]
    #[pyo3(signature = (function, name, about, hash = None))]
    fn new(function: Py<PyAny>, name: String, about: String, hash: Option<String>) -> PyResult<Self> {
        if paracosm::catalogue().programs().iter().any(|program| program.name() == name) {
            return Err(raised(format!(
                "the catalogue has a scenario `{name}`: give yours another name, `@scenario(name=\"..\")`"
            )));
        }
        let function = Arc::new(function);
        let own = Arc::clone(&function);
        let mut inner = engine::Program::of(name, about, move |scenario| build(&own, &Files::default(), scenario));
        if hash.is_some() {
            inner = inner.of_running_a_file();
        }
        let (own, own_hash) = (Arc::clone(&function), hash.clone());
        inner = inner.of_files([], move |_| files_read(&own, own_hash.as_deref()));
        let mut programs = PROGRAMS.lock().unwrap_or_else(PoisonError::into_inner);
        programs.insert(inner.name().to_owned(), inner.clone());
        Ok(Self { inner, function, hash })
    }

    /// The name: the file and the function, or the function alone if it stands in no file.
    #[getter]
    fn name(&self) -> &str {
        self.inner.name()
    }

    /// The description in one line: the first line of the documentation of the function.
    #[getter]
    fn about(&self) -> &str {
        self.inner.about()
    }

    /// The function.
    #[getter]
    fn function(&self, py: Python) -> Py<PyAny> {
        self.function.clone_ref(py)
    }

    /// The hash of the file; `None` if the function stands in no file.
    #[getter]
    fn hash(&self) -> Option<&str> {
        self.hash.as_deref()
    }

    /// Builds the world in the scenario of another function, which goes on from there.
    fn __call__(&self, py: Python, scenario: &Bound<PyAny>) -> PyResult<Py<PyAny>> {
        self.function.call1(py, (scenario,))
    }

    /// Returns the parameters, the requirements, the premise, the duration and the tick (`dt`, both in seconds) of the scenario.
    ///
    /// Raises `Error` if the world cannot be built with nominal values.
    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let declaration = self.inner.declare().map_err(raised)?;
        let parameter = |declared: &engine::Declared| {
            let mut entries = serde_json::to_value(&declared.parameter).map_err(raised)?;
            entries["open"] = declared.open.into();
            entries["nominal"] = serde_json::to_value(declared.nominal()).map_err(raised)?;
            PyResult::Ok(entries)
        };
        let parameters = declaration.parameters.iter().map(parameter).collect::<PyResult<Vec<_>>>()?;
        let requirements = declaration.requirements.iter();
        let requirements: Vec<_> =
            requirements.map(|one| serde_json::json!({ "id": one.id, "text": one.text, "unit": one.unit })).collect();
        to_dict(
            py,
            &serde_json::json!({
                "parameters": parameters,
                "requirements": requirements,
                "premise": declaration.premise,
                "duration": declaration.duration,
                "dt": declaration.dt,
            }),
        )
    }

    /// Returns the graph of the streams with nominal values, in the language DOT of Graphviz.
    ///
    /// Raises `Error` if the world cannot be built with nominal values.
    fn dot(&self) -> PyResult<String> {
        self.inner.dot().map_err(raised)
    }

    /// Says how to find the scenario again from a pickle: by its module and the name of its function.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Place<'py>)> {
        let function = self.function.bind(py);
        let find = py.import("paracosm._scenarios")?.getattr("_found")?;
        Ok((find, (function.getattr("__module__")?, function.getattr("__qualname__")?)))
    }

    fn __repr__(&self) -> String {
        format!("Program({}: {})", self.inner.name(), self.inner.about())
    }
}

/// The module of a function, and its name in the module.
type Place<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);

/// Returns the files that the world with nominal values reads, with the hash of the scenario's own file. The world is built for this.
fn files_read(function: &Arc<Py<PyAny>>, own: Option<&str>) -> Option<engine::FilesRead> {
    let files = Files::default();
    let (function, read) = (Arc::clone(function), Arc::clone(&files));
    // A world that cannot be built fails when a study builds it.
    let _ = engine::Program::of("files", "", move |scenario| build(&function, &read, scenario)).declare();
    let files = files.lock().unwrap_or_else(PoisonError::into_inner);
    let hashes: Vec<&str> = own.into_iter().chain(files.values().map(String::as_str)).collect();
    let paths = files.keys().cloned().collect();
    (!hashes.is_empty()).then(|| engine::FilesRead { hash: hashes.join("+"), paths })
}

/// Calls the function with a scenario. What it raises is the failure of the scenario.
fn build(function: &Py<PyAny>, files: &Files, scenario: &mut engine::Scenario) {
    let failure = Python::attach(|py| {
        let built = Building::lent(scenario, files, |building| {
            let handle = Bound::new(py, Scenario::of(building))?;
            let returned = busy::calling(py, || function.bind(py).call1((handle,)))?;
            if returned.is_none() {
                return Ok(());
            }
            let found = returned.get_type().name()?;
            Err(raised(format!(
                "the function of the scenario returned a value of the type {found}, expected nothing: it builds in the scenario"
            )))
        });
        let error = built.err()?;
        let why = in_words(py, &error);
        if error.is_instance_of::<PyKeyboardInterrupt>(py) && busy::is_main_thread(py).unwrap_or(false) {
            // The caller gets the interrupt as soon as it looks for signals.
            let _ = py.import("_thread").and_then(|thread| thread.call_method0("interrupt_main"));
        }
        Some(why)
    });
    if let Some(why) = failure {
        scenario.fail(&why);
    }
}
