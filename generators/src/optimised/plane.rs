//! Searches for points in the plane with a small star discrepancy: over their orders, each with its best coordinates.

use super::placement::Placement;
use super::ranks::Ranks;
use super::shared::Shared;
use paracosm_coverage::star::star_discrepancy;
use paracosm_coverage::{Deadline, PointSet};
use rand::Rng;

/// The number of changes of an order between two starts.
const CHANGES: usize = 5000;

/// The share by which an order may be worse than the best order after a start. It falls to 0 until the next start.
const SLACK: f64 = 0.2;

/// The number of new orders of which a start takes the best.
const NEW_ORDERS: usize = 64;

/// The largest error of a level by rounding and by the end of a bisection.
const ROUNDING: f64 = 2e-12;

/// The share of the best level that an improvement gains at least. Smaller gains come from the exact level at the end.
const LEAST_GAIN: f64 = 1e-6;

/// The share of the time for the orders to begin with.
const OPENING: f64 = 0.25;

/// Points with their order.
#[derive(Clone)]
struct Ordered {
    points: Vec<[f64; 2]>,
    ranks: Ranks,
}

/// Returns n points with a small star discrepancy. It is no larger than that of the given points, if there are any. `watch` is called with the star
/// discrepancy of each better set.
pub(super) fn small_star(
    n: usize,
    given: Option<&[[f64; 2]]>,
    seed: u64,
    deadline: Deadline,
    watch: &(dyn Fn(f64) + Sync),
) -> Vec<[f64; 2]> {
    let points = given.map_or_else(|| kronecker(n, GOLDEN, 0.0), <[_]>::to_vec);
    let set = PointSet::new(2, &points).expect("the points are in the square");
    let (ranks, level) = (Ranks::of(&points), star_discrepancy(&set, Deadline::never()).upper);
    let best = Shared::new(Ordered { points, ranks }, level, watch);
    best.searched(seed, |best, rng| Search { best, n, deadline }.run(rng)).points
}

/// A search of one thread.
struct Search<'a> {
    best: &'a Shared<'a, Ordered>,
    n: usize,
    deadline: Deadline,
}

impl Search<'_> {
    fn run(&self, rng: &mut impl Rng) {
        let mut placement = Placement::new(self.n, self.deadline);
        let (first, level) = self.best.best();
        // The coordinates of the first points are rarely the best of their order.
        self.improve(&first.ranks, level, &mut placement);
        if self.n < 2 {
            return;
        }
        self.open(rng, &mut placement);
        let mut ranks = self.new_order(rng, &mut placement);
        while !self.deadline.passed() {
            for change in 0..CHANGES {
                if self.deadline.passed() {
                    return;
                }
                let left = 1.0 - change as f64 / CHANGES as f64;
                let best = self.best.value();
                let done = ranks.change(rng);
                if !placement.fits(&ranks, best * (1.0 + SLACK * left * left) * (1.0 - LEAST_GAIN)) {
                    ranks.undo(done);
                } else if placement.fits(&ranks, best * (1.0 - LEAST_GAIN)) {
                    self.improve(&ranks, best, &mut placement);
                }
            }
            match rng.random_range(0..4) {
                0 => {}
                1 => ranks = self.new_order(rng, &mut placement),
                _ => ranks = self.best.best().0.ranks,
            }
        }
    }

    /// Tries orders of Kronecker sets for a part of the time. Most of them are refused at once, and for many points such an order is hard to better.
    fn open(&self, rng: &mut impl Rng, placement: &mut Placement) {
        let opening = self.deadline.part(OPENING);
        while !opening.passed() {
            let ranks = self.random_order(rng);
            let best = self.best.value();
            if placement.fits(&ranks, best * (1.0 - LEAST_GAIN)) {
                self.improve(&ranks, best, placement);
            }
        }
    }

    fn random_order(&self, rng: &mut impl Rng) -> Ranks {
        let step = if rng.random() { GOLDEN } else { rng.random() };
        Ranks::of(&kronecker(self.n, step, rng.random()))
    }

    /// Returns the best of some orders of Kronecker sets, which are the best orders that are known (arXiv 2407.11533).
    fn new_order(&self, rng: &mut impl Rng, placement: &mut Placement) -> Ranks {
        let mut found = (self.random_order(rng), 1.0);
        for _ in 0..NEW_ORDERS {
            let ranks = self.random_order(rng);
            let limit = found.1 * (1.0 - 1e-3);
            if placement.fits(&ranks, limit) {
                let level = placement.least(&ranks, limit);
                if level < self.best.value() * (1.0 - LEAST_GAIN) {
                    self.improve(&ranks, level, placement);
                }
                found = (ranks, level);
            }
            if self.deadline.passed() {
                break;
            }
        }
        found.0
    }

    /// Keeps an order that fits at a level, with the least level, if it is the best so far.
    fn improve(&self, ranks: &Ranks, level: f64, placement: &mut Placement) {
        let level = placement.least(ranks, level);
        if !placement.fits(ranks, level) {
            return;
        }
        // The level is rounded.
        self.best.improve(level, ROUNDING, || Ordered { points: placement.points(ranks), ranks: ranks.clone() });
    }
}

/// The fractional part of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Returns points at even distances along one axis, and at the multiples of a step along the other axis, modulo 1.
fn kronecker(n: usize, step: f64, shift: f64) -> Vec<[f64; 2]> {
    (0..n).map(|i| [i as f64 / n as f64, (i as f64 * step + shift).fract()]).collect()
}
