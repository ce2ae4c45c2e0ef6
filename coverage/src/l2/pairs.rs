//! Sums a kernel over all pairs of points, in any dimension.
//!
//! Sums are taken in fixed groups and in their order: the result does not depend on the number of threads.

use super::{Compensated, Kernel, Prepared};
use crate::deadline::Watch;
use crate::{Deadline, PointSet};
use rayon::prelude::*;

/// The number of points in a group. The products of one group fit in the registers.
const LANES: usize = 8;
/// The number of groups in a task. A task compares each of its points with all earlier points, which is enough work
/// for a task.
const GROUPS_PER_TASK: usize = 4;

/// The prepared points in groups: per group and axis the first numbers of its points, then the second numbers.
struct Groups {
    dims: usize,
    firsts: Vec<[f64; LANES]>,
    seconds: Vec<[f64; LANES]>,
}

impl Groups {
    fn new(points: &PointSet, prepare: impl Fn(f64) -> Prepared) -> Self {
        let dims = points.dims();
        let length = points.len().div_ceil(LANES) * dims;
        let mut groups = Self { dims, firsts: vec![[0.0; LANES]; length], seconds: vec![[0.0; LANES]; length] };
        for (i, point) in points.iter().enumerate() {
            for (axis, &x) in point.iter().enumerate() {
                let at = i / LANES * dims + axis;
                (groups.firsts[at][i % LANES], groups.seconds[at][i % LANES]) = prepare(x);
            }
        }
        groups
    }

    /// The kernel's values for a point with each point of a group.
    #[inline(always)]
    fn products(&self, point: usize, group: usize, pair: impl Fn(Prepared, Prepared) -> f64) -> [f64; LANES] {
        let of = |group: usize| group * self.dims..(group + 1) * self.dims;
        let (own, others) = (of(point / LANES), of(group));
        let own = self.firsts[own.clone()].iter().zip(&self.seconds[own]);
        let others = self.firsts[others.clone()].iter().zip(&self.seconds[others]);
        let mut products = [1.0; LANES];
        for (own, other) in own.zip(others) {
            let x = (own.0[point % LANES], own.1[point % LANES]);
            for (product, other) in products.iter_mut().zip(other.0.iter().zip(other.1)) {
                *product *= pair((*other.0, *other.1), x);
            }
        }
        products
    }
}

/// Returns the sum of the kernel over all pairs of points, in O(n^2 d); `None` if the deadline passes first.
pub(super) fn sum<const TERMS: usize, K: Kernel<TERMS>>(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let groups = Groups::new(points, K::prepare);
    // The last tasks have the most work, and are begun first.
    let tasks = points.len().div_ceil(LANES * GROUPS_PER_TASK);
    let pairs = |task: usize| {
        let mut watch = Watch::new(deadline);
        let from = task * LANES * GROUPS_PER_TASK;
        let mut sum = 0.0;
        for point in from..(from + LANES * GROUPS_PER_TASK).min(points.len()) {
            if watch.passed_after(point) {
                return None;
            }
            // The kernel is symmetric: pairs of different points count twice.
            let mut sums = [0.0; LANES];
            for group in 0..point / LANES {
                let products = groups.products(point, group, K::pair);
                sums.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
            }
            let own = groups.products(point, point / LANES, K::pair);
            let (before, itself) = (&own[..point % LANES], own[point % LANES]);
            sum += itself + 2.0 * (sums.iter().sum::<f64>() + before.iter().sum::<f64>());
        }
        Some(sum)
    };
    let sums: Option<Vec<f64>> = (0..tasks).into_par_iter().rev().with_max_len(1).map(pairs).collect();
    let mut sum = Compensated::default();
    sums?.into_iter().for_each(|part| sum.add(part));
    Some(sum.sum())
}
