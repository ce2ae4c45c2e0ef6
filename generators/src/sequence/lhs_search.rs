//! Latin hypercubes that a search makes more even: by the distances between points, or by the centered discrepancy.
//!
//! A search begins with a random Latin hypercube. It swaps the coordinates of two points on one axis, which keeps the hypercube a
//! hypercube. It accepts swaps up to a threshold that falls to 0 (threshold accepting: Dueck, Scheuer, Journal of Computational Physics 90,
//! 1990). The number of swaps depends on the number of points, of coordinates and of rows alone, so that the same request always has the same points.

use rand::Rng;
use rand_pcg::Pcg64;

/// The most differences of coordinates that the searches of all rows compute together. They take one or two seconds.
const MOST_DIFFERENCES: u64 = 1_000_000_000;

/// The most swaps per coordinate of a set.
const SWAPS: u64 = 500;

/// The number of random swaps that decide where the threshold begins. With fewer swaps, there is no search.
const FIRST: u64 = 64;

/// A sum over pairs of points, which a search makes small.
pub(super) trait Criterion {
    /// Returns the part of a point on its own.
    fn of_point(point: &[f64], points: usize) -> f64;

    /// Returns the part of a pair of points.
    fn of_pair(a: &[f64], b: &[f64]) -> f64;
}

/// The criterion of Morris and Mitchell (Exploratory designs for computational experiments, Journal of Statistical Planning and
/// Inference 43, 1995): the sum of the distances to the power -16. The least distance decides it.
pub(super) struct Maximin;

impl Criterion for Maximin {
    fn of_point(_: &[f64], _: usize) -> f64 {
        0.0
    }

    fn of_pair(a: &[f64], b: &[f64]) -> f64 {
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        let fourth = square * square;
        let eighth = fourth * fourth;
        1.0 / (eighth * eighth)
    }
}

/// The squared centered discrepancy, times n^2 / 2 and without the parts that no swap changes (Hickernell, Math. Comp. 67, 1998).
pub(super) struct Centered;

impl Criterion for Centered {
    fn of_point(point: &[f64], points: usize) -> f64 {
        let single = |x: &f64| {
            let z = (x - 0.5).abs();
            1.0 + 0.5 * (z - z * z)
        };
        let with_itself = |x: &f64| 1.0 + (x - 0.5).abs();
        0.5 * point.iter().map(with_itself).product::<f64>() - points as f64 * point.iter().map(single).product::<f64>()
    }

    fn of_pair(a: &[f64], b: &[f64]) -> f64 {
        let factor = |(a, b): (&f64, &f64)| 1.0 + 0.5 * ((a - 0.5).abs() + (b - 0.5).abs() - (a - b).abs());
        a.iter().zip(b).map(factor).product()
    }
}

/// Returns the number of swaps that a search tries, if `rows` such sets are searched for.
fn swaps(points: u64, dims: u64, rows: u64) -> u64 {
    let coordinates = points * dims;
    (MOST_DIFFERENCES / (4 * coordinates * rows)).min(SWAPS * coordinates)
}

/// Makes the criterion of a Latin hypercube small. The coordinates of a point stand together.
pub(super) fn improve<C: Criterion>(coordinates: &mut [f64], dims: usize, rows: u64, rng: &mut Pcg64) {
    let points = coordinates.len() / dims;
    if points < 3 || dims < 2 {
        return;
    }
    let tries = swaps(points as u64, dims as u64, rows);
    if tries < FIRST {
        return;
    }
    // Of the least change, the 16th part and the fourth part of the sorted changes, the least one gave the best sets.
    let changes = (0..FIRST).map(|_| Swap::random(points, dims, rng).change::<C>(coordinates).abs());
    let threshold = changes.fold(f64::INFINITY, f64::min);
    for i in 0..tries {
        let left = 1.0 - i as f64 / tries as f64;
        let swap = Swap::random(points, dims, rng);
        if swap.change::<C>(coordinates) <= threshold * left * left * left {
            swap.apply(coordinates);
        }
    }
}

/// A swap of the coordinates of two points on an axis.
struct Swap {
    a: usize,
    b: usize,
    axis: usize,
    dims: usize,
}

impl Swap {
    /// Chooses two different points and an axis.
    fn random(points: usize, dims: usize, rng: &mut Pcg64) -> Self {
        let a = rng.random_range(0..points);
        let b = (a + rng.random_range(1..points)) % points;
        Self { a, b, axis: rng.random_range(0..dims), dims }
    }

    fn apply(&self, coordinates: &mut [f64]) {
        coordinates.swap(self.a * self.dims + self.axis, self.b * self.dims + self.axis);
    }

    /// Returns the change of the criterion that the swap brings. The pair of the two points keeps its part, because both criteria
    /// look at the two coordinates of an axis in any order.
    fn change<C: Criterion>(&self, coordinates: &[f64]) -> f64 {
        let point = |i: usize| &coordinates[i * self.dims..][..self.dims];
        let before = [point(self.a), point(self.b)];
        let mut after = before.map(<[f64]>::to_vec);
        (after[0][self.axis], after[1][self.axis]) = (before[1][self.axis], before[0][self.axis]);
        let points = coordinates.len() / self.dims;
        let mut change = 0.0;
        for (after, before) in after.iter().zip(before) {
            change += C::of_point(after, points) - C::of_point(before, points);
        }
        for (i, other) in coordinates.chunks_exact(self.dims).enumerate() {
            if i != self.a && i != self.b {
                for (after, before) in after.iter().zip(before) {
                    change += C::of_pair(after, other) - C::of_pair(before, other);
                }
            }
        }
        change
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, Strategy};
    use paracosm_coverage::l2::centered;
    use paracosm_coverage::{Deadline, PointSet};
    use paracosm_space::Space;
    use rand::SeedableRng;

    fn points(strategy: Strategy, n: usize, dims: usize) -> Vec<Vec<f64>> {
        let space = Space::unit_cube(dims);
        let mut made = strategy.build(&Request::new(&space, n)).unwrap();
        made.ask(n).into_iter().map(|point| point.continuous).collect()
    }

    fn square_of_discrepancy(coordinates: &[f64], dims: usize) -> f64 {
        centered(&PointSet::new(dims, coordinates.chunks_exact(dims)).unwrap(), Deadline::never()).unwrap()
    }

    fn total<C: Criterion>(coordinates: &[f64], dims: usize) -> f64 {
        let points: Vec<&[f64]> = coordinates.chunks_exact(dims).collect();
        let own: f64 = points.iter().map(|point| C::of_point(point, points.len())).sum();
        let pairs = points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| C::of_pair(a, b)));
        own + pairs.sum::<f64>()
    }

    #[test]
    fn the_change_of_a_swap_is_the_difference_of_the_criteria() {
        let mut rng = Pcg64::seed_from_u64(1);
        for (points, dims) in [(3, 2), (9, 4), (20, 1)] {
            let mut coordinates: Vec<f64> = (0..points * dims).map(|_| rng.random()).collect();
            for _ in 0..50 {
                let swap = Swap::random(points, dims, &mut rng);
                let half_square = (points * points) as f64 / 2.0;
                let before = (total::<Maximin>(&coordinates, dims), square_of_discrepancy(&coordinates, dims));
                let told = (swap.change::<Maximin>(&coordinates), swap.change::<Centered>(&coordinates));
                swap.apply(&mut coordinates);
                let after = (total::<Maximin>(&coordinates, dims), square_of_discrepancy(&coordinates, dims));
                assert!((after.0 - before.0 - told.0).abs() <= 1e-9 * (before.0 + after.0));
                assert!((half_square * (after.1 - before.1) - told.1).abs() < 1e-9 * half_square);
            }
        }
    }

    /// The medians of SciPy 1.17 over the seeds 0 to 4: `qmc.LatinHypercube(d, optimization="random-cd", rng=seed).random(n)`.
    #[test]
    fn a_search_for_a_low_discrepancy_does_better_than_scipy() {
        for (dims, n, scipy) in [(2, 100, 6.25e-5), (5, 100, 1.217e-3), (10, 100, 1.765e-2)] {
            let ours = square_of_discrepancy(&points(Strategy::LHS_DISCREPANCY, n, dims).concat(), dims);
            assert!(ours < scipy, "{dims} dimensions: {ours} against {scipy}");
        }
    }

    #[test]
    fn a_search_for_distance_moves_points_apart() {
        let least = |strategy, n, dims| {
            let points = points(strategy, n, dims);
            let square = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            let pairs = points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| square(a, b)));
            pairs.fold(f64::INFINITY, f64::min).sqrt()
        };
        for (dims, n) in [(2, 20), (3, 60), (10, 30)] {
            let (plain, apart) = (least(Strategy::LHS, n, dims), least(Strategy::LHS_MAXIMIN, n, dims));
            assert!(apart > 1.5 * plain, "{dims} dimensions: {apart} against {plain}");
        }
    }
}
