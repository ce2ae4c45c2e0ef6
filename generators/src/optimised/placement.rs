//! Places points of a given order in the plane so that their star discrepancy is at most a given level.
//!
//! Let x and y be the sorted coordinates along both axes, and n the number of points. Only boxes with a corner (x_i, y_j) matter, and only with open or
//! with closed faces. The order of the points decides how many points such a box holds: `open` or `closed`. So the star discrepancy is at most a level
//! if and only if, for all i and j,
//!
//! ```text
//! closed / n - level  <=  x_i y_j  <=  open / n + level
//! ```
//!
//! (Clément, Doerr, Klamroth, Paquete, arXiv 2311.17463 and 2407.11533). In the logarithms of the coordinates these are bounds of sums of two unknowns. With
//! the sign of one axis changed, they are bounds of differences, as in a problem of shortest paths. So there is a solution in which all x are as large and all y
//! are as small as in any solution, and alternating bounds find it: the y bound the x from above, and the x bound the y from below, until nothing changes.

use super::ranks::Ranks;
use paracosm_coverage::Deadline;

/// The number of points up to which nobody looks at the clock between two rounds.
const FEW_POINTS: usize = 200;

/// The least change of a coordinate that counts, a few units in the last place.
const LEAST_CHANGE: f64 = 1e-15;

/// The coordinates of points, sorted along each axis, with 1 as the last coordinate.
pub(super) struct Placement {
    x: Vec<f64>,
    y: Vec<f64>,
    /// The bounds of y by x, or the reciprocals of y.
    scratch: Vec<f64>,
    deadline: Deadline,
}

impl Placement {
    /// Makes room for n points. After the deadline, no order fits.
    pub fn new(n: usize, deadline: Deadline) -> Self {
        let ones = || vec![1.0; n + 1];
        Self { x: ones(), y: ones(), scratch: ones(), deadline }
    }

    /// Places points of this order so that their star discrepancy is at most a level, except for rounding. Returns false if that is impossible, or if
    /// it is not known at the deadline.
    pub fn fits(&mut self, ranks: &Ranks, level: f64) -> bool {
        pulp::Arch::new().dispatch(|| self.found(ranks, level))
    }

    #[inline(always)]
    fn found(&mut self, ranks: &Ranks, level: f64) -> bool {
        let n = ranks.len();
        let (points, slack) = (n as f64, level * n as f64);
        self.x.fill(1.0);
        for (j, y) in self.y[..n].iter_mut().enumerate() {
            *y = ((j + 1) as f64 - slack).max(0.0) / points;
        }
        // A round follows two steps of a shortest path, which has at most 2n steps. If bounds still change later, there is no solution.
        for round in 0..n + 2 {
            if n > FEW_POINTS && self.deadline.passed() {
                return false;
            }
            match self.bound_x(ranks, slack) {
                None => return false,
                Some(false) if round > 0 => return true,
                Some(_) => {}
            }
            match self.bound_y(ranks, slack) {
                None => return false,
                Some(false) => return true,
                Some(true) => {}
            }
        }
        false
    }

    /// Bounds each x from above by open boxes. Returns whether a bound has changed; `None` if there is no solution.
    #[inline(always)]
    fn bound_x(&mut self, ranks: &Ranks, slack: f64) -> Option<bool> {
        let n = ranks.len();
        for (inverse, y) in self.scratch.iter_mut().zip(&self.y) {
            *inverse = if *y > 0.0 { 1.0 / y } else { f64::MAX };
        }
        let (mut bound, mut changed) = (f64::INFINITY, false);
        for i in (0..n).rev() {
            let least = least_product(ranks.counts(i), &self.scratch, slack) / n as f64;
            bound = bound.min(least);
            if bound < self.x[i] - LEAST_CHANGE {
                if bound < ((i + 1) as f64 - slack) / n as f64 - LEAST_CHANGE {
                    return None;
                }
                self.x[i] = bound;
                changed = true;
            }
            bound = bound.min(self.x[i]);
        }
        Some(changed)
    }

    /// Bounds each y from below by closed boxes. Returns whether a bound has changed; `None` if there is no solution.
    #[inline(always)]
    fn bound_y(&mut self, ranks: &Ranks, slack: f64) -> Option<bool> {
        let n = ranks.len();
        self.scratch.copy_from_slice(&self.y);
        for i in 0..n {
            let inverse = 1.0 / (self.x[i] * n as f64);
            for (bound, count) in self.scratch.iter_mut().zip(&ranks.counts(i + 1)[1..]) {
                let by_this = (f64::from(*count) - slack) * inverse;
                *bound = if by_this > *bound { by_this } else { *bound };
            }
        }
        let (mut bound, mut changed) = (0.0_f64, false);
        for j in 0..n {
            bound = bound.max(self.scratch[j]);
            if bound > self.y[j] + LEAST_CHANGE {
                if bound > ((j as f64 + slack) / n as f64).min(1.0) + LEAST_CHANGE {
                    return None;
                }
                self.y[j] = bound;
                changed = true;
            }
            bound = bound.max(self.y[j]);
        }
        Some(changed)
    }

    /// Returns the least level at which an order fits, or the least that is known at the deadline. The order fits at `high`.
    pub fn least(&mut self, ranks: &Ranks, mut high: f64) -> f64 {
        // A set of n points has a star discrepancy of at least 1/(2n).
        let mut low = 0.5 / ranks.len() as f64;
        while high - low > 1e-12 && !self.deadline.passed() {
            let middle = f64::midpoint(low, high);
            if self.fits(ranks, middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }

    /// Returns the points, from left to right.
    pub fn points(&self, ranks: &Ranks) -> Vec<[f64; 2]> {
        let most = 1.0_f64.next_down();
        let point = |i: usize| [self.x[i].min(most), self.y[ranks.rank(i)].min(most)];
        (0..ranks.len()).map(point).collect()
    }
}

/// Returns the least of `(count + slack) * factor`.
#[inline(always)]
fn least_product(counts: &[f32], factors: &[f64], slack: f64) -> f64 {
    // Independent lanes, so that the compiler uses vectors.
    const LANES: usize = 8;
    let mut least = [f64::INFINITY; LANES];
    let (mut counts, mut factors) = (counts.chunks_exact(LANES), factors.chunks_exact(LANES));
    for (counts, factors) in (&mut counts).zip(&mut factors) {
        for lane in 0..LANES {
            let product = (f64::from(counts[lane]) + slack) * factors[lane];
            least[lane] = if product < least[lane] { product } else { least[lane] };
        }
    }
    let rest = counts.remainder().iter().zip(factors.remainder());
    let rest = rest.map(|(count, factor)| (f64::from(*count) + slack) * factor);
    least.into_iter().chain(rest).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::{Purpose, seeded};
    use paracosm_coverage::PointSet;
    use paracosm_coverage::star::star_discrepancy;
    use rand::Rng;

    fn star(points: &[[f64; 2]]) -> f64 {
        star_discrepancy(&PointSet::new(2, points).unwrap(), Deadline::never()).upper
    }

    #[test]
    fn the_star_discrepancy_of_a_placement_is_its_level() {
        let mut rng = seeded(2, Purpose::Search, 0);
        for n in [1, 2, 5, 13, 40] {
            let points: Vec<[f64; 2]> = (0..n).map(|_| [rng.random(), rng.random()]).collect();
            let ranks = Ranks::of(&points);
            let mut placement = Placement::new(n, Deadline::never());
            let given = star(&points);
            // The points themselves show that the order fits at this level.
            assert!(placement.fits(&ranks, given + 1e-12));
            assert!(star(&placement.points(&ranks)) <= given + 1e-9);
            let least = placement.least(&ranks, given + 1e-12);
            assert!(placement.fits(&ranks, least));
            assert!((star(&placement.points(&ranks)) - least).abs() < 1e-9, "{n}");
            assert!(!placement.fits(&ranks, least - 1e-9));
        }
    }

    #[test]
    fn no_other_points_of_an_order_are_better() {
        let mut rng = seeded(3, Purpose::Search, 0);
        for n in [2, 3, 6] {
            let points: Vec<[f64; 2]> = (0..n).map(|_| [rng.random(), rng.random()]).collect();
            let ranks = Ranks::of(&points);
            let mut placement = Placement::new(n, Deadline::never());
            let least = placement.least(&ranks, star(&points) + 1e-12);
            for _ in 0..2000 {
                let mut sorted = |_| {
                    let mut along: Vec<f64> = (0..n).map(|_| rng.random()).collect();
                    along.sort_by(f64::total_cmp);
                    along
                };
                let (x, y) = (sorted(0), sorted(1));
                let other: Vec<[f64; 2]> = (0..n).map(|i| [x[i], y[ranks.rank(i)]]).collect();
                assert!(star(&other) >= least - 1e-9);
            }
        }
    }

    #[test]
    fn one_point_has_the_known_optimum() {
        // The golden ratio (White, On optimal extreme-discrepancy point sets in the square, Numer. Math. 27, 1976).
        let least = Placement::new(1, Deadline::never()).least(&Ranks::of(&[[0.5, 0.5]]), 1.0);
        assert!((least - (5.0_f64.sqrt() - 1.0) / 2.0).abs() < 1e-9, "{least}");
    }
}
