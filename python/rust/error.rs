//! The exception of the package. Its messages are the messages of the library and of the programs.

use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::{PyErr, PyResult, Python, create_exception};
use std::ffi::CString;
use std::fmt::Display;

create_exception!(
    paracosm,
    Error,
    PyValueError,
    "An input is wrong, or the work cannot be done. The message says what was found, what was expected, and what to do."
);

/// Warns the user, as the programs do by a note.
///
/// # Errors
/// The user wants an exception for each warning.
pub fn warn(py: Python, notes: impl IntoIterator<Item = String>) -> PyResult<()> {
    notes.into_iter().try_for_each(|note| {
        let note = CString::new(note.replace('\0', " ")).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &note, 1)
    })
}

/// Makes the exception for an error of the library.
pub fn raised(error: impl Display) -> PyErr {
    Error::new_err(error.to_string())
}
