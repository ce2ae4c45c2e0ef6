//! Bayesian optimisation: the next test is where the greatest improvement on the best test is expected.
//!
//! A Gaussian process (`process`, fitted by `fit`) models the robustness, and another models errors (`surrogate`).
//! The worth of a test is the logarithm of its expected improvement (`log_ei`) times its probability to run.
//! Candidates come from a trust region (`region`), and some from everywhere. The method is in Frazier's tutorial
//! (arXiv 1807.02811), the region in Eriksson et al. (NeurIPS 2019), the unknown constraint in Gelbart et al. (UAI
//! 2014).
//!
//! The kernel measures discrete coordinates by distances: the steps of an ordered axis, and 0 or 1 for a word.
//! Candidates are always valid levels, never between two levels.

use super::Adaptive;
use super::cube::Axis;
use super::log_ei::log_expected_improvement;
use super::places::snapped;
use super::region::Region;
use super::surrogate::{Surrogate, View};
use super::{Evaluation, Optimiser, anywhere};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};
use rand_pcg::Pcg64;

impl Strategy {
    /// The strategy "bayes", which searches for a failure by Bayesian optimisation of the robustness in a trust region.
    pub const BAYES: Self = Self::of(&Descriptor {
        name: "bayes",
        about: "a model of the robustness says which test is likely to fail: for few, costly tests",
        dims: ANY,
        look: Look::filled(0x7b_3294, MarkShape::Circle),
        method: Method(MethodKind::Search {
            seeks_a_failure: true,
            build: |it, request, rules| {
                Adaptive::build(it, request, rules, |axes, rng| Box::new(Bayes::new(axes, rng)))
            },
        }),
    });
}

/// The number of candidates for each axis, within limits.
const CANDIDATES: usize = 80;

/// The number of candidates for the first places of a new region.
const DESIGNS: usize = 200;

/// The search by Bayesian optimisation.
pub(super) struct Bayes {
    surrogate: Surrogate,
    region: Region,
    /// The number of the first proposal that belongs to the region.
    since: usize,
    /// The number of tests that the region's design still lacks.
    design: usize,
    batch: usize,
    rng: Pcg64,
}

impl Bayes {
    pub(super) fn new(axes: Vec<Axis>, rng: Pcg64) -> Self {
        Self { surrogate: Surrogate::new(axes), region: Region::new(), since: 0, design: 0, batch: 0, rng }
    }

    /// The first places of a new region: the least known of some random places.
    fn design(&mut self, n: usize) -> Vec<Vec<f64>> {
        let axes = self.surrogate.axes();
        let candidates = (0..DESIGNS).map(|_| snapped(axes, anywhere(axes, &mut self.rng))).collect();
        let near = anywhere(axes, &mut self.rng);
        let n = n.min(self.design);
        let places = self.surrogate.choose(n, View::Near(&near), candidates, |_, _, deviation, runs| deviation * runs);
        // A discrete space may have fewer places left.
        self.design = if places.len() < n { 0 } else { self.design - n };
        places
    }
}

impl Optimiser for Bayes {
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>> {
        if self.design > 0 {
            return self.design(n);
        }
        let Some((best, cost)) = self.region.best().and_then(|best| Some((best.at.clone(), best.robustness?))) else {
            return Vec::new();
        };
        let axes = self.surrogate.axes();
        let candidates = (CANDIDATES * axes.len()).clamp(200, 480);
        let candidates = self.region.candidates(candidates, axes, self.surrogate.lengths(), &mut self.rng);
        let places = self.surrogate.choose(n, View::Near(&best), candidates, |bend, mean, deviation, runs| {
            log_expected_improvement(bend.apply(cost), mean, deviation) + libm::log(runs)
        });
        self.batch += places.len();
        places
    }

    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        self.surrogate.learn(proposal, trial);
        if proposal.map_or(self.since == 0, |proposal| proposal >= self.since) {
            self.region.learn(trial);
        }
        if proposal.is_some() && self.surrogate.is_idle() && self.batch > 0 {
            let batch = std::mem::take(&mut self.batch);
            if !self.region.is_worth_it_after(batch, self.surrogate.axes().len()) {
                self.region = Region::new();
                self.since = self.surrogate.proposals();
                self.design = 2 * self.surrogate.axes().len().clamp(2, 10);
            }
        }
    }
}
