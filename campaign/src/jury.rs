//! The reference drivers of a study: a violation that none of them avoids is unpreventable.

use crate::judge::judge;
use crate::simulator::Simulator;
use crate::{Error, Problem, ProblemKind, Study, Supervision, Trial};
use paracosm_engine::{Outcome, Test};
use paracosm_oracles::{Trace, Verdict};
use paracosm_space::Values;

/// The simulators that run the failing tests of a worker with the reference drivers.
pub struct Jury<'a>(Vec<(&'a Study, Simulator<'a>)>);

impl<'a> Jury<'a> {
    /// Makes the simulators for the reference drivers of a study. They stop with the campaign.
    pub fn of(study: &'a Study, supervision: &Supervision) -> Result<Self, Error> {
        let simulator = |reference: &'a Study| {
            reference.check_trust()?;
            Ok((reference, Simulator::new(reference.subject().scenario()?, supervision.clone(), None)?))
        };
        study.references().iter().map(simulator).collect::<Result<_, Error>>().map(Self)
    }

    /// Returns the trial of a test that was simulated or broke, judged by the formulas of the study and by the reference
    /// drivers as well.
    pub fn judged(
        &mut self,
        study: &Study,
        index: usize,
        test: &Values,
        outcome: Result<Outcome, Problem>,
    ) -> (Trial, Option<Trace>) {
        let (mut trial, trace) = simulated(study, index, test, outcome);
        if trial.is_failure() && !self.0.is_empty() {
            match self.may_prevent(&trial) {
                Ok(true) => (),
                Ok(false) => trial.verdict = Verdict::Unpreventable,
                Err(interrupted) => return (Trial::broken(index, test.clone(), interrupted), None),
            }
        }
        (trial, trace)
    }

    /// Returns `true` if a reference driver avoids a violation, or if its run leaves that open. If the
    /// campaign was stopped meanwhile, the trial has no verdict yet: the error says so.
    fn may_prevent(&mut self, failing: &Trial) -> Result<bool, Problem> {
        for (study, simulator) in &mut self.0 {
            let outcome = simulator.run(failing.index, Test::new(&study.complete(&failing.test), study.space()));
            let trial = simulated(study, failing.index, &failing.test, outcome).0;
            match trial.problem {
                Some(problem) if problem.kind == ProblemKind::Interrupted => return Err(problem),
                // A violation that the reference driver causes elsewhere does not count.
                _ if failing.violated().any(|id| !trial.violates(id)) => return Ok(true),
                _ => (),
            }
        }
        Ok(false)
    }
}

fn simulated(study: &Study, index: usize, test: &Values, outcome: Result<Outcome, Problem>) -> (Trial, Option<Trace>) {
    match outcome {
        Err(problem) => (Trial::broken(index, test.clone(), problem), None),
        Ok(outcome) => {
            let (mut trial, trace) = Trial::simulated(index, test.clone(), outcome);
            trace.iter().for_each(|trace| judge(&mut trial, study.given(), trace));
            (trial, trace)
        }
    }
}
