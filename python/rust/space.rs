//! `Space`: the parameters of tests, from dictionaries of Python or from files.

use crate::error::raised;
use crate::value::{to_python, value_of};
use crate::whole::whole;
use paracosm::campaign::{SpaceFile, TestSet};
use paracosm::coverage::PointSet;
use paracosm::space::constraint::Constraint;
use paracosm::space::demand::Demand;
use paracosm::space::{Distribution, Domain, Parameter, Point, Value};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple, PyType};
use std::path::PathBuf;

/// The space of the parameters that tests vary.
///
/// `parameters` has a domain for each name: `Interval(low, high)`, `Choice([..])`, or in short a tuple `(low, high)` or a list of values.
/// `constraints` are expressions over the names, such as `"lanes > 2 or speed < 5"`. A test keeps all of them.
///
/// Raises `Error` if a parameter or a constraint makes no sense, or if no test keeps the constraints.
#[pyclass(frozen, module = "paracosm")]
pub struct Space {
    pub inner: paracosm::space::Space,
    /// The further combinations that a PICT model demands.
    pub demand: Demand,
}

impl From<paracosm::space::Space> for Space {
    fn from(inner: paracosm::space::Space) -> Self {
        Self { inner, demand: Demand::default() }
    }
}

#[pymethods]
impl Space {
    #[new]
    #[pyo3(signature = (parameters, constraints = Vec::new()))]
    fn new(parameters: &Bound<PyAny>, constraints: Vec<String>) -> PyResult<Self> {
        let parameters = parameters.cast::<PyDict>().map_err(|_| {
            raised("a space is made of a dictionary, such as {\"speed\": Interval(0.5, 10), \"lanes\": Choice([2, 4])}")
        })?;
        let parameters = parameters.iter().map(|(name, domain)| parameter(&name.extract::<String>()?, &domain));
        let space = paracosm::space::Space::new(parameters.collect::<PyResult<_>>()?).map_err(raised)?;
        let space = space.with_constraints(constraints).map_err(raised)?;
        space.rules().map_err(raised)?;
        Ok(space.into())
    }

    /// Makes the unit cube: `dims` parameters `x1`, `x2` and so on, each in [0, 1].
    #[classmethod]
    #[pyo3(signature = (dims, /))]
    fn cube(_: &Bound<PyType>, #[pyo3(from_py_with = whole)] dims: usize) -> PyResult<Self> {
        Ok(cube(dims)?.into())
    }

    /// Reads a space from a file: SPACE.toml, or a model of PICT (`.pict`, `.txt`, `.model`).
    ///
    /// Raises `Error` with the file and the line if the file makes no sense.
    #[classmethod]
    #[pyo3(signature = (path, /))]
    fn read(cls: &Bound<PyType>, path: PathBuf) -> PyResult<Self> {
        let SpaceFile { space, demand, notes, .. } = SpaceFile::read(&path).map_err(raised)?;
        let warnings = cls.py().import("warnings")?;
        notes.iter().try_for_each(|note| warnings.call_method1("warn", (note,)).map(drop))?;
        Ok(Self { inner: space, demand })
    }

    /// The names of the parameters, in order.
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.inner.parameters().iter().map(|parameter| parameter.name.as_str()).collect()
    }

    /// The constraints, as they were written.
    #[getter]
    fn constraints(&self) -> Vec<&str> {
        self.inner.constraints().iter().map(Constraint::text).collect()
    }

    /// The number of continuous coordinates. A signal has several coordinates.
    #[getter]
    fn dims(&self) -> usize {
        self.inner.dims()
    }

    /// The number of levels of each discrete coordinate.
    #[getter]
    fn levels(&self) -> Vec<usize> {
        self.inner.levels()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.inner == other.inner && self.demand == other.demand
    }

    /// Says how to make the space again from a pickle.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        if self.demand != Demand::default() {
            return Err(raised(
                "a space with the further demands of a PICT model cannot be pickled: pickle the path of its file",
            ));
        }
        let text = serde_json::to_string(&self.inner).map_err(raised)?;
        Ok((py.get_type::<Self>().getattr("_of_json")?, (text,)))
    }

    /// Makes the space of a pickle.
    #[classmethod]
    fn _of_json(_: &Bound<PyType>, text: &str) -> PyResult<Self> {
        Ok(serde_json::from_str::<paracosm::space::Space>(text).map_err(raised)?.into())
    }

    /// Returns the test at a point of the unit cube with a coordinate for each coordinate of the space, in its order; `None` if the test breaks a
    /// constraint.
    fn _test<'py>(&self, py: Python<'py>, point: Vec<f64>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let levels = levels_of(&self.inner);
        if point.len() != levels.len() {
            return Err(raised(format!("found {} coordinates, expected {}", point.len(), levels.len())));
        }
        let test = test_at(&levels, &point);
        if !self.inner.allows(&test) {
            return Ok(None);
        }
        let dict = PyDict::new(py);
        for (name, value) in self.inner.decode(&test).iter() {
            let of_choice = self.inner.parameter(name).is_ok_and(|parameter| parameter.levels().is_some());
            dict.set_item(name, to_python(py, value, of_choice)?)?;
        }
        Ok(Some(dict))
    }

    /// The number of coordinates of a test.
    #[getter]
    fn _coordinates(&self) -> usize {
        self.inner.coordinates().count()
    }

    fn __len__(&self) -> usize {
        self.inner.parameters().len()
    }

    fn __repr__(&self) -> String {
        let parameters = self.inner.parameters().iter().map(|parameter| {
            let unit = parameter.unit.as_ref().map(|unit| format!(" {unit}")).unwrap_or_default();
            format!("{}: {}{unit}", parameter.name, parameter.domain)
        });
        let constraints = self.inner.constraints().iter().map(|constraint| constraint.text().to_owned());
        format!("Space({})", parameters.chain(constraints).collect::<Vec<_>>().join("; "))
    }
}

/// Makes the unit cube.
///
/// # Errors
/// There are 0 dimensions, or too many.
pub fn cube(dims: usize) -> PyResult<paracosm::space::Space> {
    PointSet::new(dims, [[0.0; 0]; 0]).map_err(raised)?;
    TestSet::check_size(1, dims).map_err(raised)?;
    Ok(paracosm::space::Space::unit_cube(dims))
}

/// Returns the number of levels of each coordinate of a space; 0 for a continuous coordinate.
pub fn levels_of(space: &paracosm::space::Space) -> Vec<usize> {
    space.coordinates().map(|coordinate| coordinate.parameter.levels().map_or(0, <[Value]>::len)).collect()
}

/// The greatest coordinate of a test: the right border of the unit cube belongs to no test.
const LAST: f64 = 1.0 - f64::EPSILON / 2.0;

/// Returns the test at a point of the unit cube with its borders. The coordinate of a choice is divided into parts of the same width, one for each
/// level.
pub fn test_at(levels: &[usize], point: &[f64]) -> Point {
    let mut test = Point { continuous: Vec::new(), discrete: Vec::new() };
    for (u, levels) in point.iter().zip(levels) {
        match levels {
            0 => test.continuous.push(u.min(LAST)),
            levels => test.discrete.push(((u * *levels as f64) as usize).min(levels - 1)),
        }
    }
    test
}

/// Reads a parameter: an `Interval` or a `Choice` of the package, or a tuple or a list.
///
/// # Errors
/// The domain is nothing of this. The message names the parameter.
pub fn parameter(name: &str, domain: &Bound<PyAny>) -> PyResult<Parameter> {
    let place = format!("parameter `{name}`");
    let number = |value: Bound<PyAny>| match value_of(&value, &place)?.number() {
        Some(number) => Ok(number),
        None => Err(raised(format!("{place}: found {}, expected a number as the end of an interval", value.repr()?))),
    };
    let of_values = |values: &Bound<PyAny>| {
        let values = values.try_iter()?.map(|value| value_of(&value?, &place));
        PyResult::Ok(Domain::Choice(values.collect::<PyResult<_>>()?))
    };
    if let Ok(ends) = domain.cast::<PyTuple>() {
        if ends.len() != 2 {
            let message = format!(
                "{place}: found a tuple of {}, expected (low, high); a list has the values of a choice",
                ends.len()
            );
            return Err(raised(message));
        }
        let (lo, hi) = (number(ends.get_item(0)?)?, number(ends.get_item(1)?)?);
        return Ok(Parameter::new(name, Domain::Interval { lo, hi }));
    }
    if domain.is_instance_of::<PyList>() {
        return Ok(Parameter::new(name, of_values(domain)?));
    }
    let of = match (domain.getattr_opt("low")?, domain.getattr_opt("values")?) {
        (Some(low), _) => Domain::Interval { lo: number(low)?, hi: number(domain.getattr("high")?)? },
        (None, Some(values)) => of_values(&values)?,
        (None, None) => {
            let found = domain.repr()?;
            let message =
                format!("{place}: found {found}, expected Interval(low, high), Choice([..]), (low, high) or [..]");
            return Err(raised(message));
        }
    };
    let text = |attribute: &str| domain.getattr(attribute)?.extract::<Option<String>>();
    let default = domain.getattr("default")?;
    Ok(Parameter {
        unit: text("unit")?,
        default: if default.is_none() { None } else { Some(value_of(&default, &place)?) },
        signal: text("signal")?.map(|shape| shape.parse()).transpose().map_err(|e| raised(format!("{place}: {e}")))?,
        distribution: match text("distribution")? {
            Some(text) => text.parse::<Distribution>().map_err(|e| raised(format!("{place}: {e}")))?,
            None => Distribution::default(),
        },
        ..Parameter::new(name, of)
    })
}
