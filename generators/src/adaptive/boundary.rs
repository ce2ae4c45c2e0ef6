//! Level-set search: tests that show where passing turns into failing, instead of one more failure.
//!
//! The next test is where the model of the robustness is least sure on which side of 0 it is: the straddle heuristic,
//! `1.96 deviation - |mean|` (Bryan et al., NIPS 2005). Candidates are random places, places between a failed and a
//! passed test, as a bisection would choose them, and places near tests that were close calls. A place is worth less
//! if the model expects an error there. As long as nothing failed, the same rule leads to places where a failure is
//! likely or little is known.

use super::Adaptive;
use super::cube::Axis;
use super::places::{nudged, snapped};
use super::surrogate::{Surrogate, View};
use super::{Evaluation, Optimiser, anywhere};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};
use rand::Rng;
use rand_pcg::Pcg64;

impl Strategy {
    /// The strategy "boundary", which maps the boundary between passing and failing by a Gaussian process.
    pub const BOUNDARY: Self = Self::of(&Descriptor {
        name: "boundary",
        about: "a model says where passing turns into failing: maps the border instead of finding one failure",
        dims: ANY,
        look: Look::hollow(0x7b_3294, MarkShape::Circle),
        method: Method(MethodKind::Search {
            seeks_a_failure: false,
            build: |it, request, rules| {
                Adaptive::build(it, request, rules, |axes, rng| Box::new(Boundary::new(axes, rng)))
            },
        }),
    });
}

/// The number of candidates for each axis, within limits.
const CANDIDATES: usize = 120;

/// The number of deviations that make a place interesting: the 95 % interval.
const DEVIATIONS: f64 = 1.96;

/// The loss of worth of a place that is certain to be in error.
const ERROR: f64 = 3.0;

/// The number of close calls near which candidates are placed.
const CLOSE_CALLS: usize = 20;

/// The step from a close call to a candidate.
const STEP: f64 = 0.1;

/// The search for the boundary between passing and failing.
pub(super) struct Boundary {
    surrogate: Surrogate,
    rng: Pcg64,
}

impl Boundary {
    pub(super) fn new(axes: Vec<Axis>, rng: Pcg64) -> Self {
        Self { surrogate: Surrogate::new(axes), rng }
    }

    fn candidates(&mut self) -> Vec<Vec<f64>> {
        let axes = self.surrogate.axes();
        let rng = &mut self.rng;
        let mut ran: Vec<&Evaluation> =
            self.surrogate.trials().iter().filter(|trial| trial.robustness.is_some()).collect();
        let (failed, passed): (Vec<&Evaluation>, Vec<&Evaluation>) = ran.iter().partition(|trial| trial.cost() < 0.0);
        ran.sort_by(|a, b| a.cost().abs().total_cmp(&b.cost().abs()));
        ran.truncate(CLOSE_CALLS);
        (0..(CANDIDATES * axes.len()).clamp(240, 480))
            .map(|index| match index % 4 {
                0 if !failed.is_empty() && !passed.is_empty() => {
                    let a = failed[rng.random_range(0..failed.len())];
                    let b = passed[rng.random_range(0..passed.len())];
                    let t: f64 = rng.random();
                    let between = |(a, b): (&f64, &f64)| a + t * (b - a);
                    snapped(axes, a.at.iter().zip(&b.at).map(between).collect())
                }
                1 if !ran.is_empty() => nudged(axes, &ran[rng.random_range(0..ran.len())].at, STEP, rng),
                _ => snapped(axes, anywhere(axes, rng)),
            })
            .collect()
    }
}

impl Optimiser for Boundary {
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>> {
        let candidates = self.candidates();
        self.surrogate.choose(n, View::Sides, candidates, |_, mean, deviation, runs| {
            DEVIATIONS * deviation - mean.abs() - ERROR * (1.0 - runs)
        })
    }

    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        self.surrogate.learn(proposal, trial);
    }
}
