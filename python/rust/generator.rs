//! `sample` makes a set of tests; `Generator` proposes tests and is told their results.

use crate::arrays::{array_of, column_of};
use crate::covering::rows_of;
use crate::detached::{STOP, detached};
use crate::error::raised;
use crate::measures::duration;
use crate::space::{Space, cube};
use crate::test_table::{Tests, tests_of};
use crate::threads::with_threads;
use crate::value::is_truth;
use crate::whole::{maybe_whole, whole};
use paracosm::campaign::TestSet;
use paracosm::coverage::Deadline;
use paracosm::generators::{DiscreteFamily, Request, Strategy};
use paracosm::space::Point;
use pyo3::prelude::*;
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// The usual limit of a search for a set that reaches an epsilon.
const EPSILON_LIMIT: Duration = Duration::from_secs(60);

/// Returns the name of each strategy, its use in one line, and `True` if it needs the results of the tests.
#[pyfunction]
pub fn strategies() -> Vec<(&'static str, &'static str, bool)> {
    Strategy::all().map(|strategy| (strategy.name(), strategy.about(), strategy.is_adaptive())).collect()
}

/// The space of the tests: one that a user describes, or the unit cube of a number of dimensions.
struct Target {
    space: Space,
    is_cube: bool,
}

impl Target {
    fn of(space: &Bound<PyAny>) -> PyResult<Self> {
        if let Ok(space) = space.cast::<Space>() {
            let Space { inner, demand } = space.get();
            return Ok(Self { space: Space { inner: inner.clone(), demand: demand.clone() }, is_cube: false });
        }
        let dims = whole(space).map_err(|_| raised("expected a Space, or a number of dimensions from 1 on"))?;
        Ok(Self { space: cube(dims)?.into(), is_cube: true })
    }

    /// Returns tests as an array of points if the space is a unit cube, and otherwise as a table.
    fn tests<'py>(&self, py: Python<'py>, points: Vec<Point>) -> PyResult<Bound<'py, PyAny>> {
        if self.is_cube {
            let dims = self.space.inner.dims();
            return Ok(array_of(py, points.into_iter().flat_map(|point| point.continuous).collect(), dims)?.into_any());
        }
        Ok(Bound::new(py, Tests::new(&self.space, points)?)?.into_any())
    }

    /// Reads tests of this space.
    fn points(&self, tests: &Bound<PyAny>) -> PyResult<Vec<Point>> {
        if let Ok(tests) = tests.cast::<Tests>()
            && tests.get().set.space.parameters() == self.space.inner.parameters()
        {
            return Ok(tests.get().proposed.clone());
        }
        let set = tests_of(tests, (!self.is_cube).then_some(&self.space))?;
        let (found, expected) = (set.space.dims(), self.space.inner.dims());
        if found != expected {
            return Err(raised(format!("the points have {found} coordinates, expected {expected}")));
        }
        Ok(set.points)
    }
}

/// The choices for tests beside their space and number.
struct Choices {
    strategy: Strategy,
    seed: Option<u64>,
    skip: Option<u64>,
    k: Option<usize>,
    epsilon: Option<f64>,
    discrete: DiscreteFamily,
    measure: Option<String>,
}

impl Choices {
    fn request<'a>(&self, target: &'a Target, budget: usize, existing: &'a [Point]) -> PyResult<Request<'a>> {
        let &Self { seed, skip, k, epsilon, discrete, .. } = self;
        let aim = self.measure.as_deref().map(|name| name.parse().map_err(raised)).transpose()?;
        Ok(Request { seed, skip, k, epsilon, discrete, aim, existing, ..Request::new(&target.space.inner, budget) })
    }
}

fn family(name: &str, delta: Option<f64>) -> PyResult<DiscreteFamily> {
    name.parse::<DiscreteFamily>().and_then(|family| family.with_delta(delta)).map_err(raised)
}

/// Makes a set of tests by a strategy that needs no results.
///
/// `space` is a `Space`, or the number d of dimensions of a unit cube. In a unit cube, the set is a float64 array of the shape (n, d), with coordinates
/// in [0, 1). Otherwise it is a table, `Tests`.
///
/// n: the number of tests. It may be left out with `epsilon`, and if all parameters are discrete.
/// method: the name of a strategy; `strategies()` lists all.
/// seed: the seed of all random choices. Without a seed, a sequence such as halton is plain.
/// skip: the first index of a sequence.
/// k: the number of discrete parameters in each covered combination (2).
/// epsilon: tests are added until no row of discrete values has an empty box above this volume.
/// measure: the measure that greedy makes small, "dispersion" or "k-wise-dispersion".
/// discrete: the rows of discrete values: "ipog" (a covering array), "random" or "cross". delta: the chance that random rows miss a
/// combination (0.05).
/// existing: tests that the new tests complete; they are not returned.
/// time_limit: the limit in seconds of the search for epsilon (60).
///
/// Raises `Error` if the strategy cannot do what is asked.
#[pyfunction]
#[pyo3(signature = (
    space, n = None, *, method = "halton", seed = None, skip = None, k = None, epsilon = None, measure = None,
    discrete = "ipog", delta = None, existing = None, time_limit = None
))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub fn sample<'py>(
    py: Python<'py>,
    space: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = maybe_whole)] n: Option<usize>,
    method: &str,
    #[pyo3(from_py_with = maybe_whole)] seed: Option<u64>,
    #[pyo3(from_py_with = maybe_whole)] skip: Option<u64>,
    #[pyo3(from_py_with = maybe_whole)] k: Option<usize>,
    epsilon: Option<f64>,
    measure: Option<String>,
    discrete: &str,
    delta: Option<f64>,
    existing: Option<&Bound<'py, PyAny>>,
    time_limit: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let (target, strategy) = (Target::of(space)?, method.parse::<Strategy>().map_err(raised)?);
    if strategy.is_adaptive() {
        let message =
            format!("{strategy} learns from the results of tests: use Generator(space, \"{strategy}\"), or falsify");
        return Err(raised(message));
    }
    let is_discrete = target.space.inner.dims() == 0;
    let budget = match n {
        Some(n) => n,
        None if epsilon.is_some() || is_discrete => usize::MAX,
        None => return Err(raised("the number of tests is missing: sample(space, n=200)")),
    };
    TestSet::check_size(n.unwrap_or(0), target.space.inner.coordinates().count()).map_err(raised)?;
    let choices = Choices { strategy, seed, skip, k, epsilon, discrete: family(discrete, delta)?, measure };
    let existing = existing.map(|tests| target.points(tests)).transpose()?.unwrap_or_default();
    let limit = time_limit.map(duration).transpose()?.unwrap_or(EPSILON_LIMIT);
    let request = choices.request(&target, if is_discrete && n.is_none() { 1 } else { budget }, &existing)?;
    let points = detached(py, &STOP, || -> PyResult<Vec<Point>> {
        let has_array = request.discrete == DiscreteFamily::Ipog && !target.space.inner.levels().is_empty();
        let rows = match has_array && strategy.has_rows(&request) {
            true => Some(rows_of(&target.space, choices.k, choices.seed, &existing)?),
            false => None,
        };
        let deadline = match epsilon {
            Some(_) => Deadline::after(limit).or_when(&STOP),
            None => Deadline::never(),
        };
        let request = Request { rows: rows.as_deref(), deadline, ..request };
        let mut generator = choices.strategy.build(&request).map_err(raised)?;
        // Tests are asked for in parts, so that a number beyond what the strategy has needs no memory.
        let mut points = Vec::new();
        while points.len() < budget && !STOP.load(Ordering::Relaxed) {
            let more = generator.ask(PART.min(budget - points.len()));
            if more.is_empty() {
                break;
            }
            points.extend(more);
        }
        Ok(points)
    })??;
    target.tests(py, points)
}

/// The number of tests of a part. Ctrl-C ends the work after a part.
const PART: usize = 64;

/// A strategy that proposes tests and learns from their results.
///
/// `ask(n)` returns up to `n` new tests, and `tell(tests, robustness)` says how they ended. A robustness is below 0 if a requirement was
/// violated. `None` or NaN says that a test ended in an error. In a unit cube, tests are an array of the shape (n, d); otherwise they are
/// `Tests`.
#[pyclass(frozen, module = "paracosm")]
pub struct Generator {
    target: Target,
    strategy: Strategy,
    inner: Mutex<Box<dyn paracosm::generators::Generator>>,
}

#[pymethods]
impl Generator {
    #[new]
    #[pyo3(signature = (
        space, method = "auto", *, budget = 500, seed = None, skip = None, k = None, epsilon = None, measure = None,
        discrete = "ipog", delta = None, existing = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn new(
        py: Python,
        space: &Bound<PyAny>,
        method: &str,
        #[pyo3(from_py_with = whole)] budget: usize,
        #[pyo3(from_py_with = maybe_whole)] seed: Option<u64>,
        #[pyo3(from_py_with = maybe_whole)] skip: Option<u64>,
        #[pyo3(from_py_with = maybe_whole)] k: Option<usize>,
        epsilon: Option<f64>,
        measure: Option<String>,
        discrete: &str,
        delta: Option<f64>,
        existing: Option<&Bound<PyAny>>,
    ) -> PyResult<Self> {
        let (target, strategy) = (Target::of(space)?, method.parse::<Strategy>().map_err(raised)?);
        let choices = Choices { strategy, seed, skip, k, epsilon, discrete: family(discrete, delta)?, measure };
        let existing = existing.map(|tests| target.points(tests)).transpose()?.unwrap_or_default();
        let request = choices.request(&target, budget, &existing)?;
        let built = detached(py, &STOP, || strategy.build(&request))?;
        Ok(Self { inner: Mutex::new(built.map_err(raised)?), target, strategy })
    }

    /// The name of the strategy.
    #[getter]
    fn method(&self) -> &'static str {
        self.strategy.name()
    }

    /// Returns at most `n` new tests. There are none once the strategy has nothing more to propose.
    #[pyo3(signature = (n = 1))]
    fn ask<'py>(&self, py: Python<'py>, #[pyo3(from_py_with = whole)] n: usize) -> PyResult<Bound<'py, PyAny>> {
        TestSet::check_size(n, self.target.space.inner.coordinates().count()).map_err(raised)?;
        let points = py.detach(|| with_threads(|| self.inner.lock().unwrap_or_else(PoisonError::into_inner).ask(n)));
        self.target.tests(py, points)
    }

    /// Takes the robustness of tests. Strategies without a memory ignore it.
    #[pyo3(signature = (tests, robustness))]
    fn tell(&self, py: Python, tests: &Bound<PyAny>, robustness: &Bound<PyAny>) -> PyResult<()> {
        let points = self.target.points(tests)?;
        let robustness = told(robustness)?;
        if points.len() != robustness.len() {
            let (tests, found) = (points.len(), robustness.len());
            return Err(raised(format!("found {found} values of robustness, expected {tests}, one for each test")));
        }
        let tell = || self.inner.lock().unwrap_or_else(PoisonError::into_inner).tell(&points, &robustness);
        py.detach(|| with_threads(tell));
        Ok(())
    }

    fn __repr__(&self) -> String {
        let parameters = self.target.space.inner.parameters().len();
        format!("Generator({}, {parameters} parameters)", self.strategy)
    }
}

/// Reads the robustness of tests, with `None` for a test that ended in an error.
fn told(robustness: &Bound<PyAny>) -> PyResult<Vec<Option<f64>>> {
    let known = |number: f64| (!number.is_nan()).then_some(number);
    if let Ok(values) = robustness.try_iter() {
        for value in values {
            if is_truth(&value?) {
                return Err(raised("found a truth as a robustness, expected a number: below 0 for a failure"));
            }
        }
    }
    if let Ok(list) = robustness.extract::<Vec<Option<f64>>>() {
        return Ok(list.into_iter().map(|number| number.and_then(known)).collect());
    }
    Ok(column_of(robustness, "the robustness")?.into_iter().map(known).collect())
}
