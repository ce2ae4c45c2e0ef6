//! The certificate of an audit: a proof of the largest hole in each row of discrete values.

use super::{Holes, RowHole};
use crate::certificate::{Certificate, Draft, MOST_PIVOTS, Measured};
use paracosm_campaign::TestSet;
use paracosm_coverage::proof::{Budget, Target};
use paracosm_coverage::{Deadline, Projection};

/// The greatest number of rows in a certificate.
const MOST_ROWS: usize = 256;

/// The name of the measure of a claim about one row.
const MEASURE: &str = "hole-of-row";

/// Makes the certificate of the largest hole in each row, until a deadline. Rows with the same points and the same valid part share
/// one proof. All proofs together share the greatest number of pivots.
pub(super) fn certificate(tests: &TestSet, holes: &Holes, deadline: Deadline) -> Certificate {
    let mut draft = Draft::new(tests);
    let rows = &holes.rows[..holes.rows.len().min(MOST_ROWS)];
    let mut first: Vec<(usize, Vec<&[f64]>, Target)> = Vec::new();
    let mut plan = Vec::new();
    for (claim, hole) in rows.iter().enumerate() {
        let fixed = hole.levels.iter().copied().enumerate().collect();
        let projection = Projection { fixed, axes: (0..tests.space.dims()).collect() };
        let selected = tests.points.iter().filter(|point| projection.selects(point));
        let points: Vec<&[f64]> = selected.map(|point| &point.continuous[..]).collect();
        let target = draft.target(projection, hole.part.clone());
        let like = first.iter().find(|(_, known, other)| *known == points && other.part == target.part);
        let like = like.map(|(claim, ..)| *claim);
        if like.is_none() {
            first.push((claim, points, target.clone()));
        }
        plan.push((hole, target, like));
    }
    let (mut waiting, mut pivots) = (first.len(), MOST_PIVOTS);
    for (hole, target, like) in plan {
        let measured = measured(hole, target);
        if let Some(like) = like {
            draft.repeat(measured, like);
            continue;
        }
        let budget = Budget { pivots: pivots / waiting, deadline: deadline.part(1.0 / waiting as f64) };
        pivots -= draft.prove(measured, budget);
        waiting -= 1;
    }
    let all = holes.rows.len();
    draft.finish(
        (all > MOST_ROWS).then(|| format!("the certificate is about the {MOST_ROWS} largest holes of {all} rows")),
    )
}

fn measured(hole: &RowHole, target: Target) -> Measured {
    Measured {
        measure: MEASURE,
        k: None,
        row: Some(hole.levels.clone()),
        excluded: Vec::new(),
        targets: vec![target.clone()],
        volume: hole.volume,
        place: target,
        witness: Some(hole.found.clone()),
    }
}
