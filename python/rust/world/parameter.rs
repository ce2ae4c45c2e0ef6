//! `Parameter`: a value that each test gives to the scenario. It is a stream, and its value can decide how the world is built.

use super::building::Building;
use super::stream::{Origin, Stream};
use crate::error::raised;
use crate::value::to_python;
use paracosm::engine::{Declared, Param, Scenario};
use paracosm::space::{Shape, Value};
use pyo3::prelude::*;

/// A parameter of the scenario. It stands wherever a stream of numbers stands. `value()` returns the value of the test that the world is
/// built for.
#[pyclass(frozen, unsendable, extends = Stream, module = "paracosm")]
pub struct Parameter {
    building: Building,
    read: Read,
    is_choice: bool,
}

/// The parameter of the library, by the type of its values.
enum Read {
    Number(Param<f64>),
    Word(Param<Value>),
}

/// What a scenario says about a parameter besides its name and its values.
#[derive(Default)]
pub struct Said {
    pub unit: Option<String>,
    pub default: Option<Value>,
    pub opens: Option<[f64; 2]>,
    pub plausible: Option<[f64; 2]>,
    pub signal: Option<String>,
    pub incidental: bool,
    pub atmospheric: bool,
}

impl Parameter {
    /// Declares a parameter in a scenario.
    ///
    /// # Errors
    /// The shape of the signal does not exist, or the scenario has noted a mistake.
    pub fn declared(py: Python, building: &Building, mut declared: Declared, said: Said) -> PyResult<Py<Self>> {
        declared.parameter.unit = said.unit;
        declared.parameter.default = said.default.or(declared.parameter.default);
        declared.parameter.signal = said.signal.map(|shape| shape.parse::<Shape>().map_err(raised)).transpose()?;
        declared.opens = said.opens.map(|[lo, hi]| paracosm::space::Domain::Interval { lo, hi });
        declared.plausible = said.plausible;
        let name = declared.parameter.name.clone();
        let levels = declared.parameter.levels().map(<[Value]>::to_vec);
        let is_choice = levels.is_some();
        let has_words = levels.is_some_and(|levels| levels.iter().any(|level| level.number().is_none()));
        let marks = (said.atmospheric, said.incidental);
        let read = building.with(|scenario| match has_words {
            true => Read::Word(marked(scenario.parameter(declared), marks)),
            false => Read::Number(marked(number(scenario, declared), marks)),
        })?;
        let origin = match &read {
            Read::Number(parameter) => Origin::Number(parameter.clone()),
            Read::Word(_) => Origin::Word(name),
        };
        let base = PyClassInitializer::from(Stream { building: Some(building.clone()), origin });
        Py::new(py, base.add_subclass(Self { building: building.clone(), read, is_choice }))
    }
}

fn number(scenario: &mut Scenario, declared: Declared) -> Param<f64> {
    scenario.number(declared)
}

fn marked<T: Clone>(mut parameter: Param<T>, (is_atmospheric, is_incidental): (bool, bool)) -> Param<T> {
    if is_atmospheric {
        parameter = parameter.atmospheric();
    }
    if is_incidental {
        parameter = parameter.incidental();
    }
    parameter
}

#[pymethods]
impl Parameter {
    /// Returns the value that this test gives the parameter: a number, or a word of a choice.
    fn value<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let value = self.building.with(|_| match &self.read {
            Read::Number(parameter) => Value::Number(parameter.value()),
            Read::Word(parameter) => parameter.value(),
        })?;
        to_python(py, &value, self.is_choice)
    }
}
