//! Makes a sequence of sets that depend on their size, one set for every discrete row.
//!
//! Half of a Latin hypercube is not a Latin hypercube, so a row cannot be given a stretch of a longer set: its set is
//! made for exactly the number of its tests. To the rest of the crate the rows' sets, one after the other, are a
//! sequence like any other, which ends with the budget.

use super::{Sequence, radical::INDICES};
use crate::deal::Deal;

/// A family of point sets, with a set for every size and every row.
pub(crate) trait RowSet: Send + Sync {
    /// Returns the point at `index` of the set of `size` points that belongs to the row `row`.
    fn point(&self, row: u64, size: u64, index: u64) -> Vec<f64>;
}

/// A sequence of the points of all rows' sets, one set after the other.
///
/// The last point of a block stays unused if its row has one test fewer.
pub(crate) struct PerRow<S> {
    deal: Deal,
    set: S,
}

impl<S: RowSet> PerRow<S> {
    pub(crate) fn new(deal: Deal, set: S) -> Self {
        Self { deal, set }
    }
}

impl<S: RowSet> Sequence for PerRow<S> {
    fn len(&self) -> u64 {
        self.deal.indices().min(INDICES)
    }

    fn point(&self, index: u64) -> Vec<f64> {
        let row = index / self.deal.block;
        self.set.point(self.deal.from + row, self.deal.tests_of(row), index % self.deal.block)
    }
}
