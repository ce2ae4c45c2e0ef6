//! Values of parameters between Python and the library.

use crate::error::raised;
use paracosm::space::Value;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyList, PyString};

/// Reads a number, a word, or a list of numbers and words. Numbers of numpy are numbers.
///
/// # Errors
/// The object is anything else; the message names the place.
pub fn value_of(found: &Bound<PyAny>, place: &str) -> PyResult<Value> {
    match found.try_iter() {
        // A list in a list is no value, so nothing is read without end.
        Ok(values) if !found.is_instance_of::<PyString>() => {
            values.map(|value| scalar(&value?, place)).collect::<PyResult<Vec<_>>>().map(Value::from_iter)
        }
        _ => scalar(found, place),
    }
}

/// Returns `true` for a truth of Python or of numpy. A truth is no number here, because it has no distance to a violation.
pub fn is_truth(found: &Bound<PyAny>) -> bool {
    let of_numpy = || found.get_type().name().is_ok_and(|name| name == "bool_" || name == "bool");
    found.is_instance_of::<PyBool>() || of_numpy()
}

/// Reads a number or a word.
fn scalar(found: &Bound<PyAny>, place: &str) -> PyResult<Value> {
    if let Ok(word) = found.cast::<PyString>() {
        return Ok(Value::from(word.to_str()?));
    }
    if is_truth(found) {
        return Err(raised(format!(
            "{place}: found {found}, expected a number or a word; write \"{found}\" for a word"
        )));
    }
    if let Ok(number) = found.extract::<f64>() {
        return Ok(Value::Number(number));
    }
    let kind = found.get_type().name()?;
    Err(raised(format!("{place}: found a value of the type {kind}, expected a number or a word")))
}

/// Gives a value to Python. A whole number of a choice is an `int`.
pub fn to_python<'py>(py: Python<'py>, value: &Value, is_of_choice: bool) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Word(word) => Ok(PyString::new(py, word).into_any()),
        Value::List(values) => {
            let values = values.iter().map(|value| to_python(py, value, is_of_choice));
            Ok(PyList::new(py, values.collect::<PyResult<Vec<_>>>()?)?.into_any())
        }
        Value::Number(_) | Value::Written(_) => {
            let number = value.number().unwrap_or(f64::NAN);
            match whole(number).filter(|_| is_of_choice) {
                Some(whole) => Ok(whole.into_pyobject(py)?.into_any()),
                None => Ok(number.into_pyobject(py)?.into_any()),
            }
        }
    }
}

/// Returns the number as an integer if nothing of it is lost.
pub fn whole(number: f64) -> Option<i64> {
    (number.trunc() == number && number.abs() < 9e15).then_some(number as i64)
}
