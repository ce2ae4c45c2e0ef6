//! `Table`: columns of numbers and words that pandas, polars and every reader of Arrow take.

use crate::error::raised;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray};
use arrow_schema::{DataType, Field, Schema};
use numpy::IntoPyArray;
use paracosm::space::{did_you_mean, nearest};
use pyo3::exceptions::{PyIndexError, PyKeyError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};
use std::sync::Arc;

/// The values of a column. A missing number is NaN.
#[derive(Clone)]
pub enum Column {
    /// Numbers; NaN where a number is missing.
    Numbers(Vec<f64>),
    /// Whole numbers. No number is missing.
    Counts(Vec<i64>),
    /// Words; `None` where a word is missing.
    Words(Vec<Option<String>>),
}

/// A table with named columns, as long as each other.
///
/// `table["speed"]` is a column: an array of numbers, or an array of objects for words. `table[3]` is a row as a dictionary, and `for row in
/// table` goes through all rows. `to_pandas()` and `to_polars()` make data frames. Every reader of the Arrow C stream takes the table as it
/// is: `pyarrow.table(table)`, `polars.DataFrame(table)`, `duckdb.from_arrow(table)`.
#[pyclass(frozen, subclass, module = "paracosm")]
pub struct Table {
    columns: Vec<(String, Column)>,
    len: usize,
}

impl Column {
    fn of_texts<'t>(texts: impl Iterator<Item = &'t str> + Clone) -> Self {
        if let Ok(counts) = texts.clone().map(str::parse).collect() {
            return Self::Counts(counts);
        }
        let number = |text: &str| if text.is_empty() { Ok(f64::NAN) } else { text.parse() };
        match texts.clone().map(number).collect() {
            Ok(numbers) => Self::Numbers(numbers),
            Err(_) => Self::Words(texts.map(|text| (!text.is_empty()).then(|| text.to_owned())).collect()),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Counts(counts) => counts.len(),
            Self::Words(words) => words.len(),
        }
    }

    fn at<'py>(&self, py: Python<'py>, row: usize) -> PyResult<Bound<'py, PyAny>> {
        Ok(match self {
            Self::Numbers(numbers) if numbers[row].is_nan() => py.None().into_bound(py),
            Self::Numbers(numbers) => numbers[row].into_pyobject(py)?.into_any(),
            Self::Counts(counts) => counts[row].into_pyobject(py)?.into_any(),
            Self::Words(words) => words[row].as_deref().into_pyobject(py)?,
        })
    }

    fn array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(match self {
            Self::Numbers(numbers) => numbers.clone().into_pyarray(py).into_any(),
            Self::Counts(counts) => counts.clone().into_pyarray(py).into_any(),
            Self::Words(words) => {
                let options = PyDict::new(py);
                options.set_item("dtype", "object")?;
                py.import("numpy")?.call_method("array", (PyList::new(py, words)?,), Some(&options))?
            }
        })
    }

    fn arrow(&self) -> (DataType, ArrayRef) {
        match self {
            Self::Numbers(numbers) => {
                let numbers = numbers.iter().map(|number| (!number.is_nan()).then_some(*number));
                (DataType::Float64, Arc::new(numbers.collect::<Float64Array>()))
            }
            Self::Counts(counts) => (DataType::Int64, Arc::new(Int64Array::from(counts.clone()))),
            Self::Words(words) => {
                (DataType::Utf8, Arc::new(words.iter().map(Option::as_deref).collect::<StringArray>()))
            }
        }
    }
}

impl Table {
    /// Makes a table of columns that are as long as each other; `len` rows.
    pub fn new(columns: Vec<(String, Column)>, len: usize) -> Self {
        debug_assert!(columns.iter().all(|(_, column)| column.len() == len));
        Self { columns, len }
    }

    /// Makes a table of texts, whose first row has the names of the columns. A column of numbers becomes one; an empty text is a missing value.
    pub fn of_texts(rows: Vec<Vec<String>>) -> Self {
        let mut rows = rows.into_iter();
        let names = rows.next().unwrap_or_default();
        let rows: Vec<Vec<String>> = rows.collect();
        let column = |at: usize| Column::of_texts(rows.iter().map(|row| row[at].as_str()));
        let columns = names.into_iter().enumerate().map(|(at, name)| (name, column(at))).collect();
        Self { columns, len: rows.len() }
    }

    fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|(own, _)| own == name).map(|(_, column)| column)
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// Returns the column of a name, or the row of an index.
    ///
    /// # Errors
    /// There is no such column or row.
    pub fn item<'py>(&self, py: Python<'py>, key: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        if let Ok(name) = key.extract::<String>() {
            let column = self.column(&name).ok_or_else(|| {
                let meant = did_you_mean(&nearest(&name, self.names()));
                let names = self.columns().join(", ");
                PyKeyError::new_err(format!("no column is called `{name}`{meant}; the columns are {names}"))
            })?;
            return column.array(py);
        }
        let index =
            key.extract::<isize>().map_err(|_| raised("expected the name of a column or the index of a row"))?;
        let row = if index < 0 { index + self.len as isize } else { index };
        let row = usize::try_from(row).ok().filter(|row| *row < self.len);
        match row {
            Some(row) => Ok(self.row(py, row)?.into_any()),
            None => Err(PyIndexError::new_err(format!("row {index} of a table with {} rows", self.len))),
        }
    }

    fn row<'py>(&self, py: Python<'py>, row: usize) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        self.columns.iter().try_for_each(|(name, column)| dict.set_item(name, column.at(py, row)?))?;
        Ok(dict)
    }
}

#[pymethods]
impl Table {
    /// The names of the columns, in order.
    #[getter]
    fn columns(&self) -> Vec<&str> {
        self.names().collect()
    }

    fn __len__(&self) -> usize {
        self.len
    }

    fn __getitem__<'py>(&self, py: Python<'py>, key: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.item(py, key)
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows = (0..self.len).map(|row| self.row(py, row)).collect::<PyResult<Vec<_>>>()?;
        Ok(PyList::new(py, rows)?.try_iter()?.into_any())
    }

    fn __repr__(&self) -> String {
        format!("{} rows: {}", self.len, self.columns().join(", "))
    }

    /// Returns the table as the capsule of an Arrow C stream. Readers of Arrow call this method.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // The protocol lets a producer ignore the wish; the reader then converts.
        let _ = requested_schema;
        let (fields, arrays): (Vec<Field>, Vec<ArrayRef>) = self
            .columns
            .iter()
            .map(|(name, column)| {
                let (kind, array) = column.arrow();
                (Field::new(name, kind, true), array)
            })
            .unzip();
        let schema = Arc::new(Schema::new(fields));
        let options = arrow_array::RecordBatchOptions::new().with_row_count(Some(self.len));
        let batch = RecordBatch::try_new_with_options(Arc::clone(&schema), arrays, &options).map_err(raised)?;
        let batches = RecordBatchIterator::new([Ok(batch)], schema);
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(batches)), c"arrow_array_stream")
    }

    /// Returns the table as a `pandas.DataFrame`. Needs pandas.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let columns = PyDict::new(py);
        self.columns.iter().try_for_each(|(name, column)| columns.set_item(name, column.array(py)?))?;
        needed(py, "pandas")?.call_method1("DataFrame", (columns,))
    }

    /// Returns the table as a `polars.DataFrame`. Needs polars.
    fn to_polars<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        needed(slf.py(), "polars")?.call_method1("DataFrame", (slf,))
    }
}

/// Imports a package that only some users have.
fn needed<'py>(py: Python<'py>, package: &str) -> PyResult<Bound<'py, PyModule>> {
    py.import(package).map_err(|error| raised(format!("{package} is needed: pip install {package} ({error})")))
}
