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
//!
//! If constraints depend on continuous parameters, a box counts for its share of the valid part of its projection, which is a
//! tree of cells ([`ValidPart`]). The volume of the cells in a box that are not invalid is at least the volume of its valid part,
//! and the volume of all valid cells is at most the volume of the whole valid part. So the first over the second is at least the
//! share of the box. It never grows when a box shrinks, so the same tree of boxes proves a bound on shares. The margin is larger by
//! what rounding adds to a sum over cells.

use crate::deadline::Watch;
use crate::dispersion::trail;
use crate::kwise::KwiseError;
use crate::kwise_dispersion::projections;
use crate::valid::ValidPart;
use crate::{Bracket, Deadline, Projection};
use paracosm_space::Point;
use paracosm_space::rules::Rules;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The relative safety margin of a proof against rounding. A box needs no pivot if its volume is at most `1 - MARGIN`
/// times the bound.
pub const MARGIN: f64 = 1e-12;

/// The least weight of a box that a proof within a valid part can bound. Below it, products of lengths may underflow.
const LEAST_WEIGHT: f64 = 1e-200;

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

impl Scope {
    /// Returns the projections of the scope, but at most the given number. `rules` are the rules of the discrete parameters, and
    /// `dims` is the number of continuous parameters.
    ///
    /// # Errors
    /// There are fewer parameters than the scope needs, or a discrete parameter has no level.
    pub fn projections(self, dims: usize, rules: &Rules, most: usize) -> Result<Vec<Projection>, KwiseError> {
        match self {
            Scope::Continuous if dims == 0 => Err(KwiseError::Strength { k: 0, parameters: 0 }),
            Scope::Continuous => Ok(vec![Projection { fixed: Vec::new(), axes: (0..dims).collect() }]),
            Scope::Every(k) => Ok(projections(dims, rules, k)?.take(most).collect()),
        }
    }
}

/// A projection for which a bound is proved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Target {
    /// The projection.
    pub projection: Projection,
    /// The valid part of the projection, as a position among the given parts; `None` if boxes count for their volume.
    pub part: Option<usize>,
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
    /// The valid part of the projection, as a position among the parts; `None` if boxes count for their volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<usize>,
    /// The pivots that prove the bound, as positions among the tests. A pivot is a test that divides a box.
    pub pivots: Vec<usize>,
}

/// A proved upper bound on the volume of empty boxes, with its proofs.
#[derive(Debug, Clone, PartialEq)]
pub struct Proved {
    /// The upper bound on the volume of the empty boxes of all projections.
    pub upper: f64,
    /// A proof of the bound for each projection, in the given order. The list is empty if the bound is 1, because no volume
    /// exceeds 1.
    pub proofs: Vec<Proof>,
}

/// Proves an upper bound on the largest volume of an empty box in the projections of `targets`. If a target has one of the `parts`,
/// the volume is a share of this part. The bound is the upper bound of the bracket `volume`, a weaker bound if the budget is too
/// small, or a stronger bound if the bracket is not exact and a stronger bound is found. The bound of an exact bracket is above the
/// volume by a few times [`MARGIN`].
///
/// The result does not depend on the number of threads unless the deadline cuts the search short.
///
/// # Panics
/// A test does not belong to the space of the projections, or a part does not exist.
pub fn prove(targets: &[Target], parts: &[Arc<ValidPart>], tests: &[Point], volume: Bracket, budget: Budget) -> Proved {
    let mut proved = Proved { upper: 1.0, proofs: Vec::new() };
    // Each projection needs a pivot.
    if targets.is_empty() || targets.len() > budget.pivots {
        return proved;
    }
    // No bound below this can be proved: along an axis, n tests leave a gap of 1 / (n + 1).
    let gap = |target: &Target| !target.projection.axes.is_empty();
    let least = if targets.iter().any(gap) { 1.0 / (tests.len() + 1) as f64 } else { 0.0 };
    let mut beyond = volume.lower.max(least);
    let of_parts = targets.iter().filter_map(|target| target.part);
    let rounding = of_parts.map(|part| parts[part].rounding()).fold(0.0, f64::max);
    let mut goal = volume.upper * (1.0 + 4.0 * MARGIN + 2.0 * rounding);
    for attempt in 0..ATTEMPTS {
        if goal >= 1.0 {
            goal = (beyond * proved.upper).sqrt();
        }
        if goal >= 1.0 || budget.deadline.passed() {
            break;
        }
        // The first attempt, at the known bound, may take half of the time.
        let deadline = budget.deadline.part(if attempt == 0 { 0.5 } else { 0.3 });
        match all(targets, parts, tests, goal, Budget { deadline, ..budget }) {
            Some(proofs) => proved = Proved { upper: goal, proofs },
            None => beyond = goal,
        }
        if proved.upper <= beyond * (1.0 + ENOUGH) {
            break;
        }
        goal = (beyond * proved.upper).sqrt();
    }
    proved
}

/// Finds the proofs for all projections, within the budget.
fn all(
    targets: &[Target],
    parts: &[Arc<ValidPart>],
    tests: &[Point],
    upper: f64,
    budget: Budget,
) -> Option<Vec<Proof>> {
    let taken = AtomicUsize::new(0);
    let one = |Target { projection, part }: &Target| {
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
            let valid = part.map(|part| &*parts[part]);
            let above = match valid {
                // No box has any possible weight.
                Some(valid) if valid.share().upper == 0.0 => 0.0,
                Some(valid) => Some(valid.weight_for(upper * (1.0 - MARGIN))).filter(|above| *above > LEAST_WEIGHT)?,
                None => upper * (1.0 - MARGIN),
            };
            let trail = trail(&points, valid, above, go_on);
            trail.map(|trail| trail.into_iter().map(|point| selected[point as usize]).collect())
        }?;
        Some(Proof { fixed: projection.fixed.clone(), axes: projection.axes.clone(), part: *part, pivots })
    };
    targets.par_iter().with_max_len(1).map(one).collect()
}
