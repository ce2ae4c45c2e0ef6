//! The simplest test near a failing one that still fails: what is needed for the failure, and how little of it.
//!
//! Parameters go back to their nominal values where the test still fails without them, numbers become round and as near
//! to nominal as that goes, signals get fewer pieces. A test counts as failing if it violates every requirement that the
//! first one did, as reducers of programs keep to one error; on the way the car may come to touch something else, or with
//! another side, which is said, unless that is to [stay](Sameness) as it was. Shrinking is deterministic, and everything that it says has been run.

mod delta;
mod form;
mod number;
mod search;
#[cfg(test)]
mod tests;

use crate::{Modes, Touch};
use paracosm_campaign::{Campaign, Error, Log, Reason, Study, Trial};
use paracosm_engine::Declared;
use paracosm_oracles::Verdict;
use paracosm_space::{Domain, Parameter, Value, Values};
use search::Shrinker;
use serde::Serialize;
use std::num::NonZeroUsize;
use thiserror::Error;

/// A failing test made as simple as it goes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shrunk {
    /// The index of the test in its campaign.
    pub index: usize,
    /// What it violates, and the shrunk test as well.
    pub violates: Vec<String>,
    /// How the test of the campaign fails, and how the shrunk one does, in words.
    pub failures: [String; 2],
    /// Whether both fail in one mode: they violate the same by the same parts of their formulas, and the car touches the same
    /// with the same side, doing the same.
    pub same_mode: bool,
    /// What became of each open parameter.
    pub parameters: Vec<Change>,
    /// How many tests were run.
    pub runs: usize,
    /// Whether every step was tried: where it is false the runs did not suffice. Where it is true no parameter and no two of
    /// them can be set back to their nominal values without losing the failure, and no other step that was tried keeps it.
    /// A simpler test that takes three steps at once may still fail.
    pub minimal: bool,
    /// The shrunk test with what became of it.
    pub trial: Trial,
}

/// An open parameter before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// Its name.
    pub name: String,
    /// The unit of its values.
    pub unit: Option<String>,
    /// Its value in the test of the campaign.
    pub before: Value,
    /// Its value in the shrunk test.
    pub after: Value,
    /// Whether that is the nominal value.
    pub nominal: bool,
}

/// What of a failure is to stay as it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sameness {
    /// The requirements that are violated.
    Requirements,
    /// Those and no others, by the same parts of their formulas, and what the car touches, with which side, and whether it
    /// drives on, brakes or stands then.
    Mode,
}

/// Why a test cannot be shrunk.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ShrinkFlaw {
    /// It did not fail.
    #[error("test {index} ended `{verdict}`, expected one that failed: there is nothing to shrink")]
    NoFailure {
        /// Its index.
        index: usize,
        /// How it ended.
        verdict: Verdict,
    },
    /// It does not fail any more.
    #[error(
        "test {index} violates {} in the log, but not when it is run again: it ended `{verdict}`", violates.join(", ")
    )]
    Passes {
        /// Its index.
        index: usize,
        /// What it violates in the log.
        violates: Vec<String>,
        /// How it ended now.
        verdict: Verdict,
    },
}

impl Reason for ShrinkFlaw {}

impl Shrunk {
    /// Shrinks a failing trial of a campaign in at most so many runs.
    ///
    /// # Errors
    /// The trial did not fail, or does not when it is run again; or the study cannot be run.
    pub fn of(log: &Log, trial: &Trial, same: Sameness, budget: usize) -> Result<Self, Error> {
        let study = log.study();
        let violates: Vec<String> = trial.violated().map(str::to_owned).collect();
        if !trial.is_failure() || violates.is_empty() {
            return Err(ShrinkFlaw::NoFailure { index: trial.index, verdict: trial.verdict }.into());
        }
        let campaign = Campaign::new(study)?.jobs(NonZeroUsize::MIN);
        let run = |test: &Values| {
            let mut ran = None;
            campaign.run_tests(std::slice::from_ref(test), trial.index, |trial| {
                ran = Some(trial.clone());
                Ok(())
            })?;
            Ok::<_, Error>(ran.expect("a test that is run is shown"))
        };
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
        // The last failing run need not be of the test that was found: bisection looks further.
        if last.test != found.test {
            last = run(&found.test)?;
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
            // The test itself was run as well.
            runs: found.runs + 1,
            minimal: found.complete,
            trial: last,
        })
    }

    /// What is needed for the failure, in a sentence.
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

/// In which way a trial fails: what it violates, by which parts, and what the car touches.
fn mode(trial: &Trial) -> (Vec<(&str, Option<&str>)>, Option<Touch>) {
    let part = |id| (id, trial.violation(id).map(|violation| violation.part.as_str()));
    (trial.violated().map(part).collect(), Touch::of(trial))
}

/// How a failing trial fails.
fn in_words(log: &Log, trial: &Trial) -> String {
    let modes = Modes::of(&log.with_trials(vec![trial.clone()])).modes;
    modes.into_iter().map(|mode| mode.words).collect()
}

/// The nominal values of the open parameters: those that the scenario declares, or what of the domain comes nearest to
/// them.
fn nominal(study: &Study) -> Values {
    let declared = study.program().and_then(|program| Ok(program.declare()?.parameters)).unwrap_or_default();
    let value = |parameter: &Parameter| {
        let declared = declared.iter().find(|other| other.parameter.name == parameter.name).map(Declared::nominal);
        match (&parameter.default, declared, &parameter.domain) {
            (None, Some(Value::Number(number)), Domain::Interval { lo, hi }) => Value::Number(number.clamp(*lo, *hi)),
            (None, Some(value), Domain::Choice(levels)) if levels.contains(&value) => value,
            _ => Declared { parameter: parameter.clone(), open: true }.nominal(),
        }
    };
    study.space().parameters().iter().map(|parameter| (parameter.name.clone(), value(parameter))).collect()
}
