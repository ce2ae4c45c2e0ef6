//! A trust region: a box around the best test, whose size follows the success of the model.
//!
//! The method is TuRBO (Eriksson et al., NeurIPS 2019). The sides are in proportion to the lengths of the model.
//! Batches that improve on the best test make the box larger, and batches in a row that do not improve make it
//! smaller. When the box has become tiny, the search goes elsewhere and begins with a new design.

use super::cube::Axis;
use super::places::{nudged, snapped};
use super::{Evaluation, anywhere};
use rand::Rng;

/// The first length of a side, the greatest length and the least length.
const FIRST: f64 = 0.8;
const LONGEST: f64 = 1.6;
const SHORTEST: f64 = 1.0 / 128.0;

/// The number of improving batches in a row that make the box larger.
const SUCCESSES: usize = 3;

/// The least improvement of a batch on the best test, as a share of the best cost.
const IMPROVEMENT: f64 = 1e-3;

/// The distance by which a side reaches beyond its ends, so that ends of the axes are among the candidates.
const BEYOND: f64 = 0.03;

/// A trust region, which is a box around the best test whose size follows the progress of the search.
pub(super) struct Region {
    best: Option<Evaluation>,
    side: f64,
    successes: usize,
    failures: usize,
    improved: bool,
}

impl Region {
    pub(super) fn new() -> Self {
        Self { best: None, side: FIRST, successes: 0, failures: 0, improved: false }
    }

    /// Returns the best test since the search began this region.
    pub(super) fn best(&self) -> Option<&Evaluation> {
        self.best.as_ref()
    }

    /// Takes the result of a test.
    pub(super) fn learn(&mut self, trial: &Evaluation) {
        let cost = trial.cost();
        let Some(best) = self.best.as_ref().map(Evaluation::cost) else {
            self.best = Some(trial.clone());
            return;
        };
        self.improved |= cost < best - IMPROVEMENT * best.abs();
        if cost < best {
            self.best = Some(trial.clone());
        }
    }

    /// Resizes the region after a batch of `batch` tests, and returns `true` if the region is still worth tests.
    pub(super) fn is_worth_it_after(&mut self, batch: usize, axes: usize) -> bool {
        if self.improved {
            (self.successes, self.failures) = (self.successes + 1, 0);
        } else {
            (self.successes, self.failures) = (0, self.failures + 1);
        }
        self.improved = false;
        if self.successes == SUCCESSES {
            (self.side, self.successes) = ((2.0 * self.side).min(LONGEST), 0);
        } else if self.failures == axes.max(4).div_ceil(batch.max(1)) {
            (self.side, self.failures) = (0.5 * self.side, 0);
        }
        self.side >= SHORTEST
    }

    /// Draws candidates for the next tests. Most candidates are in the box, some near the best test, some on edges,
    /// some anywhere.
    pub(super) fn candidates(&self, n: usize, axes: &[Axis], lengths: &[f64], rng: &mut impl Rng) -> Vec<Vec<f64>> {
        let Some(best) = &self.best else { return Vec::new() };
        let mean_log = lengths.iter().map(|&length| libm::log(length)).sum::<f64>() / lengths.len() as f64;
        let sides: Vec<f64> = lengths.iter().map(|length| self.side * length / libm::exp(mean_log)).collect();
        let share = (20.0 / axes.len() as f64).min(1.0);
        let inside = |rng: &mut _| {
            let place = best
                .at
                .iter()
                .zip(&sides)
                .zip(axes)
                .map(|((&middle, &side), axis)| in_side(*axis, middle, side, share, rng));
            snapped(axes, place.collect())
        };
        (0..n)
            .map(|index| match index % 10 {
                0..6 => inside(rng),
                6 => nudged(axes, &best.at, 0.1 * self.side, rng),
                8 if index % 20 < 10 => to_ends(axes, inside(rng), rng),
                7 | 8 => to_ends(axes, best.at.clone(), rng),
                _ => snapped(axes, anywhere(axes, rng)),
            })
            .collect()
    }
}

/// A place with a random share of its continuous coordinates moved to the nearer end, because failures are often at
/// corners and edges.
fn to_ends(axes: &[Axis], mut at: Vec<f64>, rng: &mut impl Rng) -> Vec<f64> {
    let share: f64 = rng.random();
    for (u, _) in at.iter_mut().zip(axes).filter(|(_, axis)| **axis == Axis::Continuous) {
        if rng.random::<f64>() < share {
            *u = u.round();
        }
    }
    snapped(axes, at)
}

/// A random coordinate within a side, or the unchanged middle.
fn in_side(axis: Axis, middle: f64, side: f64, share: f64, rng: &mut impl Rng) -> f64 {
    let changes = rng.random::<f64>() < share;
    let random: f64 = rng.random();
    let (low, high) = ((middle - 0.5 * side).max(0.0), (middle + 0.5 * side).min(1.0));
    let inside = low - BEYOND + (high - low + 2.0 * BEYOND) * random;
    match axis {
        Axis::Continuous if changes => inside,
        Axis::Ordered(_) if changes && rng.random::<f64>() < 0.7 => inside,
        Axis::Ordered(_) | Axis::Nominal(_) if changes && rng.random::<f64>() < side.min(0.5) => rng.random(),
        _ => middle,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::{Purpose, seeded};

    fn at(x: f64, robustness: f64) -> Evaluation {
        Evaluation { at: vec![x, x], robustness: Some(robustness) }
    }

    #[test]
    fn it_grows_with_success_shrinks_without_and_ends_when_tiny() {
        let mut region = Region::new();
        region.learn(&at(0.5, 9.0));
        for cost in [8.0, 7.0, 6.0] {
            region.learn(&at(0.4, cost));
            assert!(region.is_worth_it_after(4, 2));
        }
        assert_eq!(region.side, LONGEST);
        let shrinks = (0..100).take_while(|_| region.is_worth_it_after(4, 2)).count();
        // 1.6 halved until it is below 1/128, a batch of four each time.
        assert_eq!(shrinks, 7);
        assert_eq!(region.best().unwrap().robustness, Some(6.0));
    }

    #[test]
    fn candidates_lie_in_the_box_and_reach_the_ends_of_the_axes() {
        let mut region = Region::new();
        region.learn(&at(0.05, 1.0));
        region.side = 0.2;
        let axes = [Axis::Continuous, Axis::Ordered(4)];
        let places = region.candidates(1000, &axes, &[1.0, 1.0], &mut seeded(1, Purpose::Search, 0));
        let near = places.iter().filter(|at| at[0] <= 0.15 + BEYOND + 1e-9).count();
        assert!((750..950).contains(&near), "{near}");
        assert!(places.iter().any(|at| at[0] == 0.0));
        assert!(places.iter().all(|at| [0.125, 0.375, 0.625, 0.875].contains(&at[1])));
    }
}
