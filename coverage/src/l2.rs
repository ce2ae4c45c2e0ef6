//! Computes the discrepancies that have a closed form.
//!
//! Centered, wraparound, mixture and L2-star discrepancy look different in the literature, but share one definition:
//! the worst error of the mean over the points as an estimate of the integral, over the unit ball of a space of
//! functions whose reproducing kernel is a product `K(x, y) = prod_j k(x_j, y_j)`. The square of this error is
//!
//! ```text
//! (int int k)^d  -  2/n sum_i prod_j int k(x_ij, .)  +  1/n^2 sum_i sum_l prod_j k(x_ij, x_lj)
//! ```
//!
//! (Hickernell, A generalized discrepancy and quadrature error bound, Math. Comp. 67, 1998). A measure is therefore
//! defined by its one-dimensional kernel and the kernel's integrals. All take O(n^2 d) time. They return `None` for a
//! set without points, whose mean does not exist, or if the deadline passes first.

use crate::bracket::Watch;
use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::{Deadline, PointSet};
use rayon::prelude::*;

impl Measure {
    /// The measure "L2-star discrepancy", which compares volume and share of tests over boxes at the origin.
    pub const L2_STAR: Self = Self::of(&Descriptor {
        name: "l2-star",
        key: "l2_star",
        label: "L2-star",
        title: "L2-star discrepancy",
        about: "the root mean square difference between the volume of a box at the origin and its share of the tests",
        pace: 0,
        compare: Compare::Always,
        method: Computation::Number(l2_star),
    });
}

impl Measure {
    /// The measure "centered discrepancy, squared", which uses boxes from any point to the nearest corner of the cube.
    pub const CENTERED: Self = Self::of(&Descriptor {
        name: "centered",
        key: "centered",
        label: "centered, squared",
        title: "centered discrepancy, squared",
        about: "the mean square difference of volume and share of tests, over boxes from any point to the nearest corner",
        pace: 1,
        compare: Compare::Always,
        method: Computation::Number(centered),
    });
}

impl Measure {
    /// The measure "wraparound discrepancy, squared", which uses boxes that may cross the border of the cube.
    pub const WRAPAROUND: Self = Self::of(&Descriptor {
        name: "wraparound",
        key: "wraparound",
        label: "wraparound, squared",
        title: "wraparound discrepancy, squared",
        about: "the mean square difference of volume and share of tests, over boxes that may cross the border",
        pace: 2,
        compare: Compare::Always,
        method: Computation::Number(wraparound),
    });
}

impl Measure {
    /// The measure "mixture discrepancy, squared", which combines centered and wraparound discrepancy.
    pub const MIXTURE: Self = Self::of(&Descriptor {
        name: "mixture",
        key: "mixture",
        label: "mixture, squared",
        title: "mixture discrepancy, squared",
        about: "the mean square difference of volume and share of tests, over the boxes of centered and wraparound",
        pace: 3,
        compare: Compare::Always,
        method: Computation::Number(mixture),
    });
}

/// Computes the squared centered L2 discrepancy, over boxes between any point and the nearest corner of the cube. The
/// result agrees with `scipy.stats.qmc.discrepancy(method="CD")`. Source: Hickernell 1998, see the module's
/// documentation.
pub fn centered(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let single = |x: f64| {
        let z = (x - 0.5).abs();
        1.0 + 0.5 * z - 0.5 * z * z
    };
    // 1 + (|x - 1/2| + |y - 1/2| - |x - y|) / 2: on the same side of 1/2 the nearer point's distance from it, else 0.
    let prepare = |x: f64| ((0.5 - x).max(0.0), 1.0 + (x - 0.5).max(0.0));
    let pair = |x: Prepared, y: Prepared| least(x.0, y.0) + least(x.1, y.1);
    squared(points, deadline, 13.0 / 12.0, single, prepare, pair)
}

/// Computes the squared wraparound L2 discrepancy, over boxes that may leave the cube and come back on the opposite
/// side. The result agrees with `scipy.stats.qmc.discrepancy(method="WD")`. Source: Hickernell, Lattice rules: how well
/// do they measure up?, 1998.
pub fn wraparound(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let pair = |x: Prepared, y: Prepared| {
        let apart = (x.0 - y.0).abs();
        1.5 - apart * (1.0 - apart)
    };
    squared(points, deadline, 4.0 / 3.0, |_| 4.0 / 3.0, |x| (x, 0.0), pair)
}

/// Computes the squared mixture L2 discrepancy, which avoids weaknesses of the centered and of the wraparound
/// discrepancy. The result agrees with `scipy.stats.qmc.discrepancy(method="MD")`. Source: Zhou, Fang, Ning, Mixture
/// discrepancy for quasi-random point sets, J. Complexity 29, 2013.
pub fn mixture(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let single = |x: f64| {
        let z = (x - 0.5).abs();
        5.0 / 3.0 - 0.25 * z - 0.25 * z * z
    };
    // 15/8 - (|x - 1/2| + |y - 1/2|) / 4 - 3/4 |x - y| + |x - y|^2 / 2.
    let prepare = |x: f64| (x, 0.9375 - 0.25 * (x - 0.5).abs());
    let pair = |x: Prepared, y: Prepared| {
        let apart = (x.0 - y.0).abs();
        (x.1 + y.1) - apart * (0.75 - 0.5 * apart)
    };
    squared(points, deadline, 19.0 / 12.0, single, prepare, pair)
}

/// Computes the L2-star discrepancy of a set of points, not squared. This discrepancy is the root mean square, over all
/// boxes anchored at 0, of the difference between volume and share of points. The result agrees with
/// `scipy.stats.qmc.discrepancy(method="L2-star")`. Source: Warnock, Computational investigations of low-discrepancy
/// point sets, 1972.
pub fn l2_star(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let (single, prepare) = (|x: f64| 0.5 * (1.0 - x * x), |x: f64| (1.0 - x, 0.0));
    let squared = squared(points, deadline, 1.0 / 3.0, single, prepare, |x, y| least(x.0, y.0));
    // The terms cancel: for a very good set, rounding may leave a negative number.
    squared.map(|square| square.max(0.0).sqrt())
}

/// The number of points in a group. The products of one group fit in the registers.
const LANES: usize = 8;
/// The number of groups in a task. A task compares each of its points with all earlier points, which is enough work
/// for a task.
const GROUPS_PER_TASK: usize = 4;

/// The values that a kernel needs of a coordinate, at most two numbers. These values are computed once per point, not
/// per pair.
type Prepared = (f64, f64);

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

/// The squared worst-case error for a kernel with its integrals, `single` over one argument and `whole` over both.
/// The kernel is `pair`, applied to the prepared arguments.
///
/// Sums are taken in fixed groups and in their order: the result does not depend on the number of threads.
fn squared(
    points: &PointSet,
    deadline: Deadline,
    whole: f64,
    single: impl Fn(f64) -> f64,
    prepare: impl Fn(f64) -> Prepared,
    pair: impl Fn(Prepared, Prepared) -> f64 + Sync,
) -> Option<f64> {
    if points.is_empty() {
        return None;
    }
    let whole: f64 = std::iter::repeat_n(whole, points.dims()).product();
    let singles: f64 = points.iter().map(|x| x.iter().map(|&x| single(x)).product::<f64>()).sum();
    let groups = Groups::new(points, prepare);
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
                let products = groups.products(point, group, &pair);
                sums.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
            }
            let own = groups.products(point, point / LANES, &pair);
            let (before, itself) = (&own[..point % LANES], own[point % LANES]);
            sum += itself + 2.0 * (sums.iter().sum::<f64>() + before.iter().sum::<f64>());
        }
        Some(sum)
    };
    let sums: Option<Vec<f64>> = (0..tasks).into_par_iter().rev().with_max_len(1).map(pairs).collect();
    let pairs: f64 = sums?.iter().sum();
    let n = points.len() as f64;
    Some(whole - 2.0 * singles / n + pairs / (n * n))
}

/// The smaller number. Unlike `f64::min` it is one instruction, because it does not care for NaN.
#[inline(always)]
fn least(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}
