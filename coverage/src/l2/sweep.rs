//! Sums a kernel over all pairs of points on a line or in the plane, in O(n log n).
//!
//! A kernel is a sum of products of a factor of the lower and a factor of the upper argument. The sum over all points
//! `x_l` below a point `x_i` is therefore a sum of products, too: of the sum of the lower factors of all `x_l` with the
//! upper factors of `x_i`. The sweep goes over the points in the order of x, and keeps the sums of the points so far in
//! a tree over y. So each point is compared with all points before it in O(log n) (Heinrich, Efficient algorithms for
//! computing the L2-discrepancy, Math. Comp. 65, 1996, has the same bound by divide and conquer).

use super::{Compensated, Kernel};
use crate::deadline::Watch;
use crate::{Deadline, PointSet};

/// The sums of some numbers over ranges of ranks, as a binary tree: each node has the sum of its two children. Rounding
/// grows with the depth of the tree only.
struct Tree<const TERMS: usize> {
    nodes: Vec<[f64; TERMS]>,
    leaves: usize,
}

impl<const TERMS: usize> Tree<TERMS> {
    fn new(ranks: usize) -> Self {
        let leaves = ranks.next_power_of_two();
        Self { nodes: vec![[0.0; TERMS]; 2 * leaves], leaves }
    }

    /// Sets the numbers of a rank.
    fn set(&mut self, rank: usize, numbers: [f64; TERMS]) {
        let mut at = self.leaves + rank;
        self.nodes[at] = numbers;
        while at > 1 {
            at /= 2;
            self.nodes[at] = std::array::from_fn(|i| self.nodes[2 * at][i] + self.nodes[2 * at + 1][i]);
        }
    }

    /// Returns the sums over all ranks below `rank`.
    fn below(&self, rank: usize) -> [f64; TERMS] {
        let (mut at, mut sums) = (self.leaves + rank, [0.0; TERMS]);
        while at > 1 {
            if at % 2 == 1 {
                sums.iter_mut().zip(self.nodes[at - 1]).for_each(|(sum, number)| *sum += number);
            }
            at /= 2;
        }
        sums
    }
}

/// Returns the sum of the kernel over all pairs of points; `None` if the deadline passes first.
///
/// # Panics
/// The points are neither on a line nor in the plane.
pub(super) fn sum<const TERMS: usize, K: Kernel<TERMS>>(points: &PointSet, deadline: Deadline) -> Option<f64> {
    assert!(points.dims() <= 2, "points on a line or in the plane");
    let n = points.len();
    let order = |axis: usize| {
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|a, b| points.point(*a)[axis].total_cmp(&points.point(*b)[axis]));
        order
    };
    let along_x = order(0);
    let mut sum = Compensated::default();
    if points.dims() == 1 {
        let mut lower = [Compensated::default(); TERMS];
        for x in along_x.into_iter().map(|point| points.point(point)[0]) {
            let (below, above) = (K::lower(x), K::upper(x));
            sum.add(2.0 * dot(lower.map(Compensated::sum), above) + dot(below, above));
            lower.iter_mut().zip(below).for_each(|(sum, factor)| sum.add(factor));
        }
        return Some(sum.sum());
    }
    let mut ranks = vec![0; n];
    order(1).into_iter().enumerate().for_each(|(rank, point)| ranks[point] = rank);
    let mut watch = Watch::new(deadline);
    // One factor along x after the other, so that the trees are small.
    for term in 0..TERMS {
        // Of the points so far: those below a point by their ranks from below, those above it by their ranks from above.
        let (mut from_below, mut from_above) = (Tree::<TERMS>::new(n), Tree::<TERMS>::new(n));
        for &point in &along_x {
            let [x, y] = [points.point(point)[0], points.point(point)[1]];
            let [(lower_x, upper_x), (lower, upper)] = [x, y].map(|x| (K::lower(x), K::upper(x)));
            let (rank, opposite) = (ranks[point], n - 1 - ranks[point]);
            let before = dot(from_below.below(rank), upper) + dot(from_above.below(opposite), lower);
            sum.add(upper_x[term] * (2.0 * before + lower_x[term] * dot(lower, upper)));
            from_below.set(rank, lower.map(|factor| lower_x[term] * factor));
            from_above.set(opposite, upper.map(|factor| lower_x[term] * factor));
            if watch.passed_after(4 * TERMS * n.ilog2() as usize) {
                return None;
            }
        }
    }
    Some(sum.sum())
}

fn dot<const TERMS: usize>(a: [f64; TERMS], b: [f64; TERMS]) -> f64 {
    a.into_iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::l2::{Centered, Mixture, Star, Wraparound, pairs};
    use crate::samples::{points_in_the_plane, points_on_a_line};
    use proptest::prelude::*;

    fn same<const TERMS: usize, K: Kernel<TERMS>>(points: &PointSet) {
        let [swept, paired] =
            [sum::<TERMS, K>, pairs::sum::<TERMS, K>].map(|sum| sum(points, Deadline::never()).unwrap());
        assert!((swept - paired).abs() <= 1e-13 * paired.abs(), "{swept} {paired}");
    }

    proptest! {
        #[test]
        fn the_sweep_sums_what_all_pairs_sum(line in points_on_a_line(100), plane in points_in_the_plane(100)) {
            for points in [line, plane] {
                same::<1, Star>(&points);
                same::<2, Centered>(&points);
                same::<3, Wraparound>(&points);
                same::<3, Mixture>(&points);
            }
        }
    }
}
