//! Which samples of a distribution are worth a test: a Gaussian process chooses a few of many.
//!
//! An evolution strategy learns from the ranks of a generation, and most of its samples only tell it what tests nearby have
//! told before. So it draws many times as many as it tests, and of these are tested those with the greatest logarithm of
//! the expected improvement (`log_ei`) by the tests so far: individual-based evolution control, as in Jin, "A comprehensive
//! survey of fitness approximation in evolutionary computation" (2005), and for CMA-ES Pitra, Bajer and Holeňa (PPSN 2016). The distribution keeps the model near what has been tested, the model the distribution from
//! testing what it knows.
//!
//! A generation is tested in parts, so that the later samples are chosen by what came of the earlier ones.

use super::Evaluation;
use super::bend::Bend;
use super::cube::Axis;
use super::log_ei::log_expected_improvement;
use super::places::snapped;
use super::surrogate::{Surrogate, View};

/// How many samples are drawn for each that is tested.
const DRAWN: usize = 32;

/// How many tests are out at a time.
const PART: usize = 4;

/// The model that chooses.
pub(super) struct Preselection {
    axes: Vec<Axis>,
    surrogate: Surrogate,
}

impl Preselection {
    pub(super) fn new(axes: Vec<Axis>) -> Self {
        Self { surrogate: Surrogate::new(axes.clone()), axes }
    }

    /// How many more tests there may be while so many are out.
    pub(super) fn room(&self, out: usize) -> usize {
        PART.saturating_sub(out)
    }

    /// The `n` samples from which most is expected beyond the best test so far; where nothing is known, or few
    /// different ones are drawn, any.
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

    /// How a test went: its own of a number, or one from elsewhere.
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
