//! Strategies that learn from the robustness of the tests so far, and move towards tests that fail.
//!
//! All strategies begin with the same kind of opening (`opening`: corners and Halton points) and search in the same
//! cube (`cube`), in which discrete parameters are axes too. The part that differs is an [`Optimiser`]: it proposes
//! places, and is told the result of each test. [`Adaptive`] makes a generator of an optimiser, and does the common
//! work:
//!
//! - It never proposes a test twice: a search that returns to a known test is told the known result, at no cost.
//! - A search that waits for results does not hold up a campaign: if it has nothing to propose, the low-dispersion
//!   points of the opening go on. So a request always gets a test, until a space without continuous parameters has no
//!   more.
//! - A result may be anything. A test in error, or with a robustness that is not a number, is an *errored* test for
//!   the search. Infinities and very large numbers are cut off at a million.

mod anneal;
mod auto;
mod bayes;
mod bend;
mod beyond;
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

/// The adaptive strategies, in the order in which lists show the strategies.
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

/// The greatest absolute value of a robustness: larger values are cut off.
const MOST_ROBUSTNESS: f64 = 1e6;

/// The cost of an errored test for searches that only compare numbers: worse than any other.
const ERRORED: f64 = 1e9;

/// Costs are alike if they differ by less than this share of the best cost.
const ALIKE: f64 = 0.01;

/// The number of times in a row that a search may propose only tests with known results.
const MOST_ROUNDS: usize = 20;

/// The number of random rows that are tried to find an untested row, if there are too many rows to go through.
const MOST_TRIES: usize = 1000;

/// A search through the cube.
trait Optimiser: Send {
    /// Returns the places to test next, at most `n`; none while the search waits for results. Proposals are numbered
    /// in order, from 0.
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>>;

    /// Tells the result of a test, which is a proposal of the search with its number, or a test from elsewhere.
    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation);
}

/// A test with its result.
#[derive(Debug, Clone, PartialEq)]
struct Evaluation {
    /// The place of the test in the cube, after all repairs.
    at: Vec<f64>,
    /// The robustness of the test, a finite number; `None` for an errored test.
    robustness: Option<f64>,
}

impl Evaluation {
    /// The cost to minimise.
    fn cost(&self) -> f64 {
        self.robustness.unwrap_or(ERRORED)
    }
}

/// The key of a test: its coordinates, to the last bit.
type Key = (Vec<u64>, Vec<usize>);

/// The state of a test.
enum State {
    /// The test was proposed; these proposals of the search wait for its result.
    Asked(Vec<usize>),
    /// The result of the test is known.
    Told(Evaluation),
}

/// A search as a generator of tests.
struct Adaptive {
    cube: Cube,
    opening: Opening,
    search: Box<dyn Optimiser>,
    proposals: usize,
    tests: BTreeMap<Key, State>,
    /// All rows of a space without continuous parameters, if they are few, and the number of rows gone through so
    /// far.
    all: Option<(Family, u64)>,
    seed: u64,
}

impl Adaptive {
    /// Makes a generator of an adaptive strategy. `search` makes its search from the axes and random numbers.
    ///
    /// # Errors
    /// The family is too large, or the request has an epsilon or existing tests, which only open-loop strategies can
    /// use.
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

    /// The new tests among the next proposals of the search.
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

    /// A test that the search did not propose, if there is one: the next of the opening, or an untested row.
    fn another(&mut self) -> Option<Point> {
        if self.cube.dims() > 0 || !self.opening.is_over() {
            // Points of a sequence differ, but rows repeat, and the search may have proposed the same test.
            while self.cube.dims() > 0 || !self.opening.is_over() {
                let point = self.cube.valid(self.opening.next());
                if self.insert(&point) {
                    return Some(point);
                }
            }
        }
        if let Some((family, next)) = &mut self.all {
            let tests = &self.tests;
            // From a place that the seed decides: otherwise the first levels would be tested first.
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

    /// Returns `true` if the test is new, and then counts it as asked.
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
                // A second result for the same test is ignored by the search.
                Some(State::Told(_)) => {}
                _ => self.search.learn(None, &trial),
            }
        }
    }
}

fn key(point: &Point) -> Key {
    (point.continuous.iter().map(|u| u.to_bits()).collect(), point.discrete.clone())
}

/// Returns `true` if the costs differ far less than they are away from 0: places near them will then hardly fail.
fn are_alike(costs: impl Iterator<Item = f64>) -> bool {
    let (least, most) = costs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), cost| (a.min(cost), b.max(cost)));
    most - least <= ALIKE * least.abs()
}

/// A uniformly random place.
fn anywhere(axes: &[Axis], rng: &mut impl Rng) -> Vec<f64> {
    axes.iter().map(|_| rng.random()).collect()
}

/// A normally distributed number (Box and Muller 1958).
pub(crate) fn normal(rng: &mut impl Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * libm::log(1.0 - u)).sqrt() * libm::cos(std::f64::consts::TAU * v)
}
