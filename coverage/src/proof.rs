//! Proofs of upper bounds on dispersion, which can be checked without trusting the search that found them.
//!
//! A tree of boxes proves that no empty box is larger than a given volume. A box of the tree has a pivot: a test
//! strictly inside the box. An empty box inside the box must avoid the pivot on one of its sides, and so lies in one
//! of the `2d` parts that are left when one end of the box moves to the pivot. A box that is small enough is a leaf.
//! The tree follows from its pivots, listed in the order in which the boxes are visited, and from these rules:
//!
//! * The cuts of a box are made in the order of the axes, on each axis first the lower end, then the upper end. A cut
//!   may assume that the empty box lies in none of the parts that the earlier cuts left: that at those ends it
//!   reaches beyond the pivot. An end that must reach beyond a point can no longer be cut at that point, nor further
//!   inside.
//! * The boxes are visited depth-first, the part that the last cut left first.
//! * A box is small enough, and has no pivot, if its volume is at most `1 - MARGIN` times the bound. [`MARGIN`] is
//!   far more than what rounding adds to a product of differences.
//!
//! A claim is about many projections. A projection is a choice of parameters, with values of the discrete parameters
//! among them, and selects the tests that have these values. If none of its parameters is continuous, a box has no
//! sides and its volume is the empty product, 1. Any selected test is then a pivot that leaves no part, so that the
//! same rules hold.

use crate::Projection;
use crate::bracket::Watch;
use crate::dispersion::trail;
use crate::kwise::KwiseError;
use crate::kwise_dispersion::projections;
use crate::{Bracket, Deadline};
use paracosm_space::Point;
use paracosm_space::rules::Rules;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The relative safety margin of a proof against rounding. A box needs no pivot if its volume is at most `1 - MARGIN`
/// times the bound.
pub const MARGIN: f64 = 1e-12;

/// The largest number of bounds to try if the known bound takes too many pivots, or may not be the least possible.
const ATTEMPTS: usize = 10;

/// A bound that exceeds the largest unproved bound by at most this share is not improved further.
const ENOUGH: f64 = 1e-3;

/// The projections of the space for which a bound is proved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// All continuous parameters together, without regard to the discrete parameters. The bound is then a bound on
    /// [`dispersion`](crate::dispersion::dispersion).
    Continuous,
    /// Every choice of the given number of parameters, with all valid values of the chosen discrete parameters. The
    /// bound is then a bound on [`kwise_dispersion`](crate::kwise_dispersion::kwise_dispersion).
    Every(usize),
}

/// The limits of the search for a proof.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    /// The greatest total number of pivots in the proofs for all projections.
    pub pivots: usize,
    /// The deadline of the search for a proof.
    pub deadline: Deadline,
}

/// The proof that the empty boxes of one projection do not exceed a volume.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Proof {
    /// The discrete parameters of the projection with their values, as positions among the discrete parameters and
    /// levels.
    pub fixed: Vec<(usize, usize)>,
    /// The continuous parameters of the projection, as positions among the continuous parameters.
    pub axes: Vec<usize>,
    /// The pivots that prove the bound, as positions among the tests. A pivot is a test that divides a box.
    pub pivots: Vec<usize>,
}

/// A proved upper bound on the volume of empty boxes, with its proofs.
#[derive(Debug, Clone, PartialEq)]
pub struct Proved {
    /// The upper bound on the volume of the empty boxes of all projections.
    pub upper: f64,
    /// A proof of the bound for each projection, in lexicographic order with the continuous parameters first. The list
    /// is empty if the bound is 1, because no volume exceeds 1.
    pub proofs: Vec<Proof>,
}

/// Proves an upper bound on the largest volume of an empty box. The bound is the upper bound of the bracket `volume`, a
/// weaker bound if the budget is too small, or a stronger bound if the bracket is not exact and a stronger bound is
/// found. The bound of an exact bracket is above the volume by a few times [`MARGIN`].
///
/// `rules` are the rules of the discrete parameters, and `dims` is the number of continuous parameters. The result
/// does not depend on the number of threads unless the deadline cuts the search short.
///
/// # Errors
/// There are fewer parameters than the scope needs, or a discrete parameter has no level.
///
/// # Panics
/// A test does not belong to this space.
pub fn prove(
    dims: usize,
    rules: &Rules,
    tests: &[Point],
    scope: Scope,
    volume: Bracket,
    budget: Budget,
) -> Result<Proved, KwiseError> {
    let projections: Vec<Projection> = match scope {
        Scope::Continuous if dims == 0 => return Err(KwiseError::Strength { k: 0, parameters: 0 }),
        Scope::Continuous => vec![Projection { fixed: Vec::new(), axes: (0..dims).collect() }],
        // Each projection needs a pivot.
        Scope::Every(k) => projections(dims, rules, k)?.take(budget.pivots.saturating_add(1)).collect(),
    };
    let mut proved = Proved { upper: 1.0, proofs: Vec::new() };
    if projections.len() > budget.pivots {
        return Ok(proved);
    }
    // No bound below this can be proved: along an axis, n tests leave a gap of 1 / (n + 1).
    let gap = |projection: &Projection| !projection.axes.is_empty();
    let least = if projections.iter().any(gap) { 1.0 / (tests.len() + 1) as f64 } else { 0.0 };
    let mut beyond = volume.lower.max(least);
    let mut goal = volume.upper * (1.0 + 4.0 * MARGIN);
    for attempt in 0..ATTEMPTS {
        if goal >= 1.0 {
            goal = (beyond * proved.upper).sqrt();
        }
        if goal >= 1.0 || budget.deadline.passed() {
            break;
        }
        // The first attempt, at the known bound, may take half of the time.
        let deadline = budget.deadline.part(if attempt == 0 { 0.5 } else { 0.3 });
        match all(&projections, tests, goal, Budget { deadline, ..budget }) {
            Some(proofs) => proved = Proved { upper: goal, proofs },
            None => beyond = goal,
        }
        if proved.upper <= beyond * (1.0 + ENOUGH) {
            break;
        }
        goal = (beyond * proved.upper).sqrt();
    }
    Ok(proved)
}

/// Finds the proofs for all projections, within the budget.
fn all(projections: &[Projection], tests: &[Point], upper: f64, budget: Budget) -> Option<Vec<Proof>> {
    let taken = AtomicUsize::new(0);
    let one = |projection: &Projection| {
        if budget.deadline.passed() {
            return None;
        }
        let selected: Vec<usize> = (0..tests.len()).filter(|&test| projection.selects(&tests[test])).collect();
        let mut watch = Watch::new(budget.deadline);
        let mut go_on = |work| taken.fetch_add(1, Ordering::Relaxed) < budget.pivots && !watch.passed_after(work);
        let pivots = if projection.axes.is_empty() {
            selected.first().filter(|_| go_on(1)).map(|&test| vec![test])
        } else {
            let points = projection.points(selected.iter().map(|&test| &tests[test]));
            let trail = trail(&points, upper * (1.0 - MARGIN), go_on);
            trail.map(|trail| trail.into_iter().map(|point| selected[point as usize]).collect())
        }?;
        Some(Proof { fixed: projection.fixed.clone(), axes: projection.axes.clone(), pivots })
    };
    projections.par_iter().with_max_len(1).map(one).collect()
}
