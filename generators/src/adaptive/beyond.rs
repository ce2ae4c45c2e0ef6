//! A search for a failure beyond the basins that are known.
//!
//! The improvement that counts is not the improvement on the best test but a failure. So the worth of a test is the
//! logarithm of its expected improvement (`log_ei`) on the robustness 0. Near a minimum that a few tests have measured
//! the model is sure that nothing fails, so that the search leaves a basin that does not pay without any rule for
//! leaving. Where little is known, much may fail. This is the search for a known goal of Jones ("A taxonomy of global
//! optimization methods based on response surfaces", Journal of Global Optimization 21, 2001).

use super::cube::Axis;
use super::log_ei::log_expected_improvement;
use super::places::{nudged, snapped};
use super::surrogate::{Surrogate, View};
use super::{Evaluation, Optimiser, anywhere};
use rand::Rng;
use rand_pcg::Pcg64;

/// The number of candidates. One half lies anywhere, the other half near tests that ran.
const CANDIDATES: usize = 480;

/// The greatest step from a test to a candidate near it.
const REACH: f64 = 0.1;

/// The greatest number of tests without a result at a time.
const PART: usize = 4;

/// The search for a failure beyond the basins that are known.
pub(super) struct Beyond {
    surrogate: Surrogate,
    rng: Pcg64,
}

impl Beyond {
    pub(super) fn new(axes: Vec<Axis>, rng: Pcg64) -> Self {
        Self { surrogate: Surrogate::new(axes), rng }
    }

    /// Draws candidates, near the best of the given tests more often than near the others.
    fn candidates(axes: &[Axis], ran: &[&Evaluation], rng: &mut Pcg64) -> Vec<Vec<f64>> {
        let candidate = |index: usize| {
            if index.is_multiple_of(2) {
                return snapped(axes, anywhere(axes, rng));
            }
            let (rank, reach): (f64, f64) = (rng.random(), rng.random());
            nudged(axes, &ran[(rank * rank * ran.len() as f64) as usize].at, REACH * reach, rng)
        };
        (0..CANDIDATES).map(candidate).collect()
    }
}

impl Optimiser for Beyond {
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>> {
        let n = n.min(PART.saturating_sub(self.surrogate.out()));
        let trials = self.surrogate.trials().iter();
        let mut ran: Vec<&Evaluation> = trials.filter(|trial| trial.robustness.is_some()).collect();
        ran.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        let Some(best) = ran.first().filter(|_| n > 0).map(|best| best.at.clone()) else { return Vec::new() };
        let candidates = Self::candidates(self.surrogate.axes(), &ran, &mut self.rng);
        self.surrogate.choose(n, View::Near(&best), candidates, |bend, mean, deviation, runs| {
            log_expected_improvement(bend.apply(0.0), mean, deviation) + libm::log(runs)
        })
    }

    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        self.surrogate.learn(proposal, trial);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::{Purpose, seeded};

    #[test]
    fn it_leaves_a_basin_whose_floor_is_measured() {
        // The decoy has its floor of 1 at (0.2, 0.2), and the failure is at (0.8, 0.8), where no test is.
        let robustness = |at: &[f64]| {
            let square = |u: f64| (at[0] - u) * (at[0] - u) + (at[1] - u) * (at[1] - u);
            (1.0 + 20.0 * square(0.2)).min(40.0 * square(0.8) - 0.4)
        };
        let mut beyond = Beyond::new(vec![Axis::Continuous; 2], seeded(3, Purpose::Search, 0));
        for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
            let at = vec![0.1 + 0.05 * f64::from(i), 0.1 + 0.05 * f64::from(j)];
            beyond.learn(None, &Evaluation { robustness: Some(robustness(&at)), at });
        }
        let mut told = 0;
        let mut found = None;
        while found.is_none() && told < 60 {
            for at in beyond.propose(4) {
                let trial = Evaluation { robustness: Some(robustness(&at)), at };
                found = found.or((trial.cost() < 0.0).then_some(told));
                beyond.learn(Some(told), &trial);
                told += 1;
            }
        }
        assert!(found.is_some(), "no failure in {told} tests");
    }

    #[test]
    fn no_more_than_four_tests_are_without_a_result() {
        let mut beyond = Beyond::new(vec![Axis::Continuous; 2], seeded(1, Purpose::Search, 0));
        assert!(beyond.propose(4).is_empty(), "nothing is known");
        for at in [[0.3, 0.2], [0.7, 0.9], [0.5, 0.4]] {
            beyond.learn(None, &Evaluation { at: at.into(), robustness: Some(1.0 + at[0]) });
        }
        assert_eq!([3, 3, 3].map(|n| beyond.propose(n).len()), [3, 1, 0]);
    }
}
