//! The common part of strategies with a model: the tests so far, the model of them, and the choice of a batch.
//!
//! There are two Gaussian processes. One goes through the robustness, transformed so that it fits (`Bend`). Once
//! tests have ended in errors, the other goes through 0 for each test that ran and 1 for each error, with lengths
//! that are not fitted: the hidden constraint. Far from all errors it expects none. The model sees the few hundred
//! tests that matter most for the request, so that a proposal costs the same after a thousand tests as after three
//! hundred.
//!
//! The tests of a batch, and tests without a result, are assumed to have the expected result, so that a batch
//! spreads.

use super::Evaluation;
use super::bend::{Bend, is_failure};
use super::cube::Axis;
use super::fit::{fit, prior};
use super::log_ei::normal_below;
use super::process::{Kernel, Mean, Process};
use super::telling::telling;
use super::verdicts::Fitter;
use std::collections::BTreeMap;

/// The greatest number of tests that the model sees.
const MOST_TESTS: usize = 220;

/// The number of steps of the first fit, and of the later fits.
const FIRST_FIT: usize = 40;
const LATER_FIT: usize = 8;

/// The noise of the process of errors.
const ERROR_NOISE: f64 = 1e-2;

/// The least probability to run of a chosen test, if there is another: deep in a region of errors much is unknown,
/// but nothing can be learnt.
const WORTH_TRYING: f64 = 0.25;

/// The least probability that makes a difference.
const LEAST_PROBABLE: f64 = 1e-12;

/// The greatest number of tests of a batch: further tests would be chosen by assumptions only.
const MOST_BATCH: usize = 32;

/// The part of the tests that a model describes, with the purpose of the model.
pub(super) enum View<'a> {
    /// The model describes low robustness values near the given place.
    Near(&'a [f64]),
    /// The model describes the side of 0 on which robustness values are.
    Sides,
}

/// A model of the robustness and of errors that learns from the tests so far.
pub(super) struct Surrogate {
    axes: Vec<Axis>,
    kernel: Kernel,
    is_fitted: bool,
    sides: Fitter,
    trials: Vec<Evaluation>,
    /// The proposals without a result.
    out: BTreeMap<usize, Vec<f64>>,
    /// Places that were repaired, so that their tests are those of other places.
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

    /// Returns the length scale of each axis, which is the distance over which the robustness stays similar.
    pub(super) fn lengths(&self) -> &[f64] {
        &self.kernel.lengths
    }

    /// Returns `true` if all proposals have results.
    pub(super) fn is_idle(&self) -> bool {
        self.out.is_empty()
    }

    /// Returns the number of proposals without a result.
    pub(super) fn out(&self) -> usize {
        self.out.len()
    }

    /// Returns the number of the next proposal, which counts the proposals so far.
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

    /// Returns `true` if a test at this place is already known or proposed.
    fn is_known(&self, at: &[f64]) -> bool {
        let known = self.trials.iter().map(|trial| &trial.at).chain(self.out.values()).chain(&self.repaired);
        known.into_iter().any(|known| known == at)
    }

    /// Records places as proposals that have no result yet.
    pub(super) fn send(&mut self, places: &[Vec<f64>]) {
        for at in places {
            self.out.insert(self.proposals, at.clone());
            self.proposals += 1;
        }
    }

    /// Chooses the candidates with the greatest worth, one after the other, at most `n`; none before two tests have
    /// run.
    ///
    /// `worth` receives the transformation of the robustness, the expected value, its deviation, and the probability
    /// that the test runs.
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
            // The first among equals.
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

    /// The transformation, the process of the robustness, and the process of errors.
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

/// The process of errors, once there are errors.
fn errors(axes: &[Axis], ran: &[Vec<f64>], errored: &[&Evaluation]) -> Option<Process> {
    let most = MOST_TESTS / 2;
    let ran = ran.iter().take(most).map(|at| (at.clone(), 0.0));
    let errored = errored.iter().take(most).map(|trial| (trial.at.clone(), 1.0));
    let some = errored.len() > 0;
    let (places, labels): (Vec<_>, Vec<f64>) = ran.chain(errored).unzip();
    let kernel = Kernel { noise: ERROR_NOISE, ..prior(axes) };
    some.then(|| Process::new(kernel, places, &labels, Mean::Known(0.0))).flatten()
}

/// The probability that a test runs, from a label that is 0 for a run and 1 for an error: that the label is below a
/// half.
fn runs(mean: f64, deviation: f64) -> f64 {
    normal_below((0.5 - mean) / deviation.max(ERROR_NOISE)).max(LEAST_PROBABLE)
}
