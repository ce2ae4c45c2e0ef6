//! CMA-ES with restarts of two kinds (BIPOP; Hansen, GECCO workshop 2009), which tests a population at a time and is
//! robust on rough functions.
//!
//! The first run starts at the best test so far. The later runs alternate so that both kinds spend equally many
//! tests: runs whose population is doubled each time, which see the coarse shape, and short runs of small populations
//! and small steps, which look for a way in. Later starts are random.
//!
//! The first steps of a run move neighbouring pieces of a signal together (`signals`).
//!
//! Continuous coordinates are sampled from the normal distribution (`evolution`) and moved to the nearest place of
//! the cube, so that its corners are tested as such. Discrete coordinates are sampled from a probability of each
//! level. The probabilities move to the levels of the better half, as the mean does, and never fall below a floor
//! (estimation of distribution, as in Hamano et al., "CatCMA", GECCO 2024, without its natural gradient).
//!
//! Either every sample is tested, or the samples that a model chooses (`preselection`).

use super::cube::{Axis, level, middle};
use super::evolution::{Evolution, default_lambda};
use super::preselection::Preselection;
use super::{Adaptive, signals};
use super::{Evaluation, Optimiser, anywhere};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};
use nalgebra::DMatrix;
use rand::Rng;
use rand_pcg::Pcg64;

impl Strategy {
    /// The strategy "cmaes", which searches for a failure by CMA-ES with restarts (BIPOP) on the robustness.
    pub const CMAES: Self = Self::of(&Descriptor {
        name: "cmaes",
        about: "a distribution that learns where failures lie: for hundreds of tests and narrow valleys",
        dims: ANY,
        look: Look::filled(0xa0_1c1c, MarkShape::Diamond),
        method: Method(MethodKind::Search {
            seeks_a_failure: true,
            build: |it, request, rules| {
                Adaptive::build(it, request, rules, |axes, rng| {
                    Box::new(Cmaes::new(axes, signals::covariance(request.space), rng))
                })
            },
        }),
    });
}

impl Strategy {
    /// The strategy "gp-cmaes", which is CMA-ES with a Gaussian process that chooses the samples to test.
    pub const GP_CMAES: Self = Self::of(&Descriptor {
        name: "gp-cmaes",
        about: "cmaes with a model that chooses from its samples: few tests to a failure on most functions",
        dims: ANY,
        look: Look::hollow(0xa0_1c1c, MarkShape::Diamond),
        method: Method(MethodKind::Search {
            seeks_a_failure: true,
            build: |it, request, rules| {
                Adaptive::build(it, request, rules, |axes, rng| {
                    Box::new(Cmaes::preselected(axes, signals::covariance(request.space), rng))
                })
            },
        }),
    });
}

/// The first step size.
const SIGMA: f64 = 0.25;

/// The rate at which the probabilities of levels change.
const RATE: f64 = 0.3;

/// The greatest number of times that a population is doubled.
const MOST_DOUBLED: u32 = 9;

/// The search by CMA-ES with restarts.
pub(super) struct Cmaes {
    axes: Vec<Axis>,
    dims: usize,
    /// The covariance of the first steps of a run along the continuous axes.
    covariance: DMatrix<f64>,
    preselection: Option<Preselection>,
    run: Option<Run>,
    /// The number of runs with a large population, and the number of tests that each kind has spent.
    doubled: u32,
    spent: [usize; 2],
    best: Option<Evaluation>,
    proposals: usize,
    rng: Pcg64,
}

/// One run.
struct Run {
    evolution: Evolution,
    /// For each discrete axis, the probabilities of its levels.
    levels: Vec<Vec<f64>>,
    /// The kind of the run: 0 with a small population, 1 with a large one.
    kind: usize,
    /// The greatest number of tests of the run.
    most: usize,
    spent: usize,
    generation: Vec<Sample>,
}

struct Sample {
    proposal: usize,
    told: Option<Evaluation>,
}

impl Cmaes {
    pub(super) fn new(axes: Vec<Axis>, covariance: DMatrix<f64>, rng: Pcg64) -> Self {
        let (dims, preselection) = (covariance.nrows(), None);
        Self {
            axes,
            dims,
            covariance,
            preselection,
            run: None,
            doubled: 0,
            spent: [0; 2],
            best: None,
            proposals: 0,
            rng,
        }
    }

    /// Makes the CMA-ES search in which a Gaussian process chooses the samples to test.
    pub(super) fn preselected(axes: Vec<Axis>, covariance: DMatrix<f64>, rng: Pcg64) -> Self {
        Self { preselection: Some(Preselection::new(axes.clone())), ..Self::new(axes, covariance, rng) }
    }

    fn start(&mut self) -> Run {
        let default = default_lambda(self.axes.len());
        let is_first = self.doubled == 0;
        let large = default << self.doubled.min(MOST_DOUBLED);
        let kind = usize::from(is_first || self.spent[1] <= self.spent[0]);
        let (lambda, sigma, most) = if kind == 1 {
            self.doubled += 1;
            (large, SIGMA, usize::MAX)
        } else {
            let (u, v): (f64, f64) = (self.rng.random(), self.rng.random());
            let ratio = 0.5 * large as f64 / default as f64;
            let lambda = default as f64 * libm::pow(ratio.max(1.0), u * u);
            (lambda as usize, SIGMA * libm::pow(10.0, -2.0 * v), self.spent[1] / 2 + default)
        };
        let random = anywhere(&self.axes, &mut self.rng);
        let at = self.best.as_ref().filter(|_| is_first).map_or(random, |best| best.at.clone());
        let probabilities = |(u, axis): (&f64, &Axis)| match *axis {
            Axis::Continuous => None,
            Axis::Ordered(levels) | Axis::Nominal(levels) => {
                let mut all = vec![1.0 / levels as f64; levels];
                if is_first && self.best.is_some() {
                    // As if the search had learnt from the best test.
                    follow(&mut all, [(level(*u, levels), 1.0)].into_iter(), RATE);
                }
                Some(all)
            }
        };
        let levels = at.iter().zip(&self.axes).filter_map(probabilities).collect();
        let evolution = Evolution::new(at[..self.dims].to_vec(), sigma, lambda, self.covariance.clone());
        Run { evolution, levels, kind, most, spent: 0, generation: Vec::new() }
    }
}

/// Moves probabilities towards weighted levels; none falls below a floor.
fn follow(probabilities: &mut [f64], levels: impl Iterator<Item = (usize, f64)>, rate: f64) {
    let mut seen = vec![0.0; probabilities.len()];
    levels.for_each(|(level, weight)| seen[level] += weight);
    let floor = 0.1 / probabilities.len() as f64;
    for (probability, seen) in probabilities.iter_mut().zip(seen) {
        *probability = (*probability + rate * (seen - *probability)).max(floor);
    }
    let sum: f64 = probabilities.iter().sum();
    probabilities.iter_mut().for_each(|probability| *probability /= sum);
}

impl Run {
    fn sample(&self, rng: &mut Pcg64) -> Vec<f64> {
        let mut at: Vec<f64> = self.evolution.sample(rng).iter().map(|u| u.clamp(0.0, 1.0)).collect();
        for probabilities in &self.levels {
            let mut left: f64 = rng.random();
            let drawn = probabilities.iter().position(|probability| {
                left -= probability;
                left < 0.0
            });
            at.push(middle(drawn.unwrap_or(probabilities.len() - 1), probabilities.len()));
        }
        at
    }

    /// Learns from a generation whose results are all known.
    fn update(&mut self, dims: usize) {
        let mut told: Vec<Evaluation> = self.generation.drain(..).filter_map(|sample| sample.told).collect();
        told.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        self.spent += told.len();
        let weights = self.evolution.weights().to_vec();
        for (index, probabilities) in self.levels.iter_mut().enumerate() {
            let levels = probabilities.len();
            let seen =
                told.iter().zip(&weights).map(|(trial, &weight)| (level(trial.at[dims + index], levels), weight));
            follow(probabilities, seen, RATE);
        }
        let generation: Vec<(&[f64], f64)> = told.iter().map(|trial| (&trial.at[..dims], trial.cost())).collect();
        self.evolution.update(&generation);
    }

    fn is_over(&self) -> bool {
        self.evolution.is_over() || self.spent >= self.most
    }
}

impl Optimiser for Cmaes {
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>> {
        if self.run.as_ref().is_none_or(Run::is_over) {
            if let Some(run) = self.run.take() {
                self.spent[run.kind] += run.spent;
            }
            self.run = Some(self.start());
        }
        let run = self.run.as_mut().expect("one was started");
        let missing = run.evolution.lambda() - run.generation.len();
        let places: Vec<Vec<f64>> = match &mut self.preselection {
            None => (0..missing.min(n)).map(|_| run.sample(&mut self.rng)).collect(),
            Some(preselection) => {
                let out = run.generation.iter().filter(|sample| sample.told.is_none()).count();
                let n = missing.min(n).min(preselection.room(out));
                preselection.choose(n, self.best.as_ref(), || run.sample(&mut self.rng))
            }
        };
        for _ in &places {
            run.generation.push(Sample { proposal: self.proposals, told: None });
            self.proposals += 1;
        }
        places
    }

    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        if let Some(preselection) = &mut self.preselection {
            preselection.learn(proposal, trial);
        }
        if self.best.as_ref().is_none_or(|best| trial.cost() < best.cost()) {
            self.best = Some(trial.clone());
        }
        let Some((run, proposal)) = self.run.as_mut().zip(proposal) else { return };
        if let Some(sample) = run.generation.iter_mut().find(|sample| sample.proposal == proposal) {
            sample.told = Some(trial.clone());
        }
        let is_full = run.generation.len() == run.evolution.lambda();
        if is_full && run.generation.iter().all(|sample| sample.told.is_some()) {
            run.update(self.dims);
        }
    }
}
