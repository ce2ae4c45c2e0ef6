//! Parameters: values that each test gives to the scenario. A parameter is a stream, and its value can decide how the world is built.

use super::building::Building;
use crate::error::raised;
use crate::value::to_python;
use paracosm::engine::{Declared, Param};
use paracosm::space::{Domain, Shape, Value};
use pyo3::prelude::*;

/// A parameter of the library, by the type of its values.
pub enum Parameter {
    Number { parameter: Param<f64>, is_choice: bool },
    Word { parameter: Param<Value>, name: String },
}

/// The properties of a parameter besides its name and its values.
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

/// Declares a parameter in a scenario.
///
/// # Errors
/// The shape of the signal does not exist, or the scenario has noted a mistake.
pub fn declared(building: &Building, mut declared: Declared, said: Said) -> PyResult<Parameter> {
    declared.parameter.unit = said.unit;
    declared.parameter.default = said.default.or(declared.parameter.default);
    declared.parameter.signal = said.signal.map(|shape| shape.parse::<Shape>().map_err(raised)).transpose()?;
    declared.opens = said.opens.map(|[lo, hi]| Domain::Interval { lo, hi });
    declared.plausible = said.plausible;
    let name = declared.parameter.name.clone();
    let levels = declared.parameter.levels();
    let is_choice = levels.is_some();
    let has_words = levels.is_some_and(|levels| levels.iter().any(|level| level.number().is_none()));
    let marks = (said.atmospheric, said.incidental);
    building.with(|scenario| match has_words {
        true => Parameter::Word { parameter: marked(scenario.parameter(declared), marks), name },
        false => Parameter::Number { parameter: marked(scenario.number(declared), marks), is_choice },
    })
}

/// Marks a parameter. The library wants the marks in this order.
fn marked<T: Clone>(parameter: Param<T>, (is_atmospheric, is_incidental): (bool, bool)) -> Param<T> {
    let parameter = if is_atmospheric { parameter.atmospheric() } else { parameter };
    if is_incidental { parameter.incidental() } else { parameter }
}

impl Parameter {
    /// Returns the value that the test gives the parameter.
    ///
    /// # Errors
    /// The parameter varies in this test, or the scenario is complete.
    pub fn value<'py>(&self, py: Python<'py>, building: &Building) -> PyResult<Bound<'py, PyAny>> {
        match self {
            Self::Number { parameter, is_choice } => {
                to_python(py, &Value::Number(building.with(|_| parameter.value())?), *is_choice)
            }
            Self::Word { parameter, .. } => to_python(py, &building.with(|_| parameter.value())?, true),
        }
    }
}
