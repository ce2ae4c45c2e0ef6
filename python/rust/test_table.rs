//! `Tests`: a table of tests of a space, which keeps the coordinates of the tests to the last bit; and tests that a user brings.

use crate::arrays::{points_of, rows, width};
use crate::error::raised;
use crate::space::{Space, cube};
use crate::table::{Column, Table};
use crate::value::{value_of, whole};
use paracosm::campaign::TestSet;
use paracosm::coverage::PointSet;
use paracosm::space::{Parameter, Point, Value, Values, did_you_mean, nearest};
use pyo3::prelude::*;
use pyo3::types::PyMapping;

/// Tests of a space, as a table with a column for each coordinate. A signal has several coordinates, `friction[0]`, `friction[1]` and so on.
#[pyclass(frozen, extends = Table, subclass, module = "paracosm")]
pub struct Tests {
    /// The tests with the coordinates of their values, as a file of the tests would give them back.
    pub set: TestSet,
    /// The tests with the coordinates that a strategy proposed. They may differ in the last bit.
    pub proposed: Vec<Point>,
}

impl Tests {
    /// Makes the table of tests that a strategy proposed.
    ///
    /// # Errors
    /// The tests do not belong to the space.
    pub fn new(space: &Space, proposed: Vec<Point>) -> PyResult<PyClassInitializer<Self>> {
        let Space { inner, demand } = space;
        let tests: Vec<Values> = proposed.iter().map(|point| inner.decode(point)).collect();
        let points = tests.iter().map(|test| inner.encode(test)).collect::<Result<_, _>>().map_err(raised)?;
        let set = TestSet { demand: demand.clone(), ..TestSet::new(inner.clone(), points) };
        Ok(PyClassInitializer::from(Table::new(columns(inner, &tests), tests.len()))
            .add_subclass(Self { set, proposed }))
    }
}

#[pymethods]
impl Tests {
    /// The space of the tests.
    #[getter]
    fn space(&self) -> Space {
        Space { inner: self.set.space.clone(), demand: self.set.demand.clone() }
    }
}

/// Returns a column for each coordinate of the space.
pub fn columns(space: &paracosm::space::Space, tests: &[Values]) -> Vec<(String, Column)> {
    let mut columns = Vec::new();
    for (place, parameter) in space.parameters().iter().enumerate() {
        for index in 0..parameter.coordinates() {
            let value = |test: &Values| {
                let (_, value) = test.iter().nth(place).expect("a test has a value for each parameter");
                value.scalars()[index].clone()
            };
            columns.push((coordinate(parameter, index), column(parameter, tests.iter().map(value).collect())));
        }
    }
    columns
}

fn coordinate(parameter: &Parameter, index: usize) -> String {
    if parameter.signal.is_some() { format!("{}[{index}]", parameter.name) } else { parameter.name.clone() }
}

/// Makes a column of values of a parameter. Whole numbers of a choice stay whole numbers.
fn column(parameter: &Parameter, values: Vec<Value>) -> Column {
    let Some(levels) = parameter.levels() else {
        return Column::Numbers(values.iter().map(|value| value.number().unwrap_or(f64::NAN)).collect());
    };
    let number = |value: &Value| value.number();
    if levels.iter().all(|level| number(level).and_then(whole).is_some()) {
        Column::Counts(values.iter().filter_map(|value| number(value).and_then(whole)).collect())
    } else if levels.iter().all(|level| number(level).is_some()) {
        Column::Numbers(values.iter().filter_map(number).collect())
    } else {
        Column::Words(values.iter().map(|value| Some(value.to_string())).collect())
    }
}

/// Reads the tests of a user: `Tests`; an array of points of the unit cube; or, with a space, a table, a data frame or a dictionary with a
/// column for each coordinate, or an array of values in the order of the space.
///
/// # Errors
/// The object is nothing of this, a column is missing, or a value does not belong to the space. The message names the place.
pub fn tests_of(found: &Bound<PyAny>, space: Option<&Space>) -> PyResult<TestSet> {
    if let Ok(tests) = found.cast::<Tests>() {
        let set = &tests.get().set;
        return match space {
            Some(space) if space.inner != set.space || space.demand != set.demand => Err(raised(
                "these tests belong to another space: leave the argument `space` out, or give the space of the tests",
            )),
            _ => Ok(set.clone()),
        };
    }
    let Some(Space { inner, demand }) = space else {
        let points = points_of(found, "the array of points")?;
        let rows = rows(&points);
        let dims = width(&points);
        let checked = PointSet::new(dims, &rows).map_err(raised)?;
        let points = checked.iter().map(|point| Point { continuous: point.to_vec(), discrete: Vec::new() }).collect();
        return Ok(TestSet::new(cube(dims)?, points));
    };
    let columns = columns_of(found, inner)?;
    let count = columns.first().map_or(0, Vec::len);
    let test = |row: usize| {
        let mut scalars = columns.iter().map(|column| column[row].clone());
        let values = inner.parameters().iter().map(|parameter| {
            let mut values: Vec<Value> = scalars.by_ref().take(parameter.coordinates()).collect();
            let value = if parameter.signal.is_some() { Value::from_iter(values) } else { values.swap_remove(0) };
            (parameter.name.as_str(), value)
        });
        inner.encode(&Values::from_iter(values)).map_err(|error| raised(format!("row {row}: {error}")))
    };
    let points = (0..count).map(test).collect::<PyResult<_>>()?;
    Ok(TestSet { demand: demand.clone(), ..TestSet::new(inner.clone(), points) })
}

/// Reads a column of values for each coordinate of the space. All columns are as long as the first.
fn columns_of(found: &Bound<PyAny>, space: &paracosm::space::Space) -> PyResult<Vec<Vec<Value>>> {
    let names: Vec<String> = space.coordinates().map(|coordinate| coordinate.name()).collect();
    let has_columns = found.cast::<PyMapping>().is_ok() || found.hasattr("columns")?;
    if !has_columns {
        let points = points_of(found, "the array of tests")?;
        let rows = rows(&points);
        let found = width(&points);
        if found != names.len() {
            let message =
                format!("the array of tests has {found} columns, expected {}: {}", names.len(), names.join(", "));
            return Err(raised(message));
        }
        return Ok((0..found).map(|c| rows.iter().map(|row| Value::Number(row[c])).collect()).collect());
    }
    let given: Vec<String> = match found.getattr_opt("columns")? {
        Some(columns) => columns.try_iter()?.map(|name| Ok(name?.str()?.to_string())).collect::<PyResult<_>>()?,
        None => found.try_iter()?.map(|name| Ok(name?.str()?.to_string())).collect::<PyResult<_>>()?,
    };
    let mut columns: Vec<Vec<Value>> = Vec::new();
    for name in &names {
        if !given.contains(name) {
            let meant = did_you_mean(&nearest(name, given.iter().map(String::as_str)));
            return Err(raised(format!("no column is called `{name}`{meant}; the space has {}", names.join(", "))));
        }
        let values = found.get_item(name)?.try_iter()?.map(|value| value_of(&value?, &format!("column `{name}`")));
        let values: Vec<Value> = values.collect::<PyResult<_>>()?;
        if let Some(first) = columns.first().filter(|first| first.len() != values.len()) {
            let (name, found, expected) = (name, values.len(), first.len());
            return Err(raised(format!(
                "column `{name}` has {found} values, expected {expected} as column `{}`",
                names[0]
            )));
        }
        columns.push(values);
    }
    Ok(columns)
}
