//! Proofs of upper bounds on dispersion that can be checked without trusting the search that found them.
//!
//! That no empty box is larger than a volume is shown by a tree of boxes. An empty box inside the box at hand avoids the
//! pivot, a test strictly inside, on one of its sides, and so lies in what is left of the box when one of its `2d`
//! ends moves to the pivot. A box that is small enough is a leaf. The tree follows from its pivots, listed in the order in
//! which the boxes are come by, and from these rules:
//!
//! * The cuts of a box are made in the order of the axes, on each axis first the lower end, then the upper end. Whoever
//!   makes a cut may suppose that the empty box does not lie in what the cuts before left: that it reaches beyond the
//!   pivot at their ends. An end that is to reach beyond a point can no longer be cut there, nor further in.
//! * Boxes are looked at depth-first, what the last cut left before what the others left.
//! * Small enough, and without a pivot, is what has at most `1 - MARGIN` times the volume of the bound, where
//!   [`MARGIN`] is far more than what rounding adds to a product of differences.
//!
//! One claim is about many projections: choices of parameters, with values of the discrete ones among them, which select
//! tests. Where none of the parameters is continuous, a box has no sides, its volume is that of a product without factors,
//! 1, and any selected test is a pivot that leaves nothing of it: the same rules hold.

use crate::bracket::Watch;
use crate::dispersion::trail;
use crate::kwise::KwiseError;
use crate::kwise_dispersion::{Projection, projections};
use crate::{Bracket, Deadline};
use paracosm_space::Point;
use paracosm_space::rules::Rules;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicUsize, Ordering};

/// By how much, as a share, a bound is larger than the volumes that need no pivot.
pub const MARGIN: f64 = 1e-12;

/// How many bounds are tried where the one that is known asks for too much, or is not known to be the least.
const ATTEMPTS: usize = 10;

/// A bound this close to what could not be proved, as a share, is not improved further.
const ENOUGH: f64 = 1e-3;

/// Which projections of the space a claim is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// All continuous parameters at once, whatever the discrete ones: the claim of
    /// [`dispersion`](crate::dispersion::dispersion).
    Continuous,
    /// Every choice of this many parameters, with all values of the discrete ones: the claim of
    /// [`kwise_dispersion`](crate::kwise_dispersion::kwise_dispersion).
    Every(usize),
}

/// What a proof may take.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    /// How many pivots, over all projections.
    pub pivots: usize,
    /// Until when the proof has to be found.
    pub deadline: Deadline,
}

/// The proof for one projection.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Proof {
    /// The values of the discrete parameters among those of the projection: positions among the discrete ones, and
    /// levels.
    pub fixed: Vec<(usize, usize)>,
    /// The continuous parameters, by their position among the continuous ones.
    pub axes: Vec<usize>,
    /// The pivots, as positions of tests.
    pub pivots: Vec<usize>,
}

/// An upper bound with its proofs.
#[derive(Debug, Clone, PartialEq)]
pub struct Proved {
    /// No empty box of any projection has a larger volume.
    pub upper: f64,
    /// A proof for each projection in lexicographic order, the continuous parameters first; none where the bound is 1,
    /// which nothing exceeds.
    pub proofs: Vec<Proof>,
}

/// Proves that no empty box is larger than the upper end of a bracket of the largest volume; where the budget does not
/// allow for that, a weaker bound; and where the bracket is not exact, a stronger one if it finds one. The bound of an
/// exact bracket is above the volume by a few times [`MARGIN`].
///
/// `rules` are of the discrete parameters, `dims` is the number of continuous ones. The
/// result does not depend on the number of threads as long as the deadline does not cut it short.
///
/// # Errors
/// There are not as many parameters as the scope wants, or a discrete parameter has no level.
///
/// # Panics
/// A test is none of this space.
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
        // Each needs a pivot.
        Scope::Every(k) => projections(dims, rules, k)?.take(budget.pivots.saturating_add(1)).collect(),
    };
    let mut proved = Proved { upper: 1.0, proofs: Vec::new() };
    if projections.len() > budget.pivots {
        return Ok(proved);
    }
    // Nothing below this can be proved: along an axis, n tests leave a gap of 1 / (n + 1).
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
        // The bound that is known is worth half of the time.
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

/// Proofs for all projections, within the budget.
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
