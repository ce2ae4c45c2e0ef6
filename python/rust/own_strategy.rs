//! The strategy of a Python program: an object with `ask` and `tell`, or an engine or a sampler of another package.

use crate::arrays::{points_of, rows};
use crate::busy;
use crate::error::raised;
use crate::space::{levels_of, test_at};
use crate::system::in_words;
use paracosm::campaign::Scales;
use paracosm::generators::{Generator, GeneratorError, OwnStrategy, Request};
use paracosm::space::{Point, Space};
use pyo3::prelude::*;
use std::sync::Arc;

/// Reads a strategy that a study was given; `None` for the name of a strategy of the library.
///
/// # Errors
/// The object is no strategy.
pub fn of_python(given: &Bound<PyAny>) -> PyResult<Option<OwnStrategy>> {
    let found = given.py().import("paracosm._strategies")?.call_method1("as_strategy", (given,))?;
    let Some(name) = found.extract::<Option<String>>()? else { return Ok(None) };
    let given = Arc::new(given.clone().unbind());
    let of = name.clone();
    let strategy = OwnStrategy::new(&name, move |request| {
        Python::attach(|py| {
            let failed = |error| GeneratorError::OwnFailed { name: of.clone(), why: in_words(py, &error) };
            Asked::begun(given.bind(py), request).map_err(failed)
        })
    });
    Ok(Some(strategy))
}

/// A strategy at work.
struct Asked {
    inner: Py<PyAny>,
    space: Space,
    /// The number of levels of each coordinate; 0 for a continuous coordinate.
    levels: Vec<usize>,
    /// The points whose results the strategy does not know yet, with their numbers among the points that it proposed together.
    waiting: Vec<(Point, usize)>,
    /// The number of points in a row that break a constraint.
    refused: usize,
    failure: Option<String>,
}

/// So many points in a row may break a constraint.
const MOST_REFUSED: usize = 5_000;

impl Asked {
    fn begun(given: &Bound<PyAny>, request: &Request) -> PyResult<Box<dyn Generator>> {
        let levels = levels_of(request.space);
        if !request.existing.is_empty() {
            return Err(raised("the strategy of a program cannot complete existing tests"));
        }
        let strategies = given.py().import("paracosm._strategies")?;
        let inner = strategies.call_method1("begun", (given, levels.clone(), request.seed))?.unbind();
        let space = request.space.clone();
        Ok(Box::new(Self { inner, space, levels, waiting: Vec::new(), refused: 0, failure: None }))
    }

    /// Does something with the strategy in Python. The first exception is the failure of the strategy.
    fn unless_failed<T>(&mut self, act: impl FnOnce(&Bound<PyAny>) -> PyResult<T>) -> Option<T> {
        if self.failure.is_some() {
            return None;
        }
        Python::attach(|py| match busy::calling(py, || act(self.inner.bind(py))) {
            Ok(done) => Some(done),
            Err(error) => {
                self.failure = Some(in_words(py, &error));
                None
            }
        })
    }
}

impl Generator for Asked {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let ask = |inner: &Bound<PyAny>| -> PyResult<(usize, Vec<Vec<f64>>)> {
            let (first, points): (usize, Bound<PyAny>) = inner.call_method1("ask", (n,))?.extract()?;
            Ok((first, rows(&points_of(&points, "the points of ask")?)))
        };
        let (first, points) = self.unless_failed(ask).unwrap_or_default();
        let tests: Vec<Point> = points.iter().map(|point| test_at(&self.levels, point)).collect();
        self.waiting.extend(tests.iter().cloned().zip(first..));
        tests
    }

    fn tell(&mut self, tests: &[Point], robustness: &[Option<f64>]) {
        let mut told: (Vec<usize>, Vec<f64>) = Default::default();
        for (test, robustness) in tests.iter().zip(robustness) {
            let Some(at) = self.waiting.iter().position(|(waiting, _)| waiting == test) else { continue };
            told.0.push(self.waiting.remove(at).1);
            let is_allowed = self.space.allows(test);
            self.refused = if is_allowed { 0 } else { self.refused + 1 };
            let without = if is_allowed { f64::NAN } else { Scales::MOST };
            told.1.push(robustness.unwrap_or(without));
        }
        self.unless_failed(|inner| inner.call_method1("tell", told).map(drop));
        if self.refused >= MOST_REFUSED && self.failure.is_none() {
            self.failure = Some(format!("{} points in a row break a constraint of the space", self.refused));
        }
    }

    fn failure(&self) -> Option<String> {
        self.failure.clone()
    }
}
