//! Mutants on trial: which of them a suite notices.
//!
//! A suite *kills* a mutant if the mutant violates a requirement in a test of the suite that the driver of the study keeps in the same
//! test. The mutation score of a suite is the share of mutants that it kills.
//!
//! Mutants with the same defect stand next to each other and are tried together. Whether a test notices an active mutant depends on the
//! defect alone, so no test runs twice with the same defect.

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
    /// The mutants. Mutants with the same defect stand next to each other.
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
        let given = runs.given(study, &tests)?;
        let mut order: Vec<usize> = (0..tests.len()).filter(|index| given[*index].covers()).collect();
        order.sort_by(|a, b| margin(&given[*a]).total_cmp(&margin(&given[*b])));
        Ok(Self { tests, given, order })
    }

    /// Iterates over the tests that notice a defect that is always on. `worker` has the driver with the defect.
    pub fn noticing(&self, worker: &mut Worker) -> impl Iterator<Item = Kill> {
        self.order.iter().filter_map(|&test| self.noticed(test, worker))
    }

    /// Returns the first kill of each mutant; `None` if no test notices the mutant. All mutants have the defect of the driver of
    /// `worker`, so one run of a test serves all mutants that are active in it.
    fn kills(&self, mutants: &[&Mutant], worker: &mut Worker) -> Vec<Option<Kill>> {
        let mut kills = vec![None; mutants.len()];
        let mut alive: Vec<usize> = (0..mutants.len()).collect();
        for &test in &self.order {
            let is_active = |mutant: &usize| mutants[*mutant].is_active(&self.tests[test]);
            let active: Vec<usize> = alive.iter().copied().filter(is_active).collect();
            if active.is_empty() {
                continue;
            }
            let Some(kill) = self.noticed(test, worker) else { continue };
            active.iter().for_each(|mutant| kills[*mutant] = Some(kill.clone()));
            alive.retain(|mutant| !active.contains(mutant));
            if alive.is_empty() {
                break;
            }
        }
        kills
    }

    fn noticed(&self, test: usize, worker: &mut Worker) -> Option<Kill> {
        let trial = worker.run(test, &self.tests[test]).0;
        let requirement = gives_away(&self.given[test], &trial)?.to_owned();
        Some(Kill { test, requirement })
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
        let groups: Vec<&[Noticed]> =
            self.mutants[tried..].chunk_by(|a, b| a.mutant.defect == b.mutant.defect).collect();
        let try_group = |(): &mut (), index: usize| self.tried(groups[index], &known, &seats);
        self.runs.each_into(0..groups.len(), || (), try_group, |group| group?.into_iter().try_for_each(&mut sink))
    }

    /// Tries mutants that have the same defect.
    fn tried(&self, group: &[Noticed], known: &[Known], seats: &Seats) -> Result<Vec<Tried>, Error> {
        let study = mutated(self.study, group[0].mutant.defect)?;
        let mut worker = seats.worker(&study);
        let mutants: Vec<&Mutant> = group.iter().map(|noticed| &noticed.mutant).collect();
        let kills: Vec<Vec<Option<Kill>>> = known.iter().map(|suite| suite.kills(&mutants, &mut worker)).collect();
        let one = |(at, noticed): (usize, &Noticed)| Tried {
            mutant: noticed.mutant.clone(),
            kills: kills.iter().map(|suite| suite[at].clone()).collect(),
            noticed: noticed.test.clone(),
        };
        Ok(group.iter().enumerate().map(one).collect())
    }
}
