//! What all answers of a system have in common, and what is to become of a campaign in which none is to be had of it, or of
//! a driver in a process of its own.
//!
//! Which requirements a system judges itself by is known by its first answer. Trials are checked against it in the order
//! of their indices, so that it does not matter who was answered first.

use crate::study::Specs;
use crate::{Error, Study, Subject, Trial};
use paracosm_engine::Outcome;
use paracosm_oracles::Verdict;

/// After how many tests, all of them in error, a system is given up: it may take its time to fail.
const GIVEN_UP: usize = 50;
/// After how many, where a formula fits none of their traces, all for the same reason, and will fit no other. A signal that they
/// merely lack is no such reason: some tests may have it, and so it takes [`GIVEN_UP`] of them.
const MISFITS: usize = 3;

/// What trials have said so far.
#[derive(Debug, Clone)]
pub struct Expected {
    /// Whether a process of others answers; of all others nothing is expected.
    is_external: bool,
    /// The requirements of the first trial that was answered.
    first: Option<(usize, Vec<String>)>,
    /// How many there were before it, and what was wrong with the first.
    failed: usize,
    why: Option<(usize, String)>,
    /// How many of these had a trace that a formula does not fit, and what the first of them said.
    misfits: usize,
    misfit: Option<(usize, String)>,
    /// Whether they did not all say the same.
    vary: bool,
}

impl Expected {
    /// What is to be expected after these trials of a study.
    pub fn of(study: &Study, trials: &[Trial]) -> Self {
        let is_external = match &study.subject {
            Subject::Scenario(simulation) => simulation.driver.is_external(),
            Subject::System(_) => true,
        };
        let mut expected =
            Self { is_external, first: None, failed: 0, why: None, misfits: 0, misfit: None, vary: false };
        trials.iter().for_each(|trial| expected.learn(trial));
        expected
    }

    /// The trial, or one in error where its requirements are not those that were judged before.
    pub fn check(&mut self, trial: Trial) -> Trial {
        self.learn(&trial);
        let found = requirements(&trial);
        match &self.first {
            Some((first, names)) if trial.covers() && found != *names => {
                let message = format!(
                    "found the robustness of {}, expected that of {} as in test {first}",
                    found.join(", "),
                    names.join(", ")
                );
                Trial::new(trial.index, trial.test, Outcome::broken(Verdict::Error, message), None)
            }
            _ => trial,
        }
    }

    /// Checks that it makes sense to go on.
    ///
    /// # Errors
    /// The system or the driver did none of so many tests.
    pub fn go_on(&self) -> Result<(), Error> {
        let fits_none = self.misfits >= MISFITS && !self.vary;
        let why = self.misfit.as_ref().filter(|_| fits_none).or(self.why.as_ref());
        match (&self.first, why) {
            (None, Some((test, why))) if fits_none || self.failed >= GIVEN_UP => {
                Err(Error::Unanswered { tests: self.failed, test: *test, why: why.clone() })
            }
            _ => Ok(()),
        }
    }

    fn learn(&mut self, trial: &Trial) {
        if self.first.is_some() || !self.is_external {
            return;
        }
        if trial.covers() {
            self.first = Some((trial.index, requirements(trial)));
        } else {
            self.failed += 1;
            let Some(error) = &trial.error else { return };
            let first = |known: Option<(usize, String)>| known.or_else(|| Some((trial.index, error.clone())));
            self.why = first(self.why.take());
            if Specs::is_misfit(error) {
                self.misfits += 1;
                self.misfit = first(self.misfit.take());
                self.vary |= self.misfit.as_ref().is_some_and(|(_, misfit)| misfit != error);
            }
        }
    }
}

/// In alphabetical order: in which they are answered says nothing.
fn requirements(trial: &Trial) -> Vec<String> {
    let mut names: Vec<String> = trial.requirements().map(str::to_owned).collect();
    names.sort_unstable();
    names
}
