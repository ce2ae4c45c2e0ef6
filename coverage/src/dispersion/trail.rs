//! The pivots of a search, in the order in which it took them, as a trail that others can follow.
//!
//! Anyone who has the points can walk the same tree: cut each box by its pivot, pass over small boxes, and check that
//! nothing is left. Cuts are made in the order of the axes instead of their volumes, so that the walk does not depend
//! on the rounding of volumes. That costs a few percent more pivots, at most a quarter. Without the constraints of
//! later cuts (`Side::kept`) there would be five to ten times as many.

use super::search::{Bar, BoxSearch, Open};
use super::side::{Valid, Volume, Weight};
use crate::PointSet;
use crate::valid::{Bound, ValidPart};

/// Returns the pivots of a search that proves that no empty box is larger than `above`: in its volume, or in its possible weight
/// within the valid part. `go_on` is called at each pivot with the number of points looked at, and may end the search. `None` if
/// `go_on` ended the search, or if a larger empty box exists.
pub(crate) fn trail(
    points: &PointSet,
    valid: Option<&ValidPart>,
    above: f64,
    go_on: impl FnMut(usize) -> bool,
) -> Option<Vec<u32>> {
    match valid {
        Some(valid) => walk(points, Valid(valid, Bound::Possible), above, go_on),
        None => walk(points, Volume, above, go_on),
    }
}

fn walk(points: &PointSet, weight: impl Weight, above: f64, go_on: impl FnMut(usize) -> bool) -> Option<Vec<u32>> {
    let mut search = BoxSearch::with_trail(points, weight, above);
    let found = search.explore(&Open::cube(points, weight), &Bar::new(0.0), above, go_on);
    (found.witness.is_none() && found.open.is_empty() && !found.lost).then(|| search.into_trail())
}
