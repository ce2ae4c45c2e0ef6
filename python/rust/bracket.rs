//! `Bracket`: a number that is exact, or lies between two certified bounds.

use crate::error::raised;
use crate::value::to_python;
use paracosm::analysis::estimate::{KwiseHole, Measured};
use paracosm::space::{Record, Value};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A number that lies between `lower` and `upper`. Both bounds are certified. The number is exact if they are equal.
///
/// `float(bracket)` is the number if it is exact, and raises `Error` otherwise.
#[pyclass(frozen, module = "paracosm")]
pub struct Bracket {
    /// The lower bound of the number.
    #[pyo3(get)]
    lower: f64,
    /// The upper bound of the number.
    #[pyo3(get)]
    upper: f64,
    empty_box: Option<Record<[f64; 2]>>,
    fixed: Option<Record<Value>>,
    centre: Option<Record<f64>>,
}

impl Bracket {
    /// Makes the bracket of a result; `None` if the result is not known.
    pub fn of(measured: &Measured) -> Option<Self> {
        let bracket = measured.bracket()?;
        let (empty_box, centre) = match measured {
            Measured::Number(_) | Measured::Bracket(_) => (None, None),
            Measured::Hole(hole) => (Some(hole.largest_empty_box.clone()), None),
            Measured::Ball(ball) => (None, ball.as_ref().map(|ball| ball.centre.clone())),
        };
        Some(Self { lower: bracket.lower, upper: bracket.upper, empty_box, fixed: None, centre })
    }

    /// Makes a bracket of the largest hole over any k parameters.
    pub fn of_hole(hole: &KwiseHole) -> Self {
        let (empty_box, fixed) = (Some(hole.worst.empty_box.clone()), Some(hole.worst.fixed.clone()));
        Self { lower: hole.volume.lower, upper: hole.volume.upper, empty_box, fixed, centre: None }
    }

    /// Makes the bracket of an exact number.
    pub fn exact(number: f64) -> Self {
        Self { lower: number, upper: number, empty_box: None, fixed: None, centre: None }
    }
}

#[pymethods]
impl Bracket {
    /// `True` if the number is exact.
    #[getter(exact)]
    fn is_exact(&self) -> bool {
        self.lower == self.upper
    }

    /// The largest empty box that was found: the two ends for each parameter. `None` if the measure has no box.
    #[getter(r#box)]
    fn largest_box<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(record) = &self.empty_box else { return Ok(None) };
        let dict = PyDict::new(py);
        record.iter().try_for_each(|(name, [low, high])| dict.set_item(name, (low, high)))?;
        Ok(Some(dict))
    }

    /// The values of discrete parameters at which the box lies. `None` if the measure has none.
    #[getter]
    fn fixed<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(record) = &self.fixed else { return Ok(None) };
        let dict = PyDict::new(py);
        record.iter().try_for_each(|(name, value)| dict.set_item(name, to_python(py, value, true)?))?;
        Ok(Some(dict))
    }

    /// The centre of the largest empty ball that was found. `None` if the measure has no ball.
    #[getter]
    fn centre<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(record) = &self.centre else { return Ok(None) };
        let dict = PyDict::new(py);
        record.iter().try_for_each(|(name, value)| dict.set_item(name, value))?;
        Ok(Some(dict))
    }

    fn __float__(&self) -> PyResult<f64> {
        if self.lower == self.upper {
            return Ok(self.lower);
        }
        let Self { lower, upper, .. } = self;
        let message =
            format!("the number lies between {lower} and {upper}: use .lower or .upper, or a longer time_limit");
        Err(raised(message))
    }

    fn __repr__(&self) -> String {
        if self.lower == self.upper {
            format!("Bracket({})", self.lower)
        } else {
            format!("Bracket({}, {})", self.lower, self.upper)
        }
    }
}
