//! Functions of Python that a stream calls at every tick, and the values that go to them and come back.

use crate::busy;
use crate::error::raised;
use crate::system::in_words;
use crate::value::is_truth;
use nalgebra::Vector2;
use paracosm::engine::stream::{self, GivenUp};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::panic;
use std::sync::Arc;

/// The type of the values of a stream that a function of Python makes.
#[derive(Clone, Copy)]
pub enum Kind {
    Number,
    Truth,
    Vector,
}

impl Kind {
    /// Reads a type of Python: `float`, `bool`, or `tuple`; `None` is `float`.
    ///
    /// # Errors
    /// The object is none of these types.
    pub fn of(found: Option<&Bound<PyAny>>) -> PyResult<Self> {
        let Some(found) = found else { return Ok(Self::Number) };
        let name = found.getattr("__name__").and_then(|name| name.extract::<String>()).unwrap_or_default();
        match name.as_str() {
            "float" | "int" => Ok(Self::Number),
            "bool" => Ok(Self::Truth),
            "tuple" => Ok(Self::Vector),
            _ => {
                Err(raised(format!("found {}, expected the type of the values: float, bool, or tuple", found.repr()?)))
            }
        }
    }
}

/// A value of a stream, between Python and the library.
pub trait Datum: stream::Datum {
    /// Gives the value to Python.
    fn give(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>>;

    /// Reads the value from Python.
    ///
    /// # Errors
    /// The object has another type.
    fn read(found: &Bound<PyAny>) -> PyResult<Self>;
}

fn wrong(found: &Bound<PyAny>, expected: &str) -> PyErr {
    let found = found.repr().map(|text| text.to_string()).unwrap_or_default();
    raised(format!("found {found}, expected {expected}"))
}

impl Datum for f64 {
    fn give(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(self.into_pyobject(py)?.into_any())
    }

    fn read(found: &Bound<PyAny>) -> PyResult<Self> {
        if is_truth(found) {
            Err(wrong(found, "a number"))
        } else {
            found.extract().map_err(|_| wrong(found, "a number"))
        }
    }
}

impl Datum for bool {
    fn give(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(self.into_pyobject(py)?.to_owned().into_any())
    }

    fn read(found: &Bound<PyAny>) -> PyResult<Self> {
        if is_truth(found) { found.is_truthy() } else { Err(wrong(found, "True or False")) }
    }
}

impl Datum for Vector2<f64> {
    fn give(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(PyTuple::new(py, [self.x, self.y])?.into_any())
    }

    fn read(found: &Bound<PyAny>) -> PyResult<Self> {
        found.extract::<[f64; 2]>().map(|[x, y]| Self::new(x, y)).map_err(|_| wrong(found, "a pair of numbers"))
    }
}

impl Datum for () {
    fn give(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(py.None().into_bound(py))
    }

    fn read(_: &Bound<PyAny>) -> PyResult<Self> {
        Ok(())
    }
}

/// A function of Python that a run calls. What it raises ends the test with an error.
#[derive(Clone)]
pub struct Called(Arc<Py<PyAny>>);

impl Called {
    /// Makes a function of Python callable by a run.
    pub fn new(function: Py<PyAny>) -> Self {
        Self(Arc::new(function))
    }

    /// Returns the result for a value.
    pub fn answer<T: Datum, U: Datum>(&self, value: T) -> U {
        self.unless_raised(|py, function| U::read(&function.call1((value.give(py)?,))?))
    }

    /// Returns the result for the result before and a value.
    pub fn folded<T: Datum, U: Datum>(&self, before: U, value: T) -> U {
        self.unless_raised(|py, function| U::read(&function.call1((before.give(py)?, value.give(py)?))?))
    }

    /// Calls the function, and leaves out its result.
    pub fn told<T: Datum>(&self, value: T) {
        self.unless_raised(|py, function| function.call1((value.give(py)?,)).map(drop));
    }

    /// The evaluation of a stream returns no errors. The runner of a test catches what ends it, so the exception goes there, without the lines
    /// that Rust prints of a panic.
    fn unless_raised<T>(&self, call: impl FnOnce(Python, &Bound<PyAny>) -> PyResult<T>) -> T {
        let answered = Python::attach(|py| {
            let function = self.0.bind(py);
            busy::calling(py, || call(py, function))
                .map_err(|error| format!("{}{}", in_words(py, &error), place_of(function)))
        });
        answered.unwrap_or_else(|why| panic::resume_unwind(Box::new(GivenUp(why))))
    }
}

/// Returns the place of a function in the user's code, for messages; an empty text if it has none.
fn place_of(function: &Bound<PyAny>) -> String {
    let place = || -> PyResult<String> {
        let code = function.getattr("__code__")?;
        let file: String = code.getattr("co_filename")?.extract()?;
        let file = file.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
        Ok(format!(", in the function of a stream at {file}, line {}", code.getattr("co_firstlineno")?))
    };
    place().unwrap_or_default()
}
