//! Arrays of numpy in and out. An array of 64-bit numbers is read where it lies; every other array is converted by numpy.

use crate::error::raised;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Returns an object as an array of 64-bit numbers.
///
/// # Errors
/// Numpy cannot convert the object, or its numbers would lose something: complex numbers, words.
fn numbers<'py>(found: &Bound<'py, PyAny>, what: &str) -> PyResult<Bound<'py, PyAny>> {
    let numpy = found.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (found,));
    let array = array.map_err(|error| raised(format!("{what}: {}", error.value(found.py()))))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !matches!(kind.as_str(), "f" | "i" | "u" | "b") {
        let dtype = array.getattr("dtype")?;
        return Err(raised(format!("{what} has the dtype {dtype}, expected numbers such as float64")));
    }
    let options = PyDict::new(found.py());
    options.set_item("dtype", "float64")?;
    options.set_item("order", "C")?;
    numpy.call_method("asarray", (array,), Some(&options))
}

/// Reads an array of points, with a row for each point.
///
/// # Errors
/// The object is no array of two dimensions.
pub fn points_of<'py>(found: &Bound<'py, PyAny>, what: &str) -> PyResult<PyReadonlyArray2<'py, f64>> {
    let array = numbers(found, what)?;
    match array.cast::<PyArray2<f64>>() {
        Ok(points) => Ok(points.readonly()),
        Err(_) => {
            let shape = array.getattr("shape")?;
            Err(raised(format!(
                "{what} has the shape {shape}, expected (n, d): a row for each of n points in d dimensions"
            )))
        }
    }
}

/// Reads an array of one dimension.
///
/// # Errors
/// The object is no array of one dimension.
pub fn column_of(found: &Bound<PyAny>, what: &str) -> PyResult<Vec<f64>> {
    let array = numbers(found, what)?;
    match array.cast::<PyArray1<f64>>() {
        Ok(column) => Ok(column.readonly().as_array().to_vec()),
        Err(_) => {
            let shape = array.getattr("shape")?;
            Err(raised(format!("{what} has the shape {shape}, expected (n,): a list of n numbers")))
        }
    }
}

/// Returns the number of columns of an array.
pub fn width(array: &PyReadonlyArray2<f64>) -> usize {
    array.shape()[1]
}

/// Returns the rows of an array.
pub fn rows(array: &PyReadonlyArray2<f64>) -> Vec<Vec<f64>> {
    let columns = width(array);
    match array.as_slice() {
        Ok(numbers) if columns > 0 => numbers.chunks_exact(columns).map(<[f64]>::to_vec).collect(),
        _ => array.as_array().rows().into_iter().map(|row| row.to_vec()).collect(),
    }
}

/// Makes an array of points with `dims` columns.
///
/// # Errors
/// Numpy cannot make the array.
pub fn array_of<'py>(py: Python<'py>, points: Vec<f64>, dims: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let count = points.len().checked_div(dims).unwrap_or(0);
    points.into_pyarray(py).reshape([count, dims])
}
