//! Runs several solvers side by side from different starts, so that methods that move one place at a time fill
//! batches.
//!
//! A solver is started only if the running solvers have nothing more to propose. If one test at a time is asked for,
//! a single solver runs; if many are, up to a fixed number. When a solver has ended, the next takes its place. The
//! first start is at the best test so far, the second at the next best test that is not near it. After a few of
//! these, starts are random.

use super::cube::Axis;
use super::solver::Solver;
use super::{Evaluation, Optimiser, anywhere};
use rand::Rng;
use rand_pcg::Pcg64;

/// The number of solvers that start from the best tests, before solvers start at random.
const BEST: usize = 3;

/// Two tests that are nearer than this on every axis are not different starts.
const NEAR: f64 = 0.1;

/// The start of a solver, with its place, the axes and the known tests.
pub(super) struct Start<'a> {
    /// The kinds of the axes of the cube.
    pub axes: &'a [Axis],
    /// The place in the cube at which the solver starts.
    pub at: Vec<f64>,
    /// All tests so far with their results, in ascending order of cost.
    pub trials: &'a [Evaluation],
    /// The generator of random numbers that only this solver uses.
    pub rng: Pcg64,
}

/// A function that starts a solver at a given start.
pub(super) type Launch = fn(Start) -> Solver;

/// A search that runs several solvers at a time and replaces solvers that have ended.
pub(super) struct Chains {
    axes: Vec<Axis>,
    launch: Launch,
    most: usize,
    running: Vec<Chain>,
    launched: usize,
    started_at: Vec<Vec<f64>>,
    trials: Vec<Evaluation>,
    proposals: usize,
    rng: Pcg64,
}

/// A solver with its batch.
struct Chain {
    solver: Solver,
    /// The places of the batch that are still to be proposed, the last first.
    open: Vec<Vec<f64>>,
    /// The proposals of the batch in order, with their costs once they are known.
    costs: Vec<(usize, Option<f64>)>,
}

impl Chains {
    /// Makes a search with at most `most` running solvers at a time.
    pub(super) fn new(axes: Vec<Axis>, launch: Launch, most: usize, rng: Pcg64) -> Self {
        Self {
            axes,
            launch,
            most,
            running: Vec::new(),
            launched: 0,
            started_at: Vec::new(),
            trials: Vec::new(),
            proposals: 0,
            rng,
        }
    }

    /// Starts another solver.
    fn start(&mut self) -> Chain {
        let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < NEAR);
        let far = |trial: &&Evaluation| self.started_at.iter().all(|start| !near(start, &trial.at));
        let best = self.trials.iter().filter(|_| self.launched < BEST).find(far).map(|trial| trial.at.clone());
        let at = best.unwrap_or_else(|| anywhere(&self.axes, &mut self.rng));
        self.started_at.push(at.clone());
        self.launched += 1;
        let rng = crate::seeded::seeded(self.rng.random(), crate::seeded::Purpose::Search, 0);
        let solver = (self.launch)(Start { axes: &self.axes, at, trials: &self.trials, rng });
        Chain { solver, open: Vec::new(), costs: Vec::new() }
    }
}

impl Chain {
    /// Returns `true` if there is a place to propose or a result to wait for. Takes the next batch if the last is
    /// answered.
    fn goes_on(&mut self) -> bool {
        if self.open.is_empty() && self.costs.is_empty() {
            self.open = self.solver.batch().unwrap_or_default();
            self.open.reverse();
        }
        !self.open.is_empty() || !self.costs.is_empty()
    }

    fn learn(&mut self, proposal: usize, cost: f64) {
        if let Some(own) = self.costs.iter_mut().find(|own| own.0 == proposal) {
            own.1 = Some(cost);
        }
        if self.open.is_empty()
            && let Some(costs) = self.costs.iter().map(|own| own.1).collect::<Option<Vec<f64>>>()
            && !costs.is_empty()
        {
            self.solver.answer(costs);
            self.costs.clear();
        }
    }
}

impl Optimiser for Chains {
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>> {
        let mut places = Vec::new();
        self.running.retain_mut(Chain::goes_on);
        for index in 0..self.most {
            if places.len() == n {
                break;
            }
            if index == self.running.len() {
                let mut chain = self.start();
                if !chain.goes_on() {
                    break;
                }
                self.running.push(chain);
            }
            let chain = &mut self.running[index];
            while places.len() < n
                && let Some(at) = chain.open.pop()
            {
                chain.costs.push((self.proposals, None));
                self.proposals += 1;
                places.push(at);
            }
        }
        places
    }

    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        if let Some(proposal) = proposal {
            self.running.iter_mut().for_each(|chain| chain.learn(proposal, trial.cost()));
        }
        let place = self.trials.partition_point(|other| other.cost() <= trial.cost());
        self.trials.insert(place, trial.clone());
    }
}
