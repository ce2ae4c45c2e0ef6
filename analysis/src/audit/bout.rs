//! Mutants on trial: which of them a suite notices.
//!
//! A suite *kills* a mutant if the mutant violates a requirement in a test of the suite that the driver of the study keeps in the same
//! test. The mutation score of a suite is the share of mutants that it kills.

use super::Suite;
use super::runs::{Runs, Seats, gives_away, mutated};
use paracosm_campaign::{Error, Study, Trial, Worker};
use paracosm_mutants::Mutant;
use paracosm_space::Values;
use serde::{Deserialize, Serialize};

/// A mutant with what the suites noticed of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tried {
    /// The mutant.
    pub mutant: Mutant,
    /// The kill by each suite, in the order of the suites; `None` if the suite does not notice the mutant.
    pub kills: Vec<Option<Kill>>,
    /// The test of the screen that notices the mutant.
    pub noticed: Found,
}

/// The first test of a suite that notices a mutant. The tests run from the test with the least robustness of the study's driver on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Kill {
    /// The position of the test in the suite, from 0.
    pub test: usize,
    /// The requirement that the mutant violates.
    pub requirement: String,
}

/// A test that notices a mutant, and that may be in no suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// The values of the test.
    pub test: Values,
    /// The requirement that the mutant violates.
    pub requirement: String,
}

/// A mutant that is to be tried, with a test that notices it.
#[derive(Debug, Clone, PartialEq)]
pub struct Noticed {
    /// The mutant.
    pub mutant: Mutant,
    /// The first test of the screen that notices it.
    pub test: Found,
    /// All tests of the screen that notice it, by their positions.
    pub tests: Vec<usize>,
}

/// The suites and the mutants of an audit.
pub(super) struct Bout<'a> {
    pub study: &'a Study,
    pub suites: &'a [Suite],
    pub mutants: &'a [Noticed],
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

    /// Iterates over the tests that notice a mutant. `worker` has the driver with its defect.
    pub fn kills(&self, mutant: &Mutant, worker: &mut Worker) -> impl Iterator<Item = Kill> {
        let active = self.order.iter().copied().filter(|test| mutant.is_active(&self.tests[*test]));
        active.filter_map(|test| {
            let trial = worker.run(test, &self.tests[test]).0;
            let requirement = gives_away(&self.given[test], &trial)?.to_owned();
            Some(Kill { test, requirement })
        })
    }

    /// Returns the values of a test of the suite.
    pub fn test(&self, index: usize) -> &Values {
        &self.tests[index]
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
        let try_one = |(): &mut (), index: usize| self.tried(&self.mutants[index], &known, &seats);
        self.runs.each_into(tried..self.mutants.len(), || (), try_one, |one| sink(one?))
    }

    fn tried(&self, noticed: &Noticed, known: &[Known], seats: &Seats) -> Result<Tried, Error> {
        let Noticed { mutant, test, .. } = noticed;
        let study = mutated(self.study, mutant.defect)?;
        let mut worker = seats.worker(&study);
        let kills = known.iter().map(|suite| suite.kills(mutant, &mut worker).next()).collect();
        Ok(Tried { mutant: mutant.clone(), kills, noticed: test.clone() })
    }
}
