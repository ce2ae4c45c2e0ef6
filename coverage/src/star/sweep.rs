//! The star discrepancy of points in the plane, exact by a sweep over the points.
//!
//! The sweep moves the right side of boxes over the points in the order of x. At each position the top of the box may
//! be at the y of any point, or at 1. The tops are divided into blocks of neighbours. For each block the sweep keeps a
//! bound on the differences of its boxes. It was the exact maximum when the block was last looked at. Since then, a
//! point below the whole block has changed all counts of the block by the same number, and a wider box has changed all
//! volumes at least as much as the volume of the block's lowest (or highest) box. So the bound stays close to the
//! truth, at no cost. Only if it exceeds the best difference so far is the block looked at again.
//!
//! The time is O(n sqrt(n)) as long as few blocks are looked at again, which holds for evenly spread points. In the
//! worst case all blocks are looked at again at each position, in O(n^2). The sweep and the general search compute
//! differences in the same way, so both give the same number to the last bit.

use super::sides::Sides;
use crate::deadline::Watch;
use crate::{Deadline, PointSet};
use std::ops::Range;

/// The positions at which the sides of boxes may be, in ascending order, and the points by their positions.
struct Grid {
    /// The right sides: the x of all points, and 1.
    rights: Vec<f64>,
    /// The tops: the y of all points, and 1.
    tops: Vec<f64>,
    /// The points in the order of x, as indices of `rights` and `tops`.
    points: Vec<(usize, usize)>,
}

/// The blocks of tops, and the points to the left of the right side, by their tops.
struct Blocks<'a> {
    sides: &'a Sides<'a>,
    tops: &'a [f64],
    /// The number of tops of a block; the last block may have fewer.
    size: usize,
    /// For each top, the number of points to the left whose y is at most the top, among the points of the block.
    inside: Vec<u32>,
    /// For each block, the number of points to the left whose y is less than the block's lowest top; at last, all
    /// points.
    below: Vec<u32>,
    /// For each block, the constant part of its bounds: for open boxes, and for closed boxes.
    constant: [Vec<f64>; 2],
    best: f64,
    n: f64,
}

/// Computes the star discrepancy of points in the plane; `None` if the deadline passes first.
///
/// # Panics
/// There are no points, or they are not in the plane.
pub(super) fn star_in_the_plane(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let grid = Grid::of(points);
    let sides = Sides::of_anchored_boxes(points);
    let mut blocks = Blocks::over(&grid.tops, &sides);
    let mut watch = Watch::new(deadline);
    let mut next = 0;
    for (index, &right) in grid.rights.iter().enumerate() {
        blocks.look_at_open_boxes(right);
        while let Some(&(_, top)) = grid.points.get(next).filter(|(x, _)| *x == index) {
            blocks.add(top);
            next += 1;
        }
        blocks.look_at_closed_boxes(right);
        if watch.passed_after(2 * blocks.below.len()) {
            return None;
        }
    }
    Some(blocks.best)
}

impl Grid {
    fn of(points: &PointSet) -> Self {
        assert!(points.dims() == 2 && !points.is_empty(), "points in the plane");
        let positions = |axis: usize| {
            let mut all: Vec<f64> = points.iter().map(|point| point[axis]).chain([1.0]).collect();
            all.sort_unstable_by(f64::total_cmp);
            all.dedup();
            all
        };
        let (rights, tops) = (positions(0), positions(1));
        let place = |all: &[f64], x: f64| all.partition_point(|position| *position < x);
        let mut places: Vec<_> =
            points.iter().map(|point| (place(&rights, point[0]), place(&tops, point[1]))).collect();
        places.sort_unstable();
        Self { rights, tops, points: places }
    }
}

impl<'a> Blocks<'a> {
    fn over(tops: &'a [f64], sides: &'a Sides<'a>) -> Self {
        // Looking at all bounds and looking at blocks again then take about the same time.
        let size = 4 * tops.len().isqrt() + 1;
        let count = tops.len().div_ceil(size);
        Self {
            sides,
            tops,
            size,
            inside: vec![0; tops.len()],
            below: vec![0; count + 1],
            constant: [vec![0.0; count], vec![0.0; count]],
            best: 0.0,
            n: sides.points() as f64,
        }
    }

    /// Adds a point with this top to the points to the left.
    fn add(&mut self, top: usize) {
        let block = top / self.size;
        let end = self.tops(block).end;
        self.inside[top..end].iter_mut().for_each(|count| *count += 1);
        self.below[block + 1..].iter_mut().for_each(|count| *count += 1);
    }

    fn tops(&self, block: usize) -> Range<usize> {
        block * self.size..((block + 1) * self.size).min(self.tops.len())
    }

    /// Returns the bound, in points, above which a block has to be looked at. Bounds are rounded some ten times, each
    /// time by half an ulp of n at most.
    fn limit(&self) -> f64 {
        (self.best - 16.0 * f64::EPSILON) * self.n
    }

    /// Compares the volumes of the open boxes up to `right` with their shares of the points to the left.
    fn look_at_open_boxes(&mut self, right: f64) {
        let width = self.n * right;
        for block in 0..self.constant[0].len() {
            let tops = self.tops(block);
            let (lowest, highest) = (tops.start, self.tops[tops.end - 1]);
            let below = self.below[block];
            if self.constant[0][block] - f64::from(below) + width * highest <= self.limit() {
                continue;
            }
            let mut most = f64::NEG_INFINITY;
            for top in tops {
                let count = below + if top == lowest { 0 } else { self.inside[top - 1] };
                most = most.max(right * self.tops[top] - self.sides.share(count as usize));
            }
            self.best = self.best.max(most);
            self.constant[0][block] = most * self.n + f64::from(below) - width * highest;
        }
    }

    /// Compares the shares of the points in the closed boxes up to `right` with the volumes of the boxes.
    fn look_at_closed_boxes(&mut self, right: f64) {
        let width = self.n * right;
        for block in 0..self.constant[1].len() {
            let tops = self.tops(block);
            let lowest = self.tops[tops.start];
            let (below, at_most) = (self.below[block], self.below[block + 1]);
            if self.constant[1][block] + f64::from(at_most) - width * lowest <= self.limit() {
                continue;
            }
            let mut most = f64::NEG_INFINITY;
            for top in tops {
                let count = below + self.inside[top];
                most = most.max(self.sides.share(count as usize) - right * self.tops[top]);
            }
            self.best = self.best.max(most);
            self.constant[1][block] = most * self.n - f64::from(at_most) + width * lowest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::points_in_the_plane;
    use crate::star::{Cell, largest_difference};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_sweep_finds_what_the_general_search_finds(points in points_in_the_plane(150)) {
            let sides = Sides::of_anchored_boxes(&points);
            let searched = largest_difference::<Cell>(&sides, &sides, Deadline::never());
            prop_assert!(searched.is_exact());
            prop_assert_eq!(star_in_the_plane(&points, Deadline::never()), Some(searched.lower));
        }
    }

    #[test]
    fn blocks_are_looked_at_again_when_their_bounds_are_too_weak() {
        // All boxes have large differences: the points lie in a corner.
        let points: Vec<[f64; 2]> = (0..2000).map(|i| [f64::from(i) * 1e-5, f64::from(1999 - i) * 1e-5]).collect();
        let points = PointSet::new(2, &points).unwrap();
        let corner = 0.019_99 * 0.019_99;
        let found = star_in_the_plane(&points, Deadline::never()).unwrap();
        assert!((found - (1.0 - corner)).abs() < 1e-12, "{found}");
    }
}
