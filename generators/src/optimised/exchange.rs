//! Searches for points with a small measure in any dimension: points move one at a time, mostly into the largest empty box.
//!
//! A move counts if the measure stays below a threshold, which is somewhat above the best value and falls to it (threshold accepting, Dueck, Scheuer, J.
//! Comput. Phys. 90, 1990). The measure is exact in each step.

use super::objective::{Found, Hole, Objective};
use super::shared::Shared;
use crate::seeded::{Purpose, seeded};
use paracosm_coverage::{Deadline, PointSet};
use rand::Rng;
use std::sync::atomic::{AtomicBool, Ordering};

/// The number of moves between two starts from the best set.
const MOVES: usize = 1000;

/// The share by which a set may be worse than the best set after a start. It falls to 0 until the next start.
const SLACK: f64 = 0.03;

/// The share of the best value that an improvement gains at least.
const LEAST_GAIN: f64 = 1e-9;

/// Returns points whose measure is at most the measure of the given points, and whether the time was enough to measure them. `watch` is called with the value of each
/// better set.
pub(super) fn improved(
    objective: Objective,
    points: &PointSet,
    seed: u64,
    deadline: Deadline,
    watch: &(dyn Fn(f64) + Sync),
) -> (PointSet, bool) {
    let dims = points.dims();
    let value = objective.measured(points, deadline).upper;
    let has_measured = AtomicBool::new(false);
    let best = Shared::new(rows(points), value, watch).searched(seed, |best, rng| {
        Search { objective, dims, best, has_measured: &has_measured, deadline }.run(rng);
    });
    (PointSet::new(dims, best).expect("the points stay in the cube"), has_measured.into_inner())
}

/// Returns points whose measure is at most the measure of the given points, after a number of moves. The result depends on nothing else.
pub(super) fn after_moves(objective: Objective, points: &PointSet, moves: usize) -> PointSet {
    let (dims, deadline) = (points.dims(), Deadline::never());
    let value = objective.measured(points, deadline).upper;
    let best = Shared::new(rows(points), value, &|_| ());
    let search = Search { objective, dims, best: &best, has_measured: &AtomicBool::new(false), deadline };
    search.round(moves, &mut seeded(0, Purpose::Search, 0));
    PointSet::new(dims, best.into_best()).expect("the points stay in the cube")
}

fn rows(points: &PointSet) -> Vec<Vec<f64>> {
    points.iter().map(<[f64]>::to_vec).collect()
}

/// A search of one thread.
struct Search<'a> {
    objective: Objective,
    dims: usize,
    best: &'a Shared<'a, Vec<Vec<f64>>>,
    has_measured: &'a AtomicBool,
    deadline: Deadline,
}

impl Search<'_> {
    fn run(&self, rng: &mut impl Rng) {
        while !self.deadline.passed() {
            self.round(MOVES, rng);
        }
    }

    /// Makes moves from the best set.
    fn round(&self, moves: usize, rng: &mut impl Rng) {
        let (mut points, _) = self.best.best();
        let Found { value, mut hole } = self.found(&points);
        if value.is_exact() {
            self.has_measured.store(true, Ordering::Relaxed);
        }
        for step in 0..moves {
            if self.deadline.passed() {
                return;
            }
            let left = 1.0 - step as f64 / moves as f64;
            let best = self.best.value();
            let (index, before) = moved(&mut points, hole.as_ref(), rng);
            let set = self.set(&points);
            if !self.objective.is_at_most(&set, best * (1.0 + SLACK * left * left), self.deadline) {
                points[index] = before;
                continue;
            }
            let found = self.objective.found(&set, self.deadline);
            if found.value.upper < best * (1.0 - LEAST_GAIN) {
                self.best.improve(found.value.upper, 0.0, || points.clone());
            }
            hole = found.hole;
        }
    }

    fn set(&self, points: &[Vec<f64>]) -> PointSet {
        PointSet::new(self.dims, points).expect("the points stay in the cube")
    }

    fn found(&self, points: &[Vec<f64>]) -> Found {
        self.objective.found(&self.set(points), self.deadline)
    }
}

/// Moves one point. Returns its index, and the point before.
fn moved(points: &mut [Vec<f64>], hole: Option<&Hole>, rng: &mut impl Rng) -> (usize, Vec<f64>) {
    let kind: f64 = rng.random();
    let inward = hole.filter(|_| kind < 0.7).and_then(|hole| Some((on_a_face(points, hole, rng)?, hole)));
    if let Some(((index, axis, is_low), hole)) = inward {
        let before = points[index].clone();
        let (low, high) = (hole.empty.lower[axis], hole.empty.upper[axis]);
        // Short moves more often than long ones.
        let share: f64 = rng.random();
        let step = (high - low) * 0.5 * share * share * share;
        points[index][hole.axes[axis]] = if is_low { low + step } else { high - step };
        return (index, before);
    }
    let index = rng.random_range(0..points.len());
    let before = points[index].clone();
    match hole.filter(|_| kind < 0.85) {
        Some(Hole { axes, empty }) => {
            for (axis, (low, high)) in axes.iter().zip(empty.lower.iter().zip(&empty.upper)) {
                points[index][*axis] = low + (high - low) * rng.random::<f64>();
            }
        }
        None => {
            let axis = rng.random_range(0..before.len());
            let step = (rng.random::<f64>() - 0.5) / points.len() as f64 * 4.0;
            points[index][axis] = (before[axis] + step).clamp(0.0, 1.0_f64.next_down());
        }
    }
    (index, before)
}

/// Returns a random point on a face of an empty box, the axis of the face among the axes of the box, and whether the face is the lower one.
fn on_a_face(points: &[Vec<f64>], hole: &Hole, rng: &mut impl Rng) -> Option<(usize, usize, bool)> {
    let axis = rng.random_range(0..hole.axes.len());
    let is_low: bool = rng.random();
    let face = if is_low { hole.empty.lower[axis] } else { hole.empty.upper[axis] };
    let is_beside = |point: &Vec<f64>| {
        hole.axes.iter().enumerate().all(|(other, &coordinate)| {
            let x = point[coordinate];
            if other == axis { x == face } else { (hole.empty.lower[other]..=hole.empty.upper[other]).contains(&x) }
        })
    };
    points.iter().position(is_beside).map(|index| (index, axis, is_low))
}
