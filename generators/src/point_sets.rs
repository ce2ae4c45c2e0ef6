//! Keeps sets of points that another program has made, by their size.

use paracosm_space::Point;
use std::collections::BTreeMap;

/// Sets of points of the unit cube, by their dimension and their number of points. The sets of one size are numbered from 1 in the order
/// in which they were added.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointSets {
    sets: BTreeMap<(usize, usize), Vec<Vec<Point>>>,
}

impl PointSets {
    /// Adds a set of points, whose coordinates lie in `[0,1]`. A set without points or without coordinates changes nothing.
    pub fn add(&mut self, points: Vec<Point>) {
        let dims = points.first().map_or(0, |point| point.continuous.len());
        if dims > 0 {
            self.sets.entry((dims, points.len())).or_default().push(points);
        }
    }

    /// Returns the number of sets with this number of dimensions and of points.
    pub fn count(&self, dims: usize, points: usize) -> usize {
        self.sets.get(&(dims, points)).map_or(0, Vec::len)
    }

    /// Returns each size of which there is a set: the number of dimensions and the number of points.
    pub fn sizes(&self) -> impl Iterator<Item = (usize, usize)> {
        self.sets.keys().copied()
    }

    /// Returns the set with this number among the sets of a size; `None` if there are fewer.
    pub fn set(&self, dims: usize, points: usize, number: u64) -> Option<&[Point]> {
        let index = usize::try_from(number).ok()?.checked_sub(1)?;
        self.sets.get(&(dims, points))?.get(index).map(Vec::as_slice)
    }
}
