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
//! defined by its one-dimensional kernel and the kernel's integrals (`Kernel`). They return `None` for a set without
//! points, whose mean does not exist, or if the deadline passes first.
//!
//! The double sum takes O(n^2 d) time (`pairs`). For many points on a line or in the plane it takes O(n log n)
//! (`sweep`).

mod pairs;
mod sweep;

use crate::measure::{Compare, Computation, Descriptor, Measure};
use crate::ordered::least;
use crate::{Deadline, PointSet};

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

/// A kernel on the interval from 0 to 1, with its integrals.
///
/// For `x <= y` the kernel is a sum of products, `k(x, y) = sum_r lower_r(x) upper_r(y)`. For `x > y` it is `k(y, x)`.
trait Kernel<const TERMS: usize>: Sync {
    /// The integral over both arguments.
    const WHOLE: f64;

    /// Returns the integral over one argument.
    fn single(x: f64) -> f64;

    /// Computes the numbers that the kernel needs of an argument.
    fn prepare(x: f64) -> Prepared;

    /// Returns the kernel of two prepared arguments.
    fn pair(x: Prepared, y: Prepared) -> f64;

    /// Returns the factors of the lower argument.
    fn lower(x: f64) -> [f64; TERMS];

    /// Returns the factors of the upper argument.
    fn upper(y: f64) -> [f64; TERMS];
}

/// The values that a kernel needs of a coordinate, at most two numbers. These values are computed once per point, not
/// per pair.
type Prepared = (f64, f64);

/// Computes the squared centered L2 discrepancy, over boxes between any point and the nearest corner of the cube. The
/// result agrees with `scipy.stats.qmc.discrepancy(method="CD")`. Source: Hickernell 1998, see the module's
/// documentation.
pub fn centered(points: &PointSet, deadline: Deadline) -> Option<f64> {
    squared::<2, Centered>(points, deadline)
}

struct Centered;

impl Kernel<2> for Centered {
    const WHOLE: f64 = 13.0 / 12.0;

    fn single(x: f64) -> f64 {
        let z = (x - 0.5).abs();
        1.0 + 0.5 * z - 0.5 * z * z
    }

    // 1 + (|x - 1/2| + |y - 1/2| - |x - y|) / 2: on the same side of 1/2 the nearer point's distance from it, else 0.
    fn prepare(x: f64) -> Prepared {
        ((0.5 - x).max(0.0), 1.0 + (x - 0.5).max(0.0))
    }

    #[inline(always)]
    fn pair(x: Prepared, y: Prepared) -> f64 {
        least(x.0, y.0) + least(x.1, y.1)
    }

    fn lower(x: f64) -> [f64; 2] {
        [1.0, 1.0 + (x - 0.5).max(0.0)]
    }

    fn upper(y: f64) -> [f64; 2] {
        [(0.5 - y).max(0.0), 1.0]
    }
}

/// Computes the squared wraparound L2 discrepancy, over boxes that may leave the cube and come back on the opposite
/// side. The result agrees with `scipy.stats.qmc.discrepancy(method="WD")`. Source: Hickernell, Lattice rules: how well
/// do they measure up?, 1998.
pub fn wraparound(points: &PointSet, deadline: Deadline) -> Option<f64> {
    squared::<3, Wraparound>(points, deadline)
}

struct Wraparound;

impl Kernel<3> for Wraparound {
    const WHOLE: f64 = 4.0 / 3.0;

    fn single(_: f64) -> f64 {
        4.0 / 3.0
    }

    fn prepare(x: f64) -> Prepared {
        (x, 0.0)
    }

    #[inline(always)]
    fn pair(x: Prepared, y: Prepared) -> f64 {
        let apart = (x.0 - y.0).abs();
        1.5 - apart * (1.0 - apart)
    }

    fn lower(x: f64) -> [f64; 3] {
        [1.0, x, x * (1.0 + x)]
    }

    fn upper(y: f64) -> [f64; 3] {
        [1.5 - y * (1.0 - y), -2.0 * y, 1.0]
    }
}

/// Computes the squared mixture L2 discrepancy, which avoids weaknesses of the centered and of the wraparound
/// discrepancy. The result agrees with `scipy.stats.qmc.discrepancy(method="MD")`. Source: Zhou, Fang, Ning, Mixture
/// discrepancy for quasi-random point sets, J. Complexity 29, 2013.
pub fn mixture(points: &PointSet, deadline: Deadline) -> Option<f64> {
    squared::<3, Mixture>(points, deadline)
}

struct Mixture;

impl Kernel<3> for Mixture {
    const WHOLE: f64 = 19.0 / 12.0;

    fn single(x: f64) -> f64 {
        let z = (x - 0.5).abs();
        5.0 / 3.0 - 0.25 * z - 0.25 * z * z
    }

    // 15/8 - (|x - 1/2| + |y - 1/2|) / 4 - 3/4 |x - y| + |x - y|^2 / 2.
    fn prepare(x: f64) -> Prepared {
        (x, 0.9375 - 0.25 * (x - 0.5).abs())
    }

    #[inline(always)]
    fn pair(x: Prepared, y: Prepared) -> f64 {
        let apart = (x.0 - y.0).abs();
        (x.1 + y.1) - apart * (0.75 - 0.5 * apart)
    }

    fn lower(x: f64) -> [f64; 3] {
        [1.0, -x, Self::prepare(x).1 + x * (0.75 + 0.5 * x)]
    }

    fn upper(y: f64) -> [f64; 3] {
        [Self::prepare(y).1 - y * (0.75 - 0.5 * y), y, 1.0]
    }
}

/// Computes the L2-star discrepancy of a set of points, not squared. This discrepancy is the root mean square, over all
/// boxes anchored at 0, of the difference between volume and share of points. The result agrees with
/// `scipy.stats.qmc.discrepancy(method="L2-star")`. Source: Warnock, Computational investigations of low-discrepancy
/// point sets, 1972.
pub fn l2_star(points: &PointSet, deadline: Deadline) -> Option<f64> {
    // The terms cancel: for a very good set, rounding may leave a negative number.
    squared::<1, Star>(points, deadline).map(|square| square.max(0.0).sqrt())
}

struct Star;

impl Kernel<1> for Star {
    const WHOLE: f64 = 1.0 / 3.0;

    fn single(x: f64) -> f64 {
        0.5 * (1.0 - x * x)
    }

    fn prepare(x: f64) -> Prepared {
        (1.0 - x, 0.0)
    }

    #[inline(always)]
    fn pair(x: Prepared, y: Prepared) -> f64 {
        least(x.0, y.0)
    }

    fn lower(_: f64) -> [f64; 1] {
        [1.0]
    }

    fn upper(y: f64) -> [f64; 1] {
        [1.0 - y]
    }
}

/// A sum that carries the rounding of each addition (Neumaier, Rundungsfehleranalyse einiger Verfahren zur Summation
/// endlicher Summen, ZAMM 54, 1974). The terms of a discrepancy cancel: for a million good points some five digits of
/// the sums are left.
#[derive(Debug, Clone, Copy, Default)]
struct Compensated {
    sum: f64,
    lost: f64,
}

impl Compensated {
    fn add(&mut self, number: f64) {
        let sum = self.sum + number;
        self.lost += if self.sum.abs() >= number.abs() { self.sum - sum + number } else { number - sum + self.sum };
        self.sum = sum;
    }

    fn sum(self) -> f64 {
        self.sum + self.lost
    }
}

/// The least number of points for a sweep. To look at all pairs of fewer points takes milliseconds.
const LEAST_FOR_SWEEP: usize = 4096;

/// Computes the squared worst-case error for a kernel; `None` without points, or if the deadline passes first.
fn squared<const TERMS: usize, K: Kernel<TERMS>>(points: &PointSet, deadline: Deadline) -> Option<f64> {
    if points.is_empty() {
        return None;
    }
    let whole: f64 = std::iter::repeat_n(K::WHOLE, points.dims()).product();
    let mut singles = Compensated::default();
    points.iter().for_each(|x| singles.add(x.iter().map(|&x| K::single(x)).product()));
    let pairs = match points.dims() {
        1 | 2 if points.len() >= LEAST_FOR_SWEEP => sweep::sum::<TERMS, K>(points, deadline)?,
        _ => pairs::sum::<TERMS, K>(points, deadline)?,
    };
    let n = points.len() as f64;
    Some(whole - 2.0 * singles.sum() / n + pairs / (n * n))
}
