//! Mutants on trial: which of them a suite notices.
//!
//! A suite *kills* a mutant if the mutant violates a requirement in a test of the suite that the driver of the study keeps in the same
//! test. A mutant *counts* if some suite kills it, or if a search finds such a test. All other mutants are equivalent to the driver as
//! far as known. The mutation score of a suite is the share of counted mutants that it kills.

use super::Suite;
use super::runs::{Runs, Seats, gives_away, mutated};
use crate::statistics::random::SplitMix64;
use paracosm_campaign::{Error, Study, Trial, Worker};
use paracosm_generators::{Request, Strategy};
use paracosm_mutants::{Condition, Mutant};
use paracosm_space::{Domain, Point, Space, Values};
use serde::{Deserialize, Serialize};

/// The number of points that are drawn for each test of a search: others break a constraint.
const DRAWN: usize = 8;

/// A mutant with what the suites noticed of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tried {
    /// The mutant.
    pub mutant: Mutant,
    /// The kill by each suite, in the order of the suites; `None` if the suite does not notice the mutant.
    pub kills: Vec<Option<Kill>>,
    /// The number of tests of the search, which ran if no suite noticed the mutant.
    #[serde(skip_serializing_if = "is_zero", default)]
    pub searched: usize,
    /// The test that the search found; `None` if a suite noticed the mutant or the search found nothing.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub found: Option<Found>,
}

/// The first test of a suite that notices a mutant. The tests run from the test with the least robustness of the study's driver on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Kill {
    /// The position of the test in the suite, from 0.
    pub test: usize,
    /// The requirement that the mutant violates.
    pub requirement: String,
}

/// A test outside of the suites that notices a mutant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// The values of the test.
    pub test: Values,
    /// The requirement that the mutant violates.
    pub requirement: String,
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl Tried {
    /// Returns `true` if some test notices the mutant, so that it counts.
    pub fn counts(&self) -> bool {
        self.found.is_some() || self.kills.iter().any(Option::is_some)
    }
}

/// The suites and the mutants of an audit.
pub(super) struct Bout<'a> {
    pub study: &'a Study,
    pub suites: &'a [Suite],
    pub mutants: &'a [Mutant],
    /// The greatest number of tests of the search for each mutant.
    pub search: usize,
    pub runs: &'a Runs,
}

/// A suite with the trials of the study's driver.
pub(super) struct Known {
    tests: Vec<Values>,
    given: Vec<Trial>,
    /// The positions of the tests, from the least robustness on.
    order: Vec<usize>,
}

impl Known {
    pub fn of(suite: &Suite, study: &Study, runs: &Runs) -> Result<Self, Error> {
        let tests = suite.values(study);
        let given = runs.of(study, &tests)?;
        let mut order: Vec<usize> = (0..tests.len()).filter(|index| given[*index].covers()).collect();
        order.sort_by(|a, b| margin(&given[*a]).total_cmp(&margin(&given[*b])));
        Ok(Self { tests, given, order })
    }

    /// Returns the first test that notices a mutant.
    pub fn kill(&self, mutant: &Mutant, worker: &mut Worker) -> Option<Kill> {
        self.order.iter().copied().filter(|test| mutant.is_active(&self.tests[*test])).find_map(|test| {
            let trial = worker.run(test, &self.tests[test]).0;
            let requirement = gives_away(&self.given[test], &trial)?.to_owned();
            Some(Kill { test, requirement })
        })
    }
}

/// Returns the least robustness of a trial.
fn margin(trial: &Trial) -> f64 {
    trial.decided().map(|(_, robustness)| robustness).fold(f64::INFINITY, f64::min)
}

impl Bout<'_> {
    /// Tries all mutants but those that have been tried before, in order. `sink` gets each as soon as those before it are done.
    ///
    /// # Errors
    /// The audit was stopped, a driver cannot be made, or `sink` fails.
    pub fn run(&self, tried: usize, mut sink: impl FnMut(Tried) -> Result<(), Error>) -> Result<(), Error> {
        if tried >= self.mutants.len() {
            return Ok(());
        }
        let known = self.suites.iter().map(|suite| Known::of(suite, self.study, self.runs));
        let known = known.collect::<Result<Vec<_>, Error>>()?;
        let seats = Seats::of(self.study)?;
        let try_one = |given: &mut Worker, index: usize| Some(self.tried(&self.mutants[index], &known, &seats, given));
        self.runs.each_into(tried..self.mutants.len(), || seats.worker(self.study), try_one, |one| sink(one?))
    }

    fn tried(&self, mutant: &Mutant, known: &[Known], seats: &Seats, given: &mut Worker) -> Result<Tried, Error> {
        let study = mutated(self.study, mutant.defect)?;
        let mut worker = seats.worker(&study);
        let kills: Vec<_> = known.iter().map(|suite| suite.kill(mutant, &mut worker)).collect();
        let mut tried = Tried { mutant: mutant.clone(), kills, searched: 0, found: None };
        if tried.counts() {
            return Ok(tried);
        }
        for test in region(self.study.space(), mutant, self.search)? {
            let trial = worker.run(tried.searched, &test).0;
            tried.searched += 1;
            if trial.violated().next().is_none() {
                continue;
            }
            let given = given.run(0, &test).0;
            if let Some(requirement) = gives_away(&given, &trial) {
                tried.found = Some(Found { test, requirement: requirement.to_owned() });
                break;
            }
        }
        Ok(tried)
    }
}

/// Returns valid tests for which a mutant is on: Halton points over the continuous parameters, and random levels.
fn region(space: &Space, mutant: &Mutant, most: usize) -> Result<Vec<Values>, Error> {
    let on = |name: &str| mutant.when.iter().find(|condition| condition.parameter() == name);
    let axes: Vec<_> = space.continuous().collect();
    let drawn = most.saturating_mul(DRAWN);
    let places: Vec<Vec<f64>> = match axes.len() {
        0 => vec![Vec::new(); drawn],
        dims => {
            let cube = Space::unit_cube(dims);
            let points = Strategy::HALTON.build(&Request::new(&cube, drawn.max(1)))?.ask(drawn);
            points.into_iter().map(|point| point.continuous).collect()
        }
    };
    let mut random = SplitMix64(0);
    let mut tests = Vec::new();
    for place in places {
        let discrete = space.discrete().map(|choice| {
            let levels = choice.parameter.levels().expect("it is discrete");
            match on(&choice.parameter.name) {
                Some(Condition::Is { value, .. }) => levels.iter().position(|level| level == value).unwrap_or(0),
                _ => ((random.unit() * levels.len() as f64) as usize).min(levels.len() - 1),
            }
        });
        let discrete = discrete.collect();
        let continuous = axes.iter().zip(&place).map(|(axis, u)| match on(&axis.parameter.name) {
            Some(Condition::Within { lo, hi, .. } | Condition::Between { lo, hi, .. }) => {
                let [low, high] = [*lo, *hi].map(|value| coordinate(&axis.parameter.domain, value));
                low + u * (high - low)
            }
            _ => *u,
        });
        let point = Point { continuous: continuous.collect(), discrete };
        if space.allows(&point) {
            let test = space.decode(&point);
            if mutant.is_active(&test) {
                tests.push(test);
            }
        }
        if tests.len() == most {
            break;
        }
    }
    Ok(tests)
}

/// Returns the coordinate of a value of an interval.
fn coordinate(domain: &Domain, value: f64) -> f64 {
    match domain {
        Domain::Interval { lo, hi } => ((value - lo) / (hi - lo)).clamp(0.0, 1.0),
        Domain::Choice(_) => value,
    }
}
