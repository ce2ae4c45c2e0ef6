//! Chooses the samples of a distribution that are worth a test, by a Gaussian process.
//!
//! An evolution strategy learns from the ranks of a generation, and most of its samples only repeat what tests nearby
//! have shown. So it draws many times as many samples as it tests. Those with the greatest logarithm of the expected
//! improvement (`log_ei`), given the tests so far, are tested: individual-based evolution control, as in Jin, "A
//! comprehensive survey of fitness approximation in evolutionary computation" (2005), and for CMA-ES Pitra, Bajer and
//! Holeňa (PPSN 2016). The distribution keeps the model near the tested places, and the model keeps the distribution
//! from testing what is known.
//!
//! A generation is tested in parts, so that the results of earlier samples help to choose the later ones.

use super::Evaluation;
use super::bend::Bend;
use super::cube::Axis;
use super::log_ei::log_expected_improvement;
use super::places::snapped;
use super::surrogate::{Surrogate, View};

/// The number of samples that are drawn for each tested sample.
const DRAWN: usize = 32;

/// The greatest number of tests without a result at a time.
const PART: usize = 4;

/// The model that chooses the samples of a distribution that are worth a test.
pub(super) struct Preselection {
    axes: Vec<Axis>,
    surrogate: Surrogate,
}

impl Preselection {
    pub(super) fn new(axes: Vec<Axis>) -> Self {
        Self { surrogate: Surrogate::new(axes.clone()), axes }
    }

    /// Returns the number of tests that may still be proposed while `out` tests have no result.
    pub(super) fn room(&self, out: usize) -> usize {
        PART.saturating_sub(out)
    }

    /// Chooses the `n` samples with the greatest expected improvement on the best test so far. If nothing is known, or
    /// few different samples are drawn, other samples fill up.
    pub(super) fn choose(
        &mut self,
        n: usize,
        best: Option<&Evaluation>,
        mut sample: impl FnMut() -> Vec<f64>,
    ) -> Vec<Vec<f64>> {
        let mut samples: Vec<Vec<f64>> = (0..DRAWN * n).map(|_| snapped(&self.axes, sample())).collect();
        let any = samples.split_off((DRAWN - 1) * n);
        let known = best.and_then(|best| Some((&best.at, best.robustness?)));
        let mut places = known.map_or_else(Vec::new, |(at, robustness)| {
            let worth = |bend: Bend, mean, deviation, runs| {
                log_expected_improvement(bend.apply(robustness), mean, deviation) + libm::log(runs)
            };
            self.surrogate.choose(n, View::Near(at), samples, worth)
        });
        let missing = n - places.len();
        self.surrogate.send(&any[..missing]);
        places.extend_from_slice(&any[..missing]);
        places
    }

    /// Takes the result of a test, which is a numbered proposal of this model or a test from elsewhere.
    pub(super) fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        self.surrogate.learn(proposal, trial);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::{Purpose, seeded};
    use rand::Rng;

    #[test]
    fn it_chooses_near_the_failure_among_samples_from_everywhere_and_none_twice() {
        let mut preselection = Preselection::new(vec![Axis::Continuous; 2]);
        let robustness = |at: &[f64]| (at[0] - 0.8) * (at[0] - 0.8) + (at[1] - 0.3) * (at[1] - 0.3);
        let mut rng = seeded(1, Purpose::Search, 0);
        let mut trials = Vec::new();
        for index in 0..25 {
            let at = vec![0.1 + 0.2 * f64::from(index % 5), 0.1 + 0.2 * f64::from(index / 5)];
            trials.push(Evaluation { robustness: Some(robustness(&at)), at });
            preselection.learn(None, &trials[index as usize]);
        }
        let best = trials.iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
        let chosen = preselection.choose(4, best, || vec![rng.random(), rng.random()]);
        assert_eq!(chosen.len(), 4);
        assert!(chosen.iter().all(|at| robustness(at) < 0.04), "{chosen:?}");
        assert!((1..4).all(|index| !chosen[..index].contains(&chosen[index])));
    }

    #[test]
    fn where_nothing_is_known_any_samples_will_do() {
        let mut preselection = Preselection::new(vec![Axis::Nominal(3)]);
        assert_eq!(preselection.choose(3, None, || vec![0.5]), [[0.5], [0.5], [0.5]]);
        assert_eq!([0, 3, 4, 9].map(|out| preselection.room(out)), [4, 1, 0, 0]);
    }
}
