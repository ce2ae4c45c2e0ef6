//! Shrinks failing tests: finds the simplest test near a failing test that still fails, which shows what the failure
//! needs.
//!
//! Parameters return to their nominal values if the test still fails without them, numbers become round and as near
//! to nominal as possible, and signals get fewer pieces. A test counts as failing if it violates every requirement
//! that the first test violated, as reducers of programs keep to one error. The car may then touch another object, or
//! with another side; the result reports this, unless the failure has to [stay](Sameness) in its mode. Shrinking is
//! deterministic, and every result has been run.

mod delta;
mod form;
mod number;
mod search;
#[cfg(test)]
mod tests;

use crate::{Modes, Touch};
use paracosm_campaign::{Campaign, Error, Log, Reason, Study, Supervision, Trial};
use paracosm_engine::Declared;
use paracosm_oracles::Verdict;
use paracosm_space::{Domain, Parameter, Value, Values};
use search::Shrinker;
use serde::Serialize;
use std::num::NonZeroUsize;
use thiserror::Error;

/// A failing test that was made as simple as possible.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shrunk {
    /// The index of the test in its campaign.
    pub index: usize,
    /// The ids of the requirements that both the original test and the shrunk test violate.
    pub violates: Vec<String>,
    /// The descriptions in words of the failures of the original test and of the shrunk test.
    pub failures: [String; 2],
    /// `true` if the original test and the shrunk test fail in the same failure mode. They then violate the same
    /// requirements by the same parts of their formulas, and the car touches the same object with the same side during
    /// the same motion.
    pub same_mode: bool,
    /// The values of each open parameter before and after shrinking.
    pub parameters: Vec<Change>,
    /// The number of tests that were run for shrinking.
    pub runs: usize,
    /// `true` if the search tried every step of shrinking; `false` if the budget of runs did not suffice. If `true`, no
    /// parameter and no two parameters can be set to their nominal values without losing the failure, and no other step
    /// that was tried keeps the failure. A simpler test that takes three steps at once may still fail.
    pub minimal: bool,
    /// The trial of the shrunk test.
    pub trial: Trial,
}

/// The values of an open parameter before and after shrinking.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// The name of the parameter.
    pub name: String,
    /// The unit of the parameter's values.
    pub unit: Option<String>,
    /// The parameter's value in the test of the campaign.
    pub before: Value,
    /// The parameter's value in the shrunk test.
    pub after: Value,
    /// `true` if the value in the shrunk test is the nominal value.
    pub nominal: bool,
}

/// The properties of a failure that shrinking keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sameness {
    /// The violated requirements of the original test. The shrunk test violates at least these requirements.
    Requirements,
    /// The failure mode of the original test. This means the same violated requirements and no others, the same parts
    /// of their formulas, and the same contact (the object, the side of the car, and whether the car drives, brakes or
    /// stands).
    Mode,
}

/// A reason why a test cannot be shrunk.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ShrinkFlaw {
    /// The test to shrink did not fail.
    #[error("test {index} has the verdict `{verdict}`, expected a failing test: there is nothing to shrink")]
    NoFailure {
        /// The index of the test in its campaign.
        index: usize,
        /// The verdict of the test in the log.
        verdict: Verdict,
    },
    /// The test does not fail in the same way when it is run again.
    #[error(
        "test {index} violates {} in the log, but does not fail in the same way when it is run again: the verdict is now `{verdict}`", violates.join(", ")
    )]
    Passes {
        /// The index of the test in its campaign.
        index: usize,
        /// The ids of the requirements that the test violates in the log.
        violates: Vec<String>,
        /// The verdict of the test when it was run again.
        verdict: Verdict,
    },
    /// The simpler test fails only after other tests of the same process.
    #[error(
        "the simpler test found for test {index} fails in a process that ran other tests, and not in a new process: the driver, the system or the \
         perceiver keeps something from test to test, so no shorter test can be trusted"
    )]
    Unsteady {
        /// The index of the test in its campaign.
        index: usize,
    },
}

impl Reason for ShrinkFlaw {}

impl Shrunk {
    /// The number of runs that suffice for most tests.
    pub const BUDGET: usize = 500;

    /// Shrinks a failing trial of a campaign in at most `budget` runs.
    ///
    /// # Errors
    /// The trial did not fail, or does not fail in the same way when it is run again; the simpler test does not fail in a new process; or the study
    /// cannot be run.
    pub fn of(log: &Log, trial: &Trial, same: Sameness, budget: usize) -> Result<Self, Error> {
        Self::until(log, trial, same, budget, &Supervision::default())
    }

    /// Shrinks a failing trial like [`of`](Self::of), until the flag of `supervision` is set.
    ///
    /// # Errors
    /// The same errors as [`of`](Self::of); or [`Error::Interrupted`].
    pub fn until(
        log: &Log,
        trial: &Trial,
        same: Sameness,
        budget: usize,
        supervision: &Supervision,
    ) -> Result<Self, Error> {
        let study = log.study();
        let violates: Vec<String> = trial.violated().map(str::to_owned).collect();
        if !trial.is_failure() || violates.is_empty() {
            return Err(ShrinkFlaw::NoFailure { index: trial.index, verdict: trial.verdict }.into());
        }
        let campaign = || Ok::<_, Error>(Campaign::until(study, supervision.clone())?.jobs(NonZeroUsize::MIN));
        let first = campaign()?;
        let run = |test: &Values| first.run_test(test, trial.index);
        let mode = mode(trial);
        let same_mode = |trial: &Trial| self::mode(trial) == mode;
        let fails = |trial: &Trial| {
            violates.iter().all(|id| trial.violates(id)) && (same == Sameness::Requirements || same_mode(trial))
        };
        let mut last = run(&trial.test)?;
        if !fails(&last) {
            return Err(ShrinkFlaw::Passes { index: trial.index, violates, verdict: last.verdict }.into());
        }
        let nominal = nominal(study);
        let search = Shrinker::new(study.space(), &nominal, &trial.test, budget.saturating_sub(1), |test| {
            let trial = run(test)?;
            let fails = fails(&trial);
            if fails {
                last = trial;
            }
            Ok::<_, Error>(fails)
        });
        let found = search.run()?;
        // The last failing run may be of another test than the result, because bisection looks further.
        if last.test != found.test {
            last = run(&found.test)?;
        }
        if !study.repeats_in_process() {
            let anew = campaign()?.run_test(&found.test, trial.index)?;
            if !fails(&anew) {
                return Err(ShrinkFlaw::Unsteady { index: trial.index }.into());
            }
        }
        let parameters = study.space().parameters().iter().map(|parameter| {
            let value = |values: &Values| values.get(&parameter.name).cloned().expect("a value for every parameter");
            let (before, after, nominal) = (value(&trial.test), value(&found.test), value(&nominal));
            let at_nominal = after.scalars().iter().all(|scalar| nominal.scalars().contains(scalar))
                && parameter.scalars(&nominal).is_ok_and(|scalars| scalars == after.scalars());
            Change { name: parameter.name.clone(), unit: parameter.unit.clone(), before, after, nominal: at_nominal }
        });
        Ok(Self {
            index: trial.index,
            violates: violates.clone(),
            failures: [trial, &last].map(|trial| in_words(log, trial)),
            same_mode: same_mode(&last),
            parameters: parameters.collect(),
            // The first run, of the test itself, counts too.
            runs: found.runs + 1,
            minimal: found.complete,
            trial: last,
        })
    }

    /// Returns a sentence with the parameter values that the failure needs.
    pub fn sentence(&self) -> String {
        let needed: Vec<String> = self.parameters.iter().filter(|change| !change.nominal).map(Change::words).collect();
        let violates = self.violates.join(", ");
        match needed.split_last() {
            None => format!("violates {violates} with everything nominal"),
            Some((last, [])) => format!("violates {violates} already when {last}, everything else nominal"),
            Some((last, others)) => {
                let rest = if needed.len() == self.parameters.len() { "" } else { ", everything else nominal" };
                format!("violates {violates} already when {} and {last}{rest}", others.join(", "))
            }
        }
    }
}

impl Change {
    fn words(&self) -> String {
        let unit = self.unit.as_deref().map(|unit| format!(" {unit}")).unwrap_or_default();
        let values = self.after.scalars();
        match values.iter().all(|value| *value == values[0]) {
            true => format!("{} = {}{unit}", self.name, values[0]),
            false => format!("{} varies as {}{unit}", self.name, self.after),
        }
    }
}

/// Returns the mode in which a trial fails, which is the violated requirements, the violated parts of their formulas,
/// and the contact.
fn mode(trial: &Trial) -> (Vec<(&str, Option<&str>)>, Option<Touch>) {
    let part = |id| (id, trial.violation(id).map(|violation| violation.part.as_str()));
    (trial.violated().map(part).collect(), Touch::of(trial))
}

/// Returns a description in words of the failure of a trial.
fn in_words(log: &Log, trial: &Trial) -> String {
    let modes = Modes::of(&log.with_trials(vec![trial.clone()])).modes;
    modes.into_iter().map(|mode| mode.words).collect()
}

/// Returns the nominal values of the open parameters, which the scenario declares, or the nearest values in the domain.
fn nominal(study: &Study) -> Values {
    let declared = study.program().and_then(|program| Ok(program.declare()?.parameters)).unwrap_or_default();
    let value = |parameter: &Parameter| {
        let declared = declared.iter().find(|other| other.parameter.name == parameter.name).map(Declared::nominal);
        match (&parameter.default, declared, &parameter.domain) {
            (None, Some(Value::Number(number)), Domain::Interval { lo, hi }) => Value::Number(number.clamp(*lo, *hi)),
            (None, Some(value), Domain::Choice(levels)) if levels.contains(&value) => value,
            _ => Declared::open(parameter.clone()).nominal(),
        }
    };
    study.space().parameters().iter().map(|parameter| (parameter.name.clone(), value(parameter))).collect()
}
