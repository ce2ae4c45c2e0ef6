//! Near misses: tests that the driver of a study passes with little robustness.
//!
//! A defect changes a verdict most easily where little is missing. So a test that the driver just passes notices more mutants than a
//! random test, and no mutant has to be tried to find it.

use super::Runs;
use super::suite::Suite;
use paracosm_campaign::{Error, Study, Trial};
use paracosm_generators::Strategy;
use paracosm_space::{Point, SpaceError};
use std::collections::BTreeSet;

/// The number of tests that keep a requirement, for each near miss.
const OF: usize = 16;

/// Tests that wait to be taken, each as far as possible from the tests that are there already.
pub(super) struct NearMisses {
    left: Vec<Point>,
}

impl NearMisses {
    /// Runs `tests` random tests, and keeps the near misses of each requirement. The same study and numbers give the same tests.
    pub fn of(study: &Study, tests: usize, seed: u64, runs: &Runs) -> Result<Self, Error> {
        let pool = Suite::of_strategy(study, Strategy::RANDOM, tests, Some(seed))?;
        let values = pool.values(study);
        let trials = runs.of(study, &values)?;
        let passed: Vec<(usize, &Trial)> = trials
            .iter()
            .enumerate()
            .filter(|(_, trial)| trial.covers() && trial.violated().next().is_none())
            .collect();
        let ids: BTreeSet<&str> = passed.iter().flat_map(|(_, trial)| trial.decided().map(|(id, _)| id)).collect();
        let mut near = BTreeSet::new();
        for id in ids {
            let margin = |(test, trial): &(usize, &Trial)| Some((*test, trial.robustness(id)?));
            let mut margins: Vec<(usize, f64)> = passed.iter().filter_map(margin).collect();
            margins.sort_by(|a, b| a.1.total_cmp(&b.1));
            near.extend(margins.iter().take(margins.len().div_ceil(OF)).map(|(test, _)| *test));
        }
        let left = near.into_iter().map(|test| study.space().encode(&values[test]));
        Ok(Self { left: left.collect::<Result<_, SpaceError>>()? })
    }

    /// Adds up to `count` near misses to points, each as far as possible from the points that are there then. Returns the number.
    pub fn add(&mut self, count: usize, points: &mut Vec<Point>) -> usize {
        let nearest = |test: &Point| points.iter().map(|point| squared(test, point)).fold(f64::INFINITY, f64::min);
        let mut distances: Vec<f64> = self.left.iter().map(nearest).collect();
        let count = count.min(self.left.len());
        for _ in 0..count {
            let farthest = (0..distances.len()).rev().max_by(|a, b| distances[*a].total_cmp(&distances[*b]));
            let farthest = farthest.expect("one is left");
            distances.remove(farthest);
            let point = self.left.remove(farthest);
            for (test, distance) in self.left.iter().zip(&mut distances) {
                *distance = distance.min(squared(test, &point));
            }
            points.push(point);
        }
        count
    }
}

/// Returns the square of the distance of two points. Two values of a discrete parameter are as far apart as the ends of an interval.
pub(super) fn squared(a: &Point, b: &Point) -> f64 {
    let along = a.continuous.iter().zip(&b.continuous).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    along + a.discrete.iter().zip(&b.discrete).filter(|(a, b)| a != b).count() as f64
}
