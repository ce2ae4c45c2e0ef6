//! Searches for points in three or more dimensions with a small star discrepancy: points move one at a time, out of boxes with too many points and into
//! boxes with too few.
//!
//! A move counts if no box is worse than a threshold, which falls to the best value (threshold accepting, Dueck, Scheuer, J. Comput. Phys. 90, 1990).
//! To look at all boxes takes long, so a pool has the boxes that have been bad, and a climb from the worst boxes finds the boxes that a move has made bad. The
//! exact measure judges a set only if no box that is known shows that the set is no better.

use super::objective::Objective;
use super::pool::Pool;
use super::shared::Shared;
use super::spots::{Corner, Spots};
use paracosm_coverage::{Deadline, PointSet};
use rand::Rng;

/// The number of moves between two starts from the best set.
const MOVES: usize = 20_000;

/// The share by which a set may be worse than the best set after a start. It falls to 0 until the next start.
const SLACK: f64 = 0.015;

/// The climbs from random boxes at a start, and before a set is measured.
const CLIMBS: usize = 400;

/// The climbs from bad boxes after a move.
const CHECKS: usize = 6;

/// The number of moves after which the pool is sorted anew.
const SORTED: usize = 500;

/// The share of the best value that an improvement gains at least, so that the exact measure is worth its time.
const LEAST_GAIN: f64 = 1e-4;

/// The share of the time that is left for the last measurement.
const MEASURING: f64 = 0.05;

/// Returns points whose star discrepancy is at most that of the given points, and whether the time was enough to measure the given points. `watch` is called with
/// the value of each better set.
pub(super) fn improved(
    points: &PointSet,
    seed: u64,
    deadline: Deadline,
    watch: &(dyn Fn(f64) + Sync),
) -> (PointSet, bool) {
    let dims = points.dims();
    let search_end = deadline.part(1.0 - MEASURING);
    let given = Objective::Star.measured(points, deadline);
    let rows = points.iter().map(<[f64]>::to_vec).collect();
    let best = Shared::new(rows, given.upper, watch).searched(seed, |best, rng| {
        Search { dims, best, deadline: search_end, end: deadline }.run(rng);
    });
    (PointSet::new(dims, best).expect("the points stay in the cube"), given.is_exact())
}

/// A search of one thread.
struct Search<'a> {
    dims: usize,
    best: &'a Shared<'a, Vec<Vec<f64>>>,
    deadline: Deadline,
    /// The end of the last measurement.
    end: Deadline,
}

impl Search<'_> {
    fn run(&self, rng: &mut impl Rng) {
        let mut pool = Pool::new(self.dims);
        while !self.deadline.passed() {
            let (points, level) = self.best.best();
            let spots = Spots::new(&points, self.dims);
            pool = pool.moved_to(&spots);
            if let Some(found) = self.round(spots, &mut pool, level, rng) {
                self.improve(&found);
            }
        }
    }

    /// Makes moves from a set with a star discrepancy. Returns the best set that is better, as far as its boxes are known.
    fn round(&self, mut spots: Spots, pool: &mut Pool, mut level: f64, rng: &mut impl Rng) -> Option<Spots> {
        let (mut outside, mut found) = (Vec::new(), None);
        self.look(&spots, pool, &mut outside, rng);
        let mut worst = pool.worst()?.clone();
        for step in 0..MOVES {
            if self.deadline.passed() {
                break;
            }
            if step % SORTED == 0 {
                pool.sort();
            }
            let left = 1.0 - step as f64 / MOVES as f64;
            let threshold = level * (1.0 + SLACK * left * left);
            let Move { axis, point, to } = chosen(&spots, &worst, rng);
            let before = spots.at(axis, point);
            spots.place(axis, point, to);
            let is_good = pool.follow(&spots, axis, point, before, threshold)
                && self.check(&spots, pool, &mut outside, threshold);
            if !is_good {
                spots.place(axis, point, before);
                pool.undo(&spots, axis);
                pool.settle(&spots);
                continue;
            }
            pool.settle(&spots);
            let goal = level * (1.0 - LEAST_GAIN);
            if pool.level() < goal {
                self.look(&spots, pool, &mut outside, rng);
                if pool.level() < goal {
                    level = pool.level();
                    found = Some(spots.clone());
                }
            }
            worst = pool.worst()?.clone();
        }
        found
    }

    /// Adds the boxes to the pool that random climbs find.
    fn look(&self, spots: &Spots, pool: &mut Pool, outside: &mut Vec<u8>, rng: &mut impl Rng) {
        for _ in 0..CLIMBS {
            let mut corner = spots.random_corner(rng);
            spots.climb(&mut corner, outside);
            pool.add(spots, corner);
            if self.deadline.passed() {
                return;
            }
        }
    }

    /// Looks for boxes that are worse than the threshold near the worst boxes that are known.
    fn check(&self, spots: &Spots, pool: &mut Pool, outside: &mut Vec<u8>, threshold: f64) -> bool {
        for mut corner in pool.worst_ones(CHECKS) {
            let difference = spots.climb(&mut corner, outside);
            pool.add_later(corner);
            if difference > threshold {
                return false;
            }
        }
        true
    }

    /// Measures a set, and keeps it if it is the best.
    fn improve(&self, spots: &Spots) {
        let points = spots.points();
        let set = PointSet::new(self.dims, &points).expect("the points stay in the cube");
        let value = Objective::Star.measured(&set, self.end).upper;
        self.best.improve(value, 0.0, || points);
    }
}

/// A move of a point along an axis.
struct Move {
    axis: usize,
    point: u32,
    to: f64,
}

/// Chooses a move that may make the worst box better, or any small move.
fn chosen(spots: &Spots, worst: &Corner, rng: &mut impl Rng) -> Move {
    // Steps of all sizes.
    let scale = libm::exp2(-14.0 * rng.random::<f64>());
    let kind: f64 = rng.random();
    let end = spots.len() as u32;
    if kind < 0.5 {
        let axis = rng.random_range(0..spots.dims());
        let point = worst.faces[axis];
        if point != end {
            let step = scale * 0.5 * spots.at(axis, point);
            let sign = if worst.is_empty() { -1.0 } else { 1.0 };
            return Move { axis, point, to: inside(spots.at(axis, point) + sign * step) };
        }
    }
    if kind < 0.8
        && let Some(found) = across(spots, worst, scale, rng)
    {
        return found;
    }
    let (axis, point) = (rng.random_range(0..spots.dims()), rng.random_range(0..end));
    let step = (rng.random::<f64>() - 0.5) * scale;
    Move { axis, point, to: inside(spots.at(axis, point) + step) }
}

/// Moves a random point across a face of a box: into the box if it has too few points, out of it if it has too many.
fn across(spots: &Spots, corner: &Corner, scale: f64, rng: &mut impl Rng) -> Option<Move> {
    let first = rng.random_range(0..spots.len());
    for at in 0..spots.len() {
        let point = ((first + at) % spots.len()) as u32;
        let is_beyond =
            |axis: &usize| corner.kind.is_beyond(spots.at(*axis, point), spots.at(*axis, corner.faces[*axis]));
        let mut beyond = (0..spots.dims()).filter(is_beyond);
        if corner.is_empty() {
            // A point that only one face keeps out.
            if let (Some(axis), None) = (beyond.next(), beyond.next()) {
                let face = spots.at(axis, corner.faces[axis]);
                return Some(Move { axis, point, to: inside(face - 1e-9 - scale * 0.3 * face) });
            }
        } else if beyond.next().is_none() {
            let axis = rng.random_range(0..spots.dims());
            let face = spots.at(axis, corner.faces[axis]);
            return Some(Move { axis, point, to: inside(face + 1e-9 + scale * 0.3 * (1.0 - face)) });
        }
    }
    None
}

fn inside(x: f64) -> f64 {
    x.clamp(0.0, 1.0_f64.next_down())
}
