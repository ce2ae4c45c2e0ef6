//! Checks that all answers of a system judge the same requirements, and gives up a campaign whose system, or whose
//! driver in a process of its own, does not answer.
//!
//! The first answer of a system says by which requirements it judges itself. Trials are checked against it in the order
//! of their indices, so that the order of the answers does not matter.

use crate::{Failure, Problem, ProblemKind, Study, Subject, Trial};

/// The number of tests, all of them in error, after which a system is given up, because failing may take long.
const GIVEN_UP: usize = 50;
/// The number of tests after which a system is given up if one formula fits none of their traces, and so will fit no
/// other. A signal that is merely missing does not count: other tests may have it, so that it takes [`GIVEN_UP`] tests.
const MISFITS: usize = 3;

/// A check of the trials of a campaign, which finds changed requirements and systems that do not answer.
#[derive(Debug, Clone)]
pub struct Expected {
    /// True if an external process answers; other studies are not checked.
    is_external: bool,
    /// The index of the first trial that was answered, and its requirements.
    first: Option<(usize, Vec<String>)>,
    /// The number of trials in error before the first answer, and the first of these trials that states a reason.
    failed: usize,
    why: Option<(usize, Problem)>,
    /// The number of trials in error whose trace does not fit a formula, and the first of these trials.
    misfits: usize,
    misfit: Option<(usize, Problem)>,
    /// True if these trials differ in the formula that does not fit, or in the sample period.
    vary: bool,
}

impl Expected {
    /// Makes the check for the trials of a study that follow the given trials.
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

    /// Returns the given trial, or a trial with the verdict `error` if the requirements differ from the first answer's
    /// requirements.
    pub fn check(&mut self, trial: Trial) -> Trial {
        self.learn(&trial);
        let found = requirements(&trial);
        match &self.first {
            Some((first, names)) if trial.covers() && found != *names => {
                let message = format!(
                    "found the robustness of {}, expected the robustness of {}, as in test {first}",
                    found.join(", "),
                    names.join(", ")
                );
                Trial::broken(trial.index, trial.test, Problem::new(ProblemKind::Requirements, message))
            }
            _ => trial,
        }
    }

    /// Returns an error if the system or the driver gave no result for any of the first tests.
    ///
    /// # Errors
    /// The system or the driver gave no result for any of the first tests.
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

/// Returns the ids of the requirements in alphabetical order, because the order of the answer has no meaning.
fn requirements(trial: &Trial) -> Vec<String> {
    let mut names: Vec<String> = trial.requirements().map(str::to_owned).collect();
    names.sort_unstable();
    names
}
