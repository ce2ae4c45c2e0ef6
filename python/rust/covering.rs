//! Covering arrays of discrete parameters.

use crate::detached::{STOP, detached};
use crate::error::{raised, warn};
use crate::measures::duration;
use crate::space::Space;
use crate::test_table::{Tests, tests_of};
use crate::whole::{maybe_whole, whole};
use paracosm::capped_strength;
use paracosm::coverage::Deadline;
use paracosm::generators::Request;
use paracosm::generators::covering::{self, CoveringRequest};
use paracosm::space::Point;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A covering array: tests that contain every valid combination of values of any `k` discrete parameters.
#[pyclass(frozen, extends = Tests, module = "paracosm")]
pub struct CoveringArray {
    /// The strength: the number of parameters in a combination.
    #[pyo3(get)]
    k: usize,
    /// The least number of rows of any covering array for the same request. It is proved.
    #[pyo3(get)]
    lower_bound: u64,
    /// The number of existing tests among the rows. They come first.
    #[pyo3(get)]
    kept: usize,
}

/// A group of discrete parameters, and its strength.
type Group = (Vec<usize>, usize);

/// Makes a covering array for the discrete parameters of a space: few tests that contain every valid combination of values of any k of these parameters.
/// The tests have no values of continuous parameters, and keep the constraints between discrete parameters.
///
/// strengths: groups of parameters with a higher strength, such as {("lanes", "weather", "surface"): 3}.
/// optimise: the seconds of a search for a smaller array. After Ctrl-C, `KeyboardInterrupt` is raised.
/// existing: tests that the array keeps; they come first.
///
/// Raises `Error` if the space has no discrete parameter, or if k is out of range.
#[pyfunction]
#[pyo3(signature = (space, k = None, *, strengths = None, seed = 0, optimise = None, existing = None))]
pub fn covering_array<'py>(
    py: Python<'py>,
    space: &Bound<'py, Space>,
    #[pyo3(from_py_with = maybe_whole)] k: Option<usize>,
    strengths: Option<&Bound<'py, PyDict>>,
    #[pyo3(from_py_with = whole)] seed: u64,
    optimise: Option<f64>,
    existing: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, CoveringArray>> {
    let space = space.get();
    warn(py, capped_strength(k, &space.inner))?;
    let k = strength(space, k)?;
    let space = &Space { inner: space.inner.discrete_part(), demand: space.demand.clone() };
    let groups = strengths.map(|groups| groups_of(groups, space)).transpose()?.unwrap_or_default();
    let existing = existing.map(|tests| tests_of(tests, Some(space))).transpose()?;
    let existing = existing.map(|set| set.points).unwrap_or_default();
    let limit = optimise.map(duration).transpose()?;
    let made = detached(py, &STOP, || {
        with_request(space, k, &groups, seed, &existing, |request| {
            let array = covering::covering_array(request)?;
            Ok(match limit {
                Some(limit) => covering::optimise(request, array, Deadline::after(limit).or_when(&STOP), &|_| ()),
                None => array,
            })
        })
    })??;
    let points = made.rows.iter().map(|row| Point { continuous: Vec::new(), discrete: row.clone() }).collect();
    let array = CoveringArray { k, lower_bound: made.lower_bound, kept: made.kept };
    Bound::new(py, Tests::new(space, points)?.add_subclass(array))
}

/// Makes the rows of a covering array for the discrete parameters of a space.
pub fn rows_of(space: &Space, k: Option<usize>, seed: Option<u64>, existing: &[Point]) -> PyResult<Vec<Vec<usize>>> {
    let k = strength(space, k)?;
    let made = with_request(space, k, &[], seed.unwrap_or(0), existing, covering::covering_array)?;
    Ok(made.rows)
}

fn strength(space: &Space, k: Option<usize>) -> PyResult<usize> {
    Request { k, ..Request::new(&space.inner, 1) }.discrete_strength().map_err(raised)
}

fn with_request(
    space: &Space,
    k: usize,
    groups: &[Group],
    seed: u64,
    existing: &[Point],
    make: impl FnOnce(&CoveringRequest) -> Result<covering::CoveringArray, covering::CoveringError>,
) -> PyResult<covering::CoveringArray> {
    let rules = space.inner.rules().map_err(raised)?;
    let kinds = space.demand.kinds(&space.inner).map_err(raised)?;
    let all: Vec<Group> = space.demand.groups.iter().chain(groups).cloned().collect();
    let mut existing: Vec<Vec<Option<usize>>> =
        existing.iter().map(|test| test.discrete.iter().copied().map(Some).collect()).collect();
    existing.sort_unstable();
    existing.dedup();
    let request =
        CoveringRequest { kinds: &kinds, groups: &all, existing: &existing, seed, ..CoveringRequest::new(&rules, k) };
    make(&request).map_err(raised)
}

/// Reads groups with a higher strength: `{("lanes", "weather", "surface"): 3}`.
fn groups_of(groups: &Bound<PyDict>, space: &Space) -> PyResult<Vec<Group>> {
    let names: Vec<String> = space.inner.discrete().map(|coordinate| coordinate.name()).collect();
    let place = |name: String| {
        let unknown =
            || space.inner.parameter(&name).err().map_or_else(|| format!("`{name}` is a signal"), |e| e.to_string());
        names.iter().position(|own| *own == name).ok_or_else(|| raised(format!("strengths: {}", unknown())))
    };
    let group = |(members, k): (Bound<PyAny>, Bound<PyAny>)| {
        let members = members.extract::<Vec<String>>()?.into_iter().map(place);
        let mut members = members.collect::<PyResult<Vec<_>>>()?;
        members.sort_unstable();
        PyResult::Ok((members, k.extract()?))
    };
    groups.iter().map(group).collect()
}
