//! What all answers of a system have in common, and what becomes of a campaign to which a system, or a driver in a process of its
//! own, gives no answer.
//!
//! Which requirements a system judges itself by is known by its first answer. Trials are checked against it in the order
//! of their indices, so that it does not matter who was answered first.

use crate::{Failure, Problem, ProblemKind, Study, Subject, Trial};

/// After how many tests, all of them in error, a system is given up: it may take its time to fail.
const GIVEN_UP: usize = 50;
/// After how many, where one formula fits none of their traces and will fit no other. A signal that they merely lack is no such
/// reason: some tests may have it, and so it takes [`GIVEN_UP`] of them.
const MISFITS: usize = 3;

/// What trials have said so far.
#[derive(Debug, Clone)]
pub struct Expected {
    /// Whether a process of others answers; of all others nothing is expected.
    is_external: bool,
    /// The first trial that was answered, and its requirements.
    first: Option<(usize, Vec<String>)>,
    /// How many trials in error came before it, and the first that says why.
    failed: usize,
    why: Option<(usize, Problem)>,
    /// How many of them have a trace that a formula does not fit, and the first.
    misfits: usize,
    misfit: Option<(usize, Problem)>,
    /// Whether they are the fault of several formulas.
    vary: bool,
}

impl Expected {
    /// What is to be expected after these trials of a study.
    pub fn of(study: &Study, trials: &[Trial]) -> Self {
        let is_external = match study.subject() {
            Subject::Scenario(simulation) => simulation.driver().is_external(),
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
                Trial::broken(trial.index, trial.test, Problem::new(ProblemKind::Requirements, message))
            }
            _ => trial,
        }
    }

    /// Checks that it makes sense to go on.
    ///
    /// # Errors
    /// The system or the driver did none of so many tests.
    pub fn go_on(&self) -> Result<(), Failure> {
        let fits_none = self.misfits >= MISFITS && !self.vary;
        let why = self.misfit.as_ref().filter(|_| fits_none).or(self.why.as_ref());
        match (&self.first, why) {
            (None, Some((test, problem))) if fits_none || self.failed >= GIVEN_UP => {
                Err(Failure::Unanswered { tests: self.failed, test: *test, problem: problem.clone() })
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
            return;
        }
        self.failed += 1;
        let Some(problem) = &trial.problem else { return };
        let found = || (trial.index, problem.clone());
        self.why.get_or_insert_with(found);
        if let ProblemKind::Misfit { .. } = &problem.kind {
            self.misfits += 1;
            let (_, first) = self.misfit.get_or_insert_with(found);
            self.vary |= first.kind != problem.kind;
        }
    }
}

/// The ids in alphabetical order: in which order they are answered says nothing.
fn requirements(trial: &Trial) -> Vec<String> {
    let mut names: Vec<String> = trial.requirements().map(str::to_owned).collect();
    names.sort_unstable();
    names
}
