//! The discrepancies that have a closed form.
//!
//! Centered, wraparound, mixture and L2-star discrepancy look different in the literature, but are one thing:
//! the worst error of the mean over the points as an estimate of the integral, over the unit ball of a space
//! of functions whose reproducing kernel is a product `K(x, y) = prod_j k(x_j, y_j)`. Its square is
//!
//! ```text
//! (int int k)^d  -  2/n sum_i prod_j int k(x_ij, .)  +  1/n^2 sum_i sum_l prod_j k(x_ij, x_lj)
//! ```
//!
//! (Hickernell, A generalized discrepancy and quadrature error bound, Math. Comp. 67, 1998), so that a measure
//! is its one-dimensional kernel and the kernel's integrals, and nothing else. All take O(n^2 d) time and are
//! `None` for a set without points, whose mean does not exist, or where the deadline passes first.

use crate::bracket::Watch;
use crate::{Deadline, PointSet};

/// The squared centered L2 discrepancy, by boxes between each point and its nearest corner of the cube;
/// `scipy.stats.qmc.discrepancy(method="CD")`. Source: Hickernell 1998, as above.
pub fn centered(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let single = |x: f64| {
        let z = (x - 0.5).abs();
        1.0 + 0.5 * z - 0.5 * z * z
    };
    let pair = |x: f64, y: f64| 1.0 + 0.5 * ((x - 0.5).abs() + (y - 0.5).abs() - (x - y).abs());
    squared(points, deadline, 13.0 / 12.0, single, pair)
}

/// The squared wraparound L2 discrepancy, by boxes that may leave the cube on one side and come back on the
/// other; `scipy.stats.qmc.discrepancy(method="WD")`. Source: Hickernell, Lattice rules: how well do they
/// measure up?, 1998.
pub fn wraparound(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let pair = |x: f64, y: f64| {
        let apart = (x - y).abs();
        1.5 - apart * (1.0 - apart)
    };
    squared(points, deadline, 4.0 / 3.0, |_| 4.0 / 3.0, pair)
}

/// The squared mixture L2 discrepancy, which mends what the other two are blind to;
/// `scipy.stats.qmc.discrepancy(method="MD")`. Source: Zhou, Fang, Ning, Mixture discrepancy for quasi-random
/// point sets, J. Complexity 29, 2013.
pub fn mixture(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let single = |x: f64| {
        let z = (x - 0.5).abs();
        5.0 / 3.0 - 0.25 * z - 0.25 * z * z
    };
    let pair = |x: f64, y: f64| {
        let apart = (x - y).abs();
        1.875 - 0.25 * ((x - 0.5).abs() + (y - 0.5).abs()) - 0.75 * apart + 0.5 * apart * apart
    };
    squared(points, deadline, 19.0 / 12.0, single, pair)
}

/// The L2-star discrepancy (the root, not the square): the root mean square, over all boxes anchored at 0, of
/// volume less share of points; `scipy.stats.qmc.discrepancy(method="L2-star")`. Source: Warnock,
/// Computational investigations of low-discrepancy point sets, 1972.
pub fn l2_star(points: &PointSet, deadline: Deadline) -> Option<f64> {
    let squared = squared(points, deadline, 1.0 / 3.0, |x| 0.5 * (1.0 - x * x), |x, y| 1.0 - x.max(y));
    // The terms cancel: of a very good set rounding may leave less than nothing.
    squared.map(|square| square.max(0.0).sqrt())
}

/// The squared worst-case error for a kernel `pair` with its integrals: `single` over one argument, `whole`
/// over both.
fn squared(
    points: &PointSet,
    deadline: Deadline,
    whole: f64,
    single: impl Fn(f64) -> f64,
    pair: impl Fn(f64, f64) -> f64,
) -> Option<f64> {
    if points.is_empty() {
        return None;
    }
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(&x, &y)| pair(x, y)).product::<f64>();
    let whole: f64 = std::iter::repeat_n(whole, points.dims()).product();
    let singles: f64 = points.iter().map(|x| x.iter().map(|&x| single(x)).product::<f64>()).sum();
    // The kernel is symmetric: pairs of different points count twice.
    let mut watch = Watch::new(deadline);
    let mut pairs = 0.0;
    for (i, x) in points.iter().enumerate() {
        if watch.passed_after(i) {
            return None;
        }
        pairs += product(x, x) + 2.0 * points.iter().take(i).map(|y| product(x, y)).sum::<f64>();
    }
    let n = points.len() as f64;
    Some(whole - 2.0 * singles / n + pairs / (n * n))
}
