//! Whole numbers of Python that are not negative: numbers of tests, dimensions and seeds.

use crate::error::raised;
use pyo3::exceptions::{PyOverflowError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use std::num::NonZeroUsize;

/// Reads a whole number from 0 on.
///
/// # Errors
/// It is another number, or no whole number.
pub fn whole<T: TryFrom<u64>>(value: &Bound<PyAny>) -> PyResult<T> {
    let py = value.py();
    // `True` is a number in Python, and hardly ever meant as one.
    let read = if value.is_instance_of::<PyBool>() { Err(PyTypeError::new_err("")) } else { value.extract::<u64>() };
    let number = match read {
        Ok(number) => T::try_from(number).ok(),
        Err(error) if error.is_instance_of::<PyOverflowError>(py) => None,
        Err(_) => return Err(PyTypeError::new_err(format!("found {}, expected a whole number", value.repr()?))),
    };
    let Some(number) = number else {
        let expected = if value.lt(0)? { "from 0 on".to_owned() } else { format!("up to {}", u64::MAX) };
        return Err(raised(format!("found {value}, expected a whole number {expected}")));
    };
    Ok(number)
}

/// Reads a whole number from 0 on, or nothing.
///
/// # Errors
/// As `whole`.
pub fn maybe_whole<T: TryFrom<u64>>(value: &Bound<PyAny>) -> PyResult<Option<T>> {
    if value.is_none() { Ok(None) } else { whole(value).map(Some) }
}

/// Reads a list of whole numbers from 0 on.
///
/// # Errors
/// It is no list, or as `whole`.
pub fn wholes(value: &Bound<PyAny>) -> PyResult<Vec<usize>> {
    let numbers = value.try_iter().map_err(|_| {
        let found = value.repr().map(|text| text.to_string()).unwrap_or_default();
        PyTypeError::new_err(format!("found {found}, expected a list of whole numbers"))
    })?;
    numbers.map(|number| whole(&number?)).collect()
}

/// Reads the number of tests that run at the same time; nothing means all cores.
///
/// # Errors
/// It is no whole number, or less than 1.
pub fn at_once(value: &Bound<PyAny>) -> PyResult<Option<NonZeroUsize>> {
    let Some(number) = maybe_whole::<usize>(value)? else { return Ok(None) };
    let none = || raised(format!("executor is {number}, expected at least 1 test at the same time"));
    NonZeroUsize::new(number).map(Some).ok_or_else(none)
}
