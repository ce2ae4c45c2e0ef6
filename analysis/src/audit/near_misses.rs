//! Near misses: tests that the driver of a study passes with little robustness.
//!
//! A defect changes a verdict most easily where little is missing. So a test that the driver just passes notices more mutants than a
//! random test, and no mutant has to be tried to find it.

use super::Runs;
use super::suite::Suite;
use paracosm_campaign::{Error, Study, Trial};
use paracosm_generators::Strategy;
use paracosm_space::Point;
use std::collections::{BTreeMap, BTreeSet};

/// The shares of the passing tests that count as near misses, first the nearest.
const SHARES: [f64; 5] = [1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0, 1.0];

/// Tests that wait to be taken, the nearest misses first, and each as far as possible from the tests that are there already.
pub(super) struct NearMisses {
    /// The tests by their share, the nearest last.
    left: Vec<Vec<Point>>,
}

impl NearMisses {
    /// Runs `tests` random tests, and ranks those that pass by their robustness in each requirement. The same study and numbers give
    /// the same tests.
    pub fn of(study: &Study, tests: usize, seed: u64, runs: &Runs) -> Result<Self, Error> {
        let pool = Suite::of_strategy(study, Strategy::RANDOM, tests, Some(seed))?;
        let values = pool.values(study);
        let trials = runs.given(study, &values)?;
        let passed: Vec<(usize, &Trial)> = trials
            .iter()
            .enumerate()
            .filter(|(_, trial)| trial.covers() && trial.violated().next().is_none())
            .collect();
        let ids: BTreeSet<&str> = passed.iter().flat_map(|(_, trial)| trial.decided().map(|(id, _)| id)).collect();
        // The least share of a test over all requirements.
        let mut shares: BTreeMap<usize, f64> = BTreeMap::new();
        for id in ids {
            let margin = |(test, trial): &(usize, &Trial)| Some((*test, trial.robustness(id)?));
            let mut margins: Vec<(usize, f64)> = passed.iter().filter_map(margin).collect();
            margins.sort_by(|a, b| a.1.total_cmp(&b.1));
            for (rank, (test, _)) in margins.iter().enumerate() {
                let share = shares.entry(*test).or_insert(1.0);
                *share = share.min(rank as f64 / margins.len() as f64);
            }
        }
        let mut left = vec![Vec::new(); SHARES.len()];
        for (test, share) in shares {
            let part = SHARES.iter().position(|limit| share < *limit).unwrap_or(SHARES.len() - 1);
            left[SHARES.len() - 1 - part].push(study.space().encode(&values[test])?);
        }
        Ok(Self { left })
    }

    /// Adds up to `count` tests to points, each as far as possible from the points that are there then. Returns the number.
    pub fn add(&mut self, count: usize, points: &mut Vec<Point>) -> usize {
        let before = points.len();
        while let Some(near) = self.left.last_mut() {
            spread(near, before + count - points.len(), points);
            if points.len() == before + count {
                break;
            }
            self.left.pop();
        }
        points.len() - before
    }
}

/// Moves up to `count` tests to points, each as far as possible from the points that are there then.
fn spread(tests: &mut Vec<Point>, count: usize, points: &mut Vec<Point>) {
    let mut distances: Vec<f64> = tests.iter().map(|test| nearest(test, points)).collect();
    for _ in 0..count.min(tests.len()) {
        let farthest = (0..distances.len()).rev().max_by(|a, b| distances[*a].total_cmp(&distances[*b]));
        let farthest = farthest.expect("one is left");
        distances.remove(farthest);
        let point = tests.remove(farthest);
        for (test, distance) in tests.iter().zip(&mut distances) {
            *distance = distance.min(squared(test, &point));
        }
        points.push(point);
    }
}

/// Returns the square of the distance of a test to the nearest of some points; infinity if there is none.
pub(super) fn nearest(test: &Point, points: &[Point]) -> f64 {
    points.iter().map(|point| squared(test, point)).fold(f64::INFINITY, f64::min)
}

/// Returns the square of the distance of two points. Two values of a discrete parameter are as far apart as the ends of an interval.
fn squared(a: &Point, b: &Point) -> f64 {
    let along = a.continuous.iter().zip(&b.continuous).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    along + a.discrete.iter().zip(&b.discrete).filter(|(a, b)| a != b).count() as f64
}
