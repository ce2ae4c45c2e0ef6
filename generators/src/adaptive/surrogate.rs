//! What strategies with a model have in common: the tests so far, the model of them, and the choice of a batch.
//!
//! Two Gaussian processes: one through the robustness, bent so that it fits (`Bend`), and, once tests ended in errors,
//! one through 0 where a test ran and 1 where it did not, with lengths that are not fitted: the hidden constraint. Far from all
//! errors it expects none. The model sees the few hundred tests that matter most to whoever asks, so a proposal costs the
//! same after a thousand tests as after three hundred.
//!
//! The tests of a batch, and those that are still out, are believed to come out as the model expects: so a batch spreads.

use super::Evaluation;
use super::bend::{Bend, is_failure};
use super::cube::Axis;
use super::fit::{fit, prior};
use super::log_ei::normal_below;
use super::process::{Kernel, Mean, Process};
use super::telling::telling;
use super::verdicts::Fitter;
use std::collections::BTreeMap;

/// So many tests the model sees.
const MOST_TESTS: usize = 220;

/// How many steps the first fit takes, and those after it.
const FIRST_FIT: usize = 40;
const LATER_FIT: usize = 8;

/// What the process of errors leaves to chance.
const ERROR_NOISE: f64 = 1e-2;

/// A test that runs with less probability is not chosen where there is another: deep in a region of errors much is unknown
/// and nothing to be learnt.
const WORTH_TRYING: f64 = 0.25;

/// Less probable than this makes no difference.
const LEAST_PROBABLE: f64 = 1e-12;

/// How many tests a batch has at most: those beyond it would be chosen by nothing but beliefs.
const MOST_BATCH: usize = 32;

/// Which tests matter, and how.
pub(super) enum View<'a> {
    /// Low values, near a place.
    Near(&'a [f64]),
    /// Which side of 0 values are on.
    Sides,
}

/// The tests so far.
pub(super) struct Surrogate {
    axes: Vec<Axis>,
    kernel: Kernel,
    is_fitted: bool,
    sides: Fitter,
    trials: Vec<Evaluation>,
    /// The proposals that are out.
    out: BTreeMap<usize, Vec<f64>>,
    /// Places whose tests are those of other places.
    repaired: Vec<Vec<f64>>,
    proposals: usize,
}

impl Surrogate {
    pub(super) fn new(axes: Vec<Axis>) -> Self {
        let (kernel, sides) = (prior(&axes), Fitter::new(&axes));
        let (trials, out, repaired) = (Vec::new(), BTreeMap::new(), Vec::new());
        Self { axes, kernel, is_fitted: false, sides, trials, out, repaired, proposals: 0 }
    }

    pub(super) fn axes(&self) -> &[Axis] {
        &self.axes
    }

    pub(super) fn trials(&self) -> &[Evaluation] {
        &self.trials
    }

    /// Along each axis how far places are alike.
    pub(super) fn lengths(&self) -> &[f64] {
        &self.kernel.lengths
    }

    /// Whether no proposal is out.
    pub(super) fn is_idle(&self) -> bool {
        self.out.is_empty()
    }

    /// The number of the next proposal.
    pub(super) fn proposals(&self) -> usize {
        self.proposals
    }

    pub(super) fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        if let Some(at) = proposal.and_then(|proposal| self.out.remove(&proposal))
            && at != trial.at
        {
            self.repaired.push(at);
        }
        if self.trials.iter().all(|known| known.at != trial.at) {
            self.trials.push(trial.clone());
        }
    }

    /// Whether a test there would be one that is known or out.
    fn is_known(&self, at: &[f64]) -> bool {
        let known = self.trials.iter().map(|trial| &trial.at).chain(self.out.values()).chain(&self.repaired);
        known.into_iter().any(|known| known == at)
    }

    /// Counts places as proposed.
    pub(super) fn send(&mut self, places: &[Vec<f64>]) {
        for at in places {
            self.out.insert(self.proposals, at.clone());
            self.proposals += 1;
        }
    }

    /// The candidates with the greatest worth, one after the other, at most `n`; none before two tests have come out.
    ///
    /// `worth` is given how the robustness was bent, the expected value, its deviation, and the probability that the test
    /// runs.
    pub(super) fn choose(
        &mut self,
        n: usize,
        view: View,
        candidates: Vec<Vec<f64>>,
        worth: impl Fn(Bend, f64, f64, f64) -> f64,
    ) -> Vec<Vec<f64>> {
        let Some((bend, process, errors)) = self.model(view) else { return Vec::new() };
        let out: Vec<Vec<f64>> = self.out.values().cloned().collect();
        let believed = out.len();
        let candidates = candidates.into_iter().filter(|at| !self.is_known(at));
        let places: Vec<Vec<f64>> = out.into_iter().chain(candidates).collect();
        let runs: Vec<f64> = match &errors {
            None => vec![1.0; places.len()],
            Some(errors) => {
                let errors = errors.posterior(places.clone());
                (0..errors.len()).map(|index| runs(errors.mean(index), errors.deviation(index))).collect()
            }
        };
        let mut posterior = process.posterior(places);
        (0..believed).for_each(|index| posterior.believe(index));
        let mut chosen = Vec::new();
        let mut open: Vec<usize> = (believed..posterior.len()).collect();
        if open.iter().any(|&index| runs[index] >= WORTH_TRYING) {
            open.retain(|&index| runs[index] >= WORTH_TRYING);
        }
        while chosen.len() < n.min(MOST_BATCH) && !open.is_empty() {
            let value = |index: usize| worth(bend, posterior.mean(index), posterior.deviation(index), runs[index]);
            let values = open.iter().map(|&index| value(index)).enumerate();
            // Of equal worth the first.
            let best = values.rev().max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((best, _)) = best else { break };
            let index = open.swap_remove(best);
            posterior.believe(index);
            let at = posterior.place(index).to_vec();
            open.retain(|&other| posterior.place(other) != at);
            chosen.push(at);
        }
        self.send(&chosen);
        chosen
    }

    /// The bend, the process of robustness and that of errors.
    fn model(&mut self, view: View) -> Option<(Bend, Process, Option<Process>)> {
        let (mut errored, ran): (Vec<&Evaluation>, Vec<&Evaluation>) =
            self.trials.iter().partition(|t| t.robustness.is_none());
        if ran.len() < 2 {
            return None;
        }
        let all: Vec<f64> = ran.iter().filter_map(|trial| trial.robustness).collect();
        let mut seen = ran;
        match view {
            View::Near(at) => {
                let distance = |trial: &Evaluation| self.kernel.scaled_distance(&trial.at, at);
                seen.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
                errored.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
                seen.truncate(MOST_TESTS);
            }
            View::Sides => {
                let places: Vec<&[f64]> = seen.iter().map(|trial| trial.at.as_slice()).collect();
                let failed: Vec<bool> = all.iter().map(|&robustness| is_failure(robustness)).collect();
                let chosen = telling(&self.kernel, &places, &failed, MOST_TESTS);
                seen = chosen.into_iter().map(|index| seen[index]).collect();
            }
        }
        let places: Vec<Vec<f64>> = seen.iter().map(|trial| trial.at.clone()).collect();
        let robustness: Vec<f64> = seen.iter().filter_map(|trial| trial.robustness).collect();
        let errors = errors(&self.axes, &places, &errored);
        let (bend, process) = match view {
            View::Near(_) => {
                let bend = Bend::low(&all);
                let values: Vec<f64> = robustness.iter().map(|&value| bend.apply(value)).collect();
                let steps = if self.is_fitted { LATER_FIT } else { FIRST_FIT };
                self.kernel = fit(&self.kernel, &places, &values, steps);
                self.is_fitted = true;
                (bend, Process::with_noise(&self.kernel, &places, &values)?)
            }
            View::Sides => {
                let verdicts = self.sides.fit(&places, &robustness)?;
                (verdicts.bend, verdicts.process)
            }
        };
        Some((bend, process, errors))
    }
}

/// The process of errors, once there are some.
fn errors(axes: &[Axis], ran: &[Vec<f64>], errored: &[&Evaluation]) -> Option<Process> {
    let most = MOST_TESTS / 2;
    let ran = ran.iter().take(most).map(|at| (at.clone(), 0.0));
    let errored = errored.iter().take(most).map(|trial| (trial.at.clone(), 1.0));
    let some = errored.len() > 0;
    let (places, labels): (Vec<_>, Vec<f64>) = ran.chain(errored).unzip();
    let kernel = Kernel { noise: ERROR_NOISE, ..prior(axes) };
    some.then(|| Process::new(kernel, places, &labels, Mean::Known(0.0))).flatten()
}

/// The probability that a label, 0 where a test runs and 1 where it does not, is the former's side of a half.
fn runs(mean: f64, deviation: f64) -> f64 {
    normal_below((0.5 - mean) / deviation.max(ERROR_NOISE)).max(LEAST_PROBABLE)
}
