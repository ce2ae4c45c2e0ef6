//! The exception of the package. Its messages are the messages of the library and of the programs.

use pyo3::exceptions::PyValueError;
use pyo3::{PyErr, create_exception};
use std::fmt::Display;

create_exception!(
    paracosm,
    Error,
    PyValueError,
    "An input is wrong, or the work cannot be done. The message says what was found, what was expected, and what to do."
);

/// Makes the exception for an error of the library.
pub fn raised(error: impl Display) -> PyErr {
    Error::new_err(error.to_string())
}
