//! Strategies that learn: they are driven by the robustness of the tests so far, towards the tests that fail.
//!
//! All begin with the same kind of opening (`opening`: corners and Halton points) and search in the same cube (`cube`),
//! in which discrete parameters are axes too. What a strategy does on its own is a [`Optimiser`]: it proposes places, and is
//! told how each test went. [`Adaptive`] makes a generator of it, and looks after what all have in common:
//!
//! - A test is never proposed twice: a search that comes back to one is told what is known, at no cost.
//! - A search that waits for outcomes does not hold up a campaign: where it has nothing to propose, the low-dispersion
//!   points of the opening go on. So whoever asks always gets a test, until a space without continuous parameters has no
//!   more.
//! - What comes back may be anything: a test in error, or a robustness that is no number, is an *errored* test to the
//!   search; infinities and very large numbers are cut off at a million.

mod anneal;
mod auto;
mod bayes;
mod bend;
mod boundary;
mod chains;
mod cmaes;
mod cube;
mod evolution;
mod failure_model;
mod fit;
mod log_ei;
mod nelder_mead;
mod opening;
mod places;
mod plausible;
mod preselection;
mod process;
mod pso;
mod region;
mod signals;
mod solver;
mod surrogate;
mod telling;
mod verdicts;

pub use failure_model::{FailingShare, FailureModel};

use crate::{
    DiscreteFamily, Generator, GeneratorError, Request, Strategy,
    family::Family,
    seeded::{Purpose, mix, seeded},
    strategy::Descriptor,
};
use cube::{Axis, Cube};
use opening::Opening;
use paracosm_space::Point;
use paracosm_space::rules::Rules;
use rand::Rng;
use rand_pcg::Pcg64;
use std::collections::BTreeMap;

/// The strategies of this folder, in the order in which they are shown.
pub(crate) const ALL: &[Strategy] = &[
    Strategy::ANNEAL,
    Strategy::PSO,
    Strategy::NELDER_MEAD,
    Strategy::CMAES,
    Strategy::GP_CMAES,
    Strategy::BAYES,
    Strategy::BOUNDARY,
    Strategy::AUTO,
];

/// Beyond it a robustness says nothing more.
const MOST_ROBUSTNESS: f64 = 1e6;

/// What searches that only compare numbers take an errored test for: worse than any other.
const ERRORED: f64 = 1e9;

/// Costs that differ by less than this share of the best are alike.
const ALIKE: f64 = 0.01;

/// How often in a row a search may come back to tests whose outcomes are known.
const MOST_ROUNDS: usize = 20;

/// How many random rows are tried for one that was not tested, where there are too many to go through.
const MOST_TRIES: usize = 1000;

/// A search through the cube.
trait Optimiser: Send {
    /// The places to test next, at most `n`; none while it waits to be told. They are numbered in order, from 0.
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>>;

    /// How a test went: its own proposal of a number, or one from elsewhere.
    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation);
}

/// A test with its outcome.
#[derive(Debug, Clone, PartialEq)]
struct Evaluation {
    /// Where in the cube it is, after all repairs.
    at: Vec<f64>,
    /// Its robustness, a finite number; `None` of an errored test.
    robustness: Option<f64>,
}

impl Evaluation {
    /// What there is to minimise.
    fn cost(&self) -> f64 {
        self.robustness.unwrap_or(ERRORED)
    }
}

/// A test is known by its coordinates, to the last bit.
type Key = (Vec<u64>, Vec<usize>);

/// What is known of a test.
enum State {
    /// Proposed; these proposals of the search wait for it.
    Asked(Vec<usize>),
    /// Told.
    Told(Evaluation),
}

/// A search as a generator.
struct Adaptive {
    cube: Cube,
    opening: Opening,
    search: Box<dyn Optimiser>,
    proposals: usize,
    tests: BTreeMap<Key, State>,
    /// Without continuous parameters, all rows where they are few, and how many of them have been gone through.
    all: Option<(Family, u64)>,
    seed: u64,
}

impl Adaptive {
    /// A generator of an adaptive strategy: its search through these axes, by these random numbers.
    ///
    /// # Errors
    /// The family is too large, or the request asks for what only open-loop strategies give.
    fn build(
        strategy: &Descriptor,
        request: &Request,
        rules: Rules,
        search: impl FnOnce(Vec<Axis>, Pcg64) -> Box<dyn Optimiser>,
    ) -> Result<Box<dyn Generator>, GeneratorError> {
        if request.epsilon.is_some() {
            return Err(GeneratorError::NoEpsilon { strategy: strategy.name });
        }
        if !request.existing.is_empty() {
            return Err(GeneratorError::NoExtension { strategy: strategy.name });
        }
        let family = Family::new(&rules, request)?;
        let all = if request.space.dims() == 0 {
            let cross = Request { discrete: DiscreteFamily::Cross, k: None, rows: None, ..*request };
            let few = rules.levels().iter().try_fold(1_usize, |rows, &n| rows.checked_mul(n).filter(|&n| n <= 100_000));
            few.map(|_| Family::new(&rules, &cross)).transpose()?.map(|family| (family, 0))
        } else {
            None
        };
        let cube = Cube::new(request.space, rules);
        let seed = request.seed.unwrap_or(0);
        let (axes, rng) = (cube.axes().to_vec(), seeded(seed, Purpose::Search, 0));
        let search = search(axes, rng);
        let opening = Opening::new(request, family);
        Ok(Box::new(Self { cube, opening, search, proposals: 0, tests: BTreeMap::new(), all, seed }))
    }

    /// Proposals of the search that are new.
    fn searched(&mut self, n: usize) -> Vec<Point> {
        let mut tests = Vec::new();
        for _ in 0..MOST_ROUNDS {
            let places = self.search.propose(n);
            if places.is_empty() {
                break;
            }
            for at in places {
                let (proposal, point) = (self.proposals, self.cube.point(&at));
                self.proposals += 1;
                match self.tests.get_mut(&key(&point)) {
                    Some(State::Told(trial)) => self.search.learn(Some(proposal), trial),
                    Some(State::Asked(proposals)) => proposals.push(proposal),
                    None => {
                        self.tests.insert(key(&point), State::Asked(vec![proposal]));
                        tests.push(point);
                    }
                }
            }
            if !tests.is_empty() {
                break;
            }
        }
        tests
    }

    /// A test that nobody asked for, if there is one: the next of the opening, or a row that was not tested.
    fn another(&mut self) -> Option<Point> {
        if self.cube.dims() > 0 || !self.opening.is_over() {
            // Points of a sequence differ, but rows repeat, and a search may have been there.
            while self.cube.dims() > 0 || !self.opening.is_over() {
                let point = self.opening.next();
                if self.insert(&point) {
                    return Some(point);
                }
            }
        }
        if let Some((family, next)) = &mut self.all {
            let tests = &self.tests;
            // From a place that the seed decides, or the first levels would be tested first.
            let start = mix(self.seed) % family.len();
            let row = |index: u64| family.row((start + index) % family.len());
            let new = |index: &u64| !tests.contains_key(&(Vec::new(), row(*index)));
            let found = (*next..family.len()).find(new);
            *next = found.map_or(family.len(), |index| index + 1);
            let point = Point { continuous: Vec::new(), discrete: row(found?) };
            self.insert(&point);
            return Some(point);
        }
        let mut rng = seeded(self.seed, Purpose::Search, 1 + self.tests.len() as u64);
        (0..MOST_TRIES).find_map(|_| {
            let at: Vec<f64> = self.cube.axes().iter().map(|_| rng.random()).collect();
            let point = self.cube.point(&at);
            self.insert(&point).then_some(point)
        })
    }

    /// Whether the test is new; then it counts as asked.
    fn insert(&mut self, point: &Point) -> bool {
        let new = !self.tests.contains_key(&key(point));
        if new {
            self.tests.insert(key(point), State::Asked(Vec::new()));
        }
        new
    }
}

impl Generator for Adaptive {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let mut tests = Vec::new();
        while tests.len() < n && !self.opening.is_over() {
            tests.extend(self.another());
        }
        if tests.is_empty() && n > 0 {
            tests = self.searched(n);
        }
        if tests.is_empty() && n > 0 {
            tests.extend(self.another());
        }
        tests
    }

    fn tell(&mut self, tests: &[Point], robustness: &[Option<f64>]) {
        for (test, robustness) in tests.iter().zip(robustness) {
            let robustness = robustness.filter(|robustness| !robustness.is_nan());
            let robustness = robustness.map(|robustness| robustness.clamp(-MOST_ROBUSTNESS, MOST_ROBUSTNESS));
            let trial = Evaluation { at: self.cube.place(test), robustness };
            let state = self.tests.insert(key(test), State::Told(trial.clone()));
            match state {
                Some(State::Asked(proposals)) if !proposals.is_empty() => {
                    proposals.into_iter().for_each(|proposal| self.search.learn(Some(proposal), &trial));
                }
                // Told twice, it is the same test still.
                Some(State::Told(_)) => {}
                _ => self.search.learn(None, &trial),
            }
        }
    }
}

fn key(point: &Point) -> Key {
    (point.continuous.iter().map(|u| u.to_bits()).collect(), point.discrete.clone())
}

/// Whether costs differ by less than they are away from 0, by far: then what is near them will hardly fail.
fn are_alike(costs: impl Iterator<Item = f64>) -> bool {
    let (least, most) = costs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), cost| (a.min(cost), b.max(cost)));
    most - least <= ALIKE * least.abs()
}

/// A uniformly random place.
fn anywhere(axes: &[Axis], rng: &mut impl Rng) -> Vec<f64> {
    axes.iter().map(|_| rng.random()).collect()
}

/// A normally distributed number (Box and Muller 1958).
fn normal(rng: &mut impl Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * libm::log(1.0 - u)).sqrt() * libm::cos(std::f64::consts::TAU * v)
}
