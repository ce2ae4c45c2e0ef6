//! Formulas of signal temporal logic, and traces to judge by them.

use crate::arrays::column_of;
use crate::error::raised;
use numpy::{IntoPyArray, PyArray1};
use paracosm::campaign::trace_of;
use paracosm::oracles::{Semantics, Truth};
use paracosm::space::{did_you_mean, nearest};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The signals of a run, with a sample for each tick.
///
/// `Trace({"time": [0.0, 0.1], "speed": [3.0, 3.5]})` takes columns that are as long as each other. `time` is in seconds, and evenly spaced
/// from 0 on. `trace["speed"]` is a column as an array. `complete=False` says that the run went on after the last sample.
#[pyclass(frozen, module = "paracosm")]
pub struct Trace {
    pub inner: paracosm::oracles::Trace,
}

/// Returns the names of the columns of a dictionary or of a data frame.
///
/// # Errors
/// A name is no text.
pub fn named(columns: &Bound<PyAny>) -> PyResult<Vec<String>> {
    match columns.getattr_opt("columns")? {
        Some(names) => names.try_iter()?.map(|name| Ok(name?.str()?.to_string())).collect(),
        None => columns.try_iter()?.map(|name| name?.extract()).collect(),
    }
}

#[pymethods]
impl Trace {
    #[new]
    #[pyo3(signature = (signals, *, complete = true))]
    fn new(signals: &Bound<PyAny>, complete: bool) -> PyResult<Self> {
        let names = named(signals)?;
        let column = |name: String| {
            let samples = column_of(&signals.get_item(&name)?, &format!("signal `{name}`"))?;
            PyResult::Ok((name, samples))
        };
        let samples = names.into_iter().map(column).collect::<PyResult<Vec<_>>>()?;
        let whole = trace_of(&samples).map_err(raised)?;
        if complete {
            return Ok(Self { inner: whole });
        }
        let mut inner = paracosm::oracles::Trace::new(whole.dt(), whole.signals().to_vec());
        whole.rows().for_each(|row| inner.record(row));
        Ok(Self { inner })
    }

    /// The names of the signals, without `time`.
    #[getter]
    fn signals(&self) -> Vec<&str> {
        self.inner.signals().iter().map(String::as_str).collect()
    }

    /// The names of the columns: `time`, and the signals.
    #[getter]
    fn columns(&self) -> Vec<&str> {
        ["time"].into_iter().chain(self.signals()).collect()
    }

    /// The seconds from one sample to the next.
    #[getter]
    fn dt(&self) -> f64 {
        self.inner.dt()
    }

    /// `True` if the run ended with the last sample.
    #[getter]
    fn complete(&self) -> bool {
        self.inner.is_complete()
    }

    /// The hash of the trace. Two equal traces have the same hash on every machine.
    #[getter]
    fn hash(&self) -> String {
        self.inner.hash()
    }

    fn __len__(&self) -> usize {
        self.inner.len()
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if name == "time" {
            let times: Vec<f64> = (0..self.inner.len()).map(|tick| tick as f64 * self.inner.dt()).collect();
            return Ok(times.into_pyarray(py));
        }
        match self.inner.signal(name) {
            Some(samples) => Ok(samples.collect::<Vec<f64>>().into_pyarray(py)),
            None => {
                let meant = did_you_mean(&nearest(name, self.columns()));
                let names = self.signals().join(", ");
                Err(PyKeyError::new_err(format!("no signal is called `{name}`{meant}; the signals are {names}")))
            }
        }
    }

    /// Returns the columns as a dictionary of arrays, for example for `pandas.DataFrame`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        self.columns().into_iter().try_for_each(|name| dict.set_item(name, self.__getitem__(py, name)?))?;
        Ok(dict)
    }

    fn __repr__(&self) -> String {
        format!("Trace({} samples every {} s: {})", self.inner.len(), self.inner.dt(), self.signals().join(", "))
    }
}

/// A formula of signal temporal logic, such as `Formula("always[0,30] (rpm < 4750)")`.
///
/// Raises `Error` with the place if the text is no formula.
#[pyclass(frozen, module = "paracosm")]
pub struct Formula {
    inner: paracosm::oracles::Formula,
}

/// The truth and the robustness of a formula at the beginning of a trace.
#[pyclass(frozen, get_all, module = "paracosm")]
pub struct Evaluation {
    /// `True` if the formula holds, `False` if it is violated, `None` if the trace does not decide it.
    truth: Option<bool>,
    /// The margin by which the formula holds (above 0) or is violated (below 0), for the recorded samples alone.
    robustness: f64,
    /// The lowest robustness that a continuation of the trace can give.
    lower: f64,
    /// The highest robustness that a continuation of the trace can give.
    upper: f64,
    /// The time in seconds, and the part of the formula, that together determine the robustness. `None` if there is no such part.
    cause: Option<(f64, String)>,
}

#[pymethods]
impl Evaluation {
    fn __repr__(&self) -> String {
        let truth = match self.truth {
            Some(true) => "True",
            Some(false) => "False",
            None => "None",
        };
        format!("Evaluation(truth={truth}, robustness={})", self.robustness)
    }
}

#[pymethods]
impl Formula {
    #[new]
    #[pyo3(signature = (text, /))]
    fn new(text: &str) -> PyResult<Self> {
        Ok(Self { inner: text.parse().map_err(|error| raised(format!("{text}: {error}")))? })
    }

    /// The names of the signals that the formula reads.
    #[getter]
    fn signals(&self) -> Vec<&str> {
        self.inner.signals()
    }

    /// The seconds that the formula looks ahead, at most.
    #[getter]
    fn horizon(&self) -> f64 {
        self.inner.horizon()
    }

    /// Evaluates the formula on a trace, or on a dictionary or a data frame with a column for each signal. With `dense=True`, signals are
    /// straight lines between samples, and the formula is about every instant.
    #[pyo3(signature = (trace, *, dense = false))]
    fn evaluate(&self, trace: &Bound<PyAny>, dense: bool) -> PyResult<Evaluation> {
        let made;
        let trace = match trace.cast::<Trace>() {
            Ok(trace) => &trace.get().inner,
            Err(_) => {
                made = Trace::new(trace, true)?;
                &made.inner
            }
        };
        // A formula about signals that the trace lacks has an error that names the most similar signal.
        let text = self.inner.to_string();
        let known = paracosm::oracles::Formula::parse(&text, trace.signals());
        known.map_err(|error| raised(format!("{text}: {error}")))?;
        let time = if dense { Semantics::Dense } else { Semantics::Sampled };
        let evaluation = self.inner.evaluate_in(time, trace).map_err(raised)?;
        let cause = self.inner.explain_in(time, trace).map_err(raised)?;
        Ok(Evaluation {
            truth: match evaluation.truth {
                Truth::Holds => Some(true),
                Truth::Violated => Some(false),
                Truth::Undecided => None,
            },
            robustness: evaluation.robustness,
            lower: evaluation.lower,
            upper: evaluation.upper,
            cause: cause.map(|cause| (cause.time, cause.part.to_string())),
        })
    }

    /// Returns the robustness of the formula on a trace: `evaluate(trace).robustness`.
    #[pyo3(signature = (trace, *, dense = false))]
    fn robustness(&self, trace: &Bound<PyAny>, dense: bool) -> PyResult<f64> {
        Ok(self.evaluate(trace, dense)?.robustness)
    }

    fn __str__(&self) -> String {
        self.inner.to_string()
    }

    fn __repr__(&self) -> String {
        format!("Formula({:?})", self.inner.to_string())
    }
}
