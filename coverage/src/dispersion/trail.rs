//! What a search leaves behind for others to follow: its pivots, in the order in which it took them.
//!
//! Whoever has the points can walk the same tree: cut each box by its pivot, pass over what is small, and see that nothing
//! is left. Cuts are made in the order of the axes rather than of their volumes, so that the walk does not depend on
//! how volumes are rounded; that costs a few percent of pivots, up to a quarter of them. Without the promises of later
//! cuts (`Side::kept`) there would be five to ten times as many.

use super::search::{Bar, BoxSearch, Open};
use crate::PointSet;

/// The pivots of the search for an empty box larger than `above`, which `go_on` may end: it is asked at each pivot and
/// told how many points are looked at. `None` if it was ended, or if there is such a box.
pub(crate) fn trail(points: &PointSet, above: f64, go_on: impl FnMut(usize) -> bool) -> Option<Vec<u32>> {
    let mut search = BoxSearch::with_trail(points, above);
    let found = search.explore(&Open::cube(points), &Bar::new(0.0), above, go_on);
    (found.witness.is_none() && found.open.is_empty() && !found.lost).then(|| search.into_trail())
}
