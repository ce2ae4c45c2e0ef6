//! A function of Python as the system under test.

use crate::arrays::column_of;
use crate::busy;
use crate::error::{Error, raised};
use crate::formula::{Trace, named};
use crate::value::{is_truth, to_python};
use numpy::IntoPyArray;
use paracosm::campaign::reasons::AnswerFlaw;
use paracosm::campaign::{Answer, BlackBox};
use paracosm::space::{Space, Values, did_you_mean, nearest};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};

/// The id of the requirement of a function that answers with one number.
const ROBUSTNESS: &str = "robustness";

/// Makes the system that calls a function with each test. In a unit cube, the function gets an array; otherwise it gets a dictionary.
pub fn system_of(name: &str, function: Py<PyAny>, space: Space, is_cube: bool) -> BlackBox {
    BlackBox::own(name, move |_, test| {
        Python::attach(|py| {
            let asked = question(py, test, &space, is_cube)
                .and_then(|question| busy::calling(py, || function.bind(py).call1((question,))));
            let answered = asked.and_then(|answer| answer_of(&answer));
            // What the function raises ends the test, and not the campaign.
            answered.unwrap_or_else(|error| Ok(Answer::NotDone { why: in_words(py, &error) }))
        })
    })
}

fn question<'py>(py: Python<'py>, test: &Values, space: &Space, is_cube: bool) -> PyResult<Bound<'py, PyAny>> {
    if is_cube {
        let point: Vec<f64> = test.iter().filter_map(|(_, value)| value.number()).collect();
        return Ok(point.into_pyarray(py).into_any());
    }
    let dict = PyDict::new(py);
    for (name, value) in test.iter() {
        let is_of_choice = space.find(name).is_some_and(|parameter| parameter.levels().is_some());
        dict.set_item(name, to_python(py, value, is_of_choice)?)?;
    }
    Ok(dict.into_any())
}

/// Reads an answer: a trace, columns with `time`, a robustness, or a robustness for each requirement.
fn answer_of(answer: &Bound<PyAny>) -> PyResult<Result<Answer, AnswerFlaw>> {
    if let Ok(trace) = answer.cast::<Trace>() {
        return Ok(Ok(Answer::Trace(trace.get().inner.clone())));
    }
    if is_truth(answer) {
        let message = format!("the function returned {answer}, expected a robustness: a number below 0 for a failure");
        return Err(raised(message));
    }
    if let Ok(robustness) = answer.extract::<f64>() {
        return Ok(Answer::of_robustness(vec![(ROBUSTNESS.to_owned(), robustness)]));
    }
    if answer.cast::<PyMapping>().is_err() && !answer.hasattr("columns")? {
        let found = answer.get_type().name()?;
        let message = format!(
            "the function returned a value of the type {found}, expected a robustness, a Trace, or a dictionary"
        );
        return Err(raised(message));
    }
    let names = named(answer)?;
    if names.iter().any(|name| name == "time") {
        let column = |name: String| {
            let samples = column_of(&answer.get_item(&name)?, &format!("signal `{name}`"))?;
            PyResult::Ok((name, samples))
        };
        let samples = names.into_iter().map(column).collect::<PyResult<Vec<_>>>()?;
        return Ok(paracosm::campaign::trace_of(&samples).map(Answer::Trace).map_err(AnswerFlaw::from));
    }
    let worth = |name: String| {
        let value = answer.get_item(&name)?;
        let number = if is_truth(&value) { None } else { value.extract::<f64>().ok() };
        let missing = || raised(format!("the function returned no number for `{name}`, expected its robustness"));
        let number = number.ok_or_else(missing)?;
        PyResult::Ok((name, number))
    };
    Ok(Answer::of_robustness(names.into_iter().map(worth).collect::<PyResult<_>>()?))
}

/// Returns an exception in a line, with the place in the user's code where it was raised.
pub fn in_words(py: Python, error: &PyErr) -> String {
    let place = || -> PyResult<String> {
        let mut at = error.traceback(py).map(Bound::into_any);
        let mut place = None;
        while let Some(here) = at {
            let code = here.getattr("tb_frame")?.getattr("f_code")?;
            let file: String = code.getattr("co_filename")?.extract()?;
            // The user knows nothing of the package and of the imports of Python.
            if !file.starts_with('<') && !file.contains("paracosm/_") {
                place = Some((file, here.getattr("tb_lineno")?, code.getattr("co_name")?));
            }
            at = here.getattr_opt("tb_next")?.filter(|next| !next.is_none());
        }
        let Some((file, line, function)) = place else { return Ok(String::new()) };
        let file = file.rsplit(['/', '\\']).next().unwrap_or_default();
        Ok(format!(" ({file}, line {line}, in {function})"))
    };
    // The messages of the package speak for themselves.
    let kind = match error.is_instance_of::<Error>(py) {
        true => String::new(),
        false => error.get_type(py).name().map(|name| format!("{name}: ")).unwrap_or_default(),
    };
    format!("{kind}{}{}{}", error.value(py), hints(py, error).unwrap_or_default(), place().unwrap_or_default())
}

/// Returns the notes of an exception, such as the name of a wrong argument, and the name that a wrong name resembles.
fn hints(py: Python, error: &PyErr) -> PyResult<String> {
    let value = error.value(py);
    let mut hints = String::new();
    for note in
        value.getattr_opt("__notes__")?.map(|notes| notes.extract::<Vec<String>>()).transpose()?.into_iter().flatten()
    {
        hints += &format!(", {note}");
    }
    if error.is_instance_of::<PyAttributeError>(py) {
        let wanted: String = value.getattr("name")?.extract()?;
        let names: Vec<String> = value.getattr("obj")?.dir()?.extract()?;
        hints += &did_you_mean(&nearest(&wanted, names.iter().map(String::as_str)));
    }
    Ok(hints)
}
