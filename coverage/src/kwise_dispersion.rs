//! K-wise dispersion: the largest hole that any k parameters show, discrete and continuous parameters together.
//!
//! This number joins both halves of the paper's notion of coverage. Each choice of k parameters, with each combination
//! of values of the chosen discrete parameters, selects tests. The selected tests, projected on the continuous
//! parameters among the k, have a dispersion. The k-wise dispersion is the largest of these dispersions. If none of the
//! k parameters is continuous, the dispersion is 0 if a test has the values and 1 if no test has them. If a failure
//! depends on at most k parameters and takes up more than this share of their values, a test has hit it.
//!
//! Projections have few dimensions, so that the number stays exact even if the dispersion of the whole space is out
//! of reach. Projections are searched in blocks. Within a block each is searched only for holes larger than the
//! largest hole of the earlier blocks. Most searches then end as soon as they begin, and the result does not depend
//! on threads.

use crate::dispersion::{LargestEmptyBox, larger_than};
use crate::kwise::{KwiseCoverage, KwiseError, advance, kwise_coverage, tuple};
use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::valid::{Effort, Validity};
use crate::{Bracket, Deadline, Projection};
use paracosm_space::Point;
use paracosm_space::rules::Rules;
use rayon::prelude::*;
use std::collections::BTreeSet;

impl Measure {
    /// The measure "k-wise dispersion", which is the volume of the largest hole in the space of any k parameters.
    pub const K_WISE_DISPERSION: Self = Self::of(&Descriptor {
        name: "k-wise-dispersion",
        key: "k_wise_dispersion",
        label: "k-wise dispersion",
        title: "k-wise dispersion",
        about: "the largest hole in the space of any k parameters, discrete and continuous parameters together",
        pace: 9,
        compare: Compare::BeyondK,
        method: Computation::KwiseHole,
    });
}

/// The number of projections in a block.
const BLOCK: usize = 64;

/// The k-wise dispersion of a set of tests, with the parameters, values and box of the largest hole.
#[derive(Debug, Clone, PartialEq)]
pub struct KwiseDispersion {
    /// The k-wise dispersion, which is the volume of the largest hole over all choices of k parameters.
    pub volume: Bracket,
    /// The discrete parameters of the largest hole with their values, as positions among the discrete parameters and
    /// levels.
    pub fixed: Vec<(usize, usize)>,
    /// The continuous parameters of the largest hole, as positions among the continuous parameters.
    pub axes: Vec<usize>,
    /// The largest empty box over the continuous parameters in `axes`; `None` if none of the k parameters is
    /// continuous.
    pub witness: Option<LargestEmptyBox>,
}

impl KwiseDispersion {
    /// Makes the k-wise dispersion from the k-wise coverage of tests without continuous parameters. The dispersion is 0
    /// if the tests cover all combinations, otherwise 1.
    pub fn of_coverage(counted: KwiseCoverage) -> Self {
        let (volume, fixed) = match counted.missing.into_iter().next() {
            Some(missing) => (1.0, missing),
            None => (0.0, Vec::new()),
        };
        Self { volume: Bracket::exact(volume), fixed, axes: Vec::new(), witness: None }
    }
}

/// Iterates over all projections, which are all choices of `k` parameters, each with all valid combinations of discrete
/// values. The parameters are `dims` continuous parameters and the discrete parameters of `rules`. The order is
/// lexicographic, with the continuous parameters first.
///
/// # Errors
/// `k` is 0 or more than the number of parameters, or a discrete parameter has no level.
pub fn projections(dims: usize, rules: &Rules, k: usize) -> Result<impl Iterator<Item = Projection>, KwiseError> {
    let all = Projections::new(dims, rules.levels(), k)?;
    Ok(all.filter(|projection| rules.is_valid(&projection.fixed)))
}

/// Computes the largest dispersion over all choices of `k` parameters, with all valid combinations of discrete values.
/// The parameters are `dims` continuous parameters and the discrete parameters of `rules`. If constraints depend on continuous
/// parameters, `valid` gives the valid part of each choice, and dispersions are within this part.
///
/// The result is exact unless `deadline` cuts the search short. Its upper bound is then 1 if some projection was not
/// even begun.
///
/// # Errors
/// `k` is 0 or more than the number of parameters, or a discrete parameter has no level.
///
/// # Panics
/// A test does not belong to this space.
pub fn kwise_dispersion(
    dims: usize,
    rules: &Rules,
    valid: Option<&Validity>,
    tests: &[Point],
    k: usize,
    deadline: Deadline,
) -> Result<KwiseDispersion, KwiseError> {
    if dims == 0
        && let Ok(counted) = kwise_coverage(rules, k, tests.iter().map(|test| &test.discrete[..]))
    {
        // Counting is faster than looking at one combination after the other.
        return Ok(KwiseDispersion::of_coverage(counted));
    }
    let found = worst_of(projections(dims, rules, k)?, valid.map(|valid| (valid, Effort::Quick)), tests, deadline);
    // `None` if the deadline passed before any projection was searched: then 0 is the only known lower bound.
    let mut worst = match found.worst {
        Some(worst) => worst,
        None => {
            let first = projections(dims, rules, k)?.next().expect("some test keeps the rules");
            KwiseDispersion { volume: Bracket::exact(0.0), fixed: first.fixed, axes: Vec::new(), witness: None }
        }
    };
    worst.volume.upper = found.upper.max(worst.volume.lower);
    Ok(worst)
}

/// Computes the largest dispersion of the groups of tests that have the same discrete values. The result is the
/// smallest epsilon for which the tests are (k, epsilon)-covering, if the tests cover k-wise. The result is 1 if there
/// is no test. Dispersions are within the valid part of each row if `valid` is given.
///
/// # Panics
/// There is no continuous parameter, or a test does not belong to the space.
pub fn row_dispersion(dims: usize, valid: Option<&Validity>, tests: &[Point], deadline: Deadline) -> Bracket {
    if tests.is_empty() {
        return Bracket::exact(1.0);
    }
    let rows: BTreeSet<&[usize]> = tests.iter().map(|test| &test.discrete[..]).collect();
    let effort = Effort::for_parts(rows.len() as u64);
    let row =
        |row: &[usize]| Projection { fixed: row.iter().copied().enumerate().collect(), axes: (0..dims).collect() };
    let found = worst_of(rows.into_iter().map(row), valid.map(|valid| (valid, effort)), tests, deadline);
    let lower = found.worst.map_or(0.0, |worst| worst.volume.lower);
    Bracket { lower, upper: found.upper.max(lower) }
}

/// The worst of many projections.
struct Worst {
    /// The projection with the largest hole; `None` if there was no time to look at any projection.
    worst: Option<KwiseDispersion>,
    /// An upper bound on the volume of the holes.
    upper: f64,
}

fn worst_of(
    mut projections: impl Iterator<Item = Projection>,
    valid: Option<(&Validity, Effort)>,
    tests: &[Point],
    deadline: Deadline,
) -> Worst {
    let mut worst: Option<KwiseDispersion> = None;
    let mut upper = 0.0f64;
    loop {
        let block: Vec<Projection> = projections.by_ref().take(BLOCK).collect();
        if block.is_empty() {
            break;
        }
        if deadline.passed() {
            upper = 1.0;
            break;
        }
        let above = worst.as_ref().map_or(f64::NEG_INFINITY, |worst| worst.volume.lower);
        let hole = |projection| hole(projection, valid, tests, above, deadline);
        let found: Vec<_> = block.into_par_iter().map(hole).collect();
        for hole in found.into_iter().flatten() {
            upper = upper.max(hole.volume.upper);
            if worst.as_ref().is_none_or(|worst| hole.volume.lower > worst.volume.lower) {
                worst = Some(hole);
            }
        }
    }
    Worst { worst, upper }
}

/// Returns the largest hole of a projection; `None` if the search proves that the hole is no larger than `above`.
fn hole(
    projection: Projection,
    valid: Option<(&Validity, Effort)>,
    tests: &[Point],
    above: f64,
    deadline: Deadline,
) -> Option<KwiseDispersion> {
    if deadline.passed() {
        let Projection { fixed, axes } = projection;
        return Some(KwiseDispersion { volume: Bracket { lower: 0.0, upper: 1.0 }, fixed, axes, witness: None });
    }
    let mut selected = tests.iter().filter(|test| projection.selects(test));
    let (volume, witness) = if projection.axes.is_empty() {
        let volume = if selected.next().is_some() { 0.0 } else { 1.0 };
        (volume > above).then_some((Bracket::exact(volume), None))
    } else {
        let valid = valid.map(|(valid, effort)| valid.part(&projection, effort));
        // Without a valid test there is no hole.
        if valid.as_ref().is_some_and(|valid| valid.share().upper == 0.0) {
            return None;
        }
        let points = projection.points(selected);
        larger_than(&points, valid.as_deref(), above, deadline).map(|found| (found.volume, Some(found.witness)))
    }?;
    let Projection { fixed, axes } = projection;
    Some(KwiseDispersion { volume, fixed, axes, witness })
}

/// All choices of parameters in lexicographic order, the continuous parameters first, each with all values.
struct Projections<'a> {
    dims: usize,
    /// The number of values of each parameter. It is 1 for a continuous parameter, which is not given any value.
    ways: Vec<usize>,
    levels: &'a [usize],
    /// The parameters of the next choice; `None` after the last choice.
    set: Option<Vec<usize>>,
    /// The number of the next combination of values.
    next: usize,
}

impl<'a> Projections<'a> {
    fn new(dims: usize, levels: &'a [usize], k: usize) -> Result<Self, KwiseError> {
        let parameters = dims + levels.len();
        if k == 0 || k > parameters {
            return Err(KwiseError::Strength { k, parameters });
        }
        if let Some(parameter) = levels.iter().position(|&levels| levels == 0) {
            return Err(KwiseError::NoLevel(parameter));
        }
        let ways = std::iter::repeat_n(1, dims).chain(levels.iter().copied()).collect();
        Ok(Self { dims, ways, levels, set: Some((0..k).collect()), next: 0 })
    }
}

impl Iterator for Projections<'_> {
    type Item = Projection;

    fn next(&mut self) -> Option<Projection> {
        let set = self.set.as_mut()?;
        let values = tuple(&self.ways, set, self.next);
        self.next += 1;
        if self.next == set.iter().map(|&parameter| self.ways[parameter]).product::<usize>() {
            self.next = 0;
            if !advance(set, self.dims + self.levels.len()) {
                self.set = None;
            }
        }
        let (axes, fixed): (Vec<_>, Vec<_>) = values.into_iter().partition(|(parameter, _)| *parameter < self.dims);
        let fixed = fixed.into_iter().map(|(parameter, level)| (parameter - self.dims, level)).collect();
        Some(Projection { fixed, axes: axes.into_iter().map(|(axis, _)| axis).collect() })
    }
}
