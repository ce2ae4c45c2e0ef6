//! Traces requirements to tests: counts the tests of a campaign that satisfied or violated each requirement, and
//! lists what no test has tried.
//!
//! A requirement *passed* in a test if it holds and the test came to the situation that the requirement is about. If
//! the test did not come to this situation, the requirement was *not reached*, though nothing violated it. The
//! requirement is *undecided* if the test ended too early. Tests that broke or could not be built judge nothing. What
//! is untested here is untested by these tests only: nothing is said about the space between two tests.

#[cfg(test)]
mod tests;
mod tried;

pub use tried::Tried;

use crate::effects::Effects;
use paracosm_campaign::study::Odd;
use paracosm_campaign::{Error, Log, Number, StatedRequirement, Study, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::Values;
use serde::Serialize;
use std::fmt;

/// The results of a campaign for each requirement, with a list of untested requirements and values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Traceability {
    /// The number of all tests of the campaign.
    pub tests: usize,
    /// The indices of the tests, in the order of the log.
    pub indices: Vec<usize>,
    /// The number of tests that broke or could not be built.
    pub broken: usize,
    /// The requirements in the order of the study, each with its results, then the requirements that only the system
    /// knows.
    pub requirements: Vec<Traced>,
    /// The values of each open parameter that no test has tried.
    pub parameters: Vec<Tried>,
    /// The parameters that have the same value in all tests, with this value.
    pub fixed: Values,
    /// The part of the operational design domain that the tests are about, if the study states it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub odd: Option<Odd>,
    /// The list of untested requirements, parameters and attributes of the design domain, with reasons.
    pub untested: Vec<Gap>,
}

/// The result of a requirement in a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Became {
    /// The requirement holds, and the test came to the situation that the requirement is about.
    Passed,
    /// The requirement is violated.
    Failed,
    /// The requirement is undecided, because the test ended too early.
    Undecided,
    /// The requirement holds, but the test never came to the situation that the requirement is about.
    NotReached,
    /// The requirement was not judged, because the test broke, could not be built, or gave no result for the
    /// requirement.
    NotJudged,
}

impl fmt::Display for Became {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Passed => "passed",
            Self::Failed => "failed",
            Self::Undecided => "undecided",
            Self::NotReached => "not reached",
            Self::NotJudged => "not judged",
        })
    }
}

/// A requirement with its results in the tests of a campaign.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Traced {
    /// The short name that identifies the requirement.
    pub id: String,
    /// The text of the requirement as one sentence; empty if only the system knows the requirement.
    pub text: String,
    /// The source of the requirement, for example a regulation or a hazard; `None` if the source is not stated.
    pub source: Option<String>,
    /// The severity of a violation of the requirement; `None` if the severity is not stated.
    pub severity: Option<String>,
    /// The formula of the requirement; empty if the formula is not known.
    pub formula: String,
    /// The unit of the requirement's robustness.
    pub unit: String,
    /// The number of tests in which the requirement passed.
    pub passed: usize,
    /// The number of tests in which the requirement is violated.
    pub failed: usize,
    /// The number of tests in which the requirement is undecided.
    pub undecided: usize,
    /// The number of tests in which the requirement holds, but its situation never occurred.
    pub not_reached: usize,
    worst: Option<Least>,
    /// The indices of the tests that violate the requirement.
    pub violated_in: Vec<usize>,
    /// The result of the requirement in each test, in the order of the tests.
    pub by_test: Vec<Became>,
}

/// The least robustness, with the index of the first test that has it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct Least {
    index: usize,
    robustness: Number,
}

/// An untested requirement, parameter or attribute of the design domain, with the reason.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Gap {
    /// The name of the untested requirement, parameter or attribute of the design domain.
    pub what: String,
    /// The reason why the requirement, parameter or attribute counts as untested.
    pub why: String,
}

impl Traced {
    /// Returns the least robustness, in the requirement's unit, with the index of the first test that has it.
    pub fn worst(&self) -> Option<(f64, usize)> {
        self.worst.and_then(|Least { index, robustness }| Some((robustness.0?, index)))
    }

    /// Makes a requirement that none of `tests` tests has judged yet.
    fn new(study: &Study, id: &str, tests: usize) -> Self {
        let stated = study.requirement(id);
        let text = |text: fn(&StatedRequirement) -> &str| stated.map_or(String::new(), |r| text(r).to_owned());
        let formula = stated.and_then(|requirement| requirement.formula.as_ref());
        Self {
            id: id.to_owned(),
            text: text(|requirement| &requirement.text),
            source: stated.and_then(|requirement| requirement.source.clone()),
            severity: stated.and_then(|requirement| requirement.severity.clone()),
            formula: formula.map(ToString::to_string).unwrap_or_default(),
            unit: text(|requirement| &requirement.unit),
            passed: 0,
            failed: 0,
            undecided: 0,
            not_reached: 0,
            worst: None,
            violated_in: Vec::new(),
            by_test: vec![Became::NotJudged; tests],
        }
    }

    /// Adds the result of the test at this position.
    fn add(&mut self, position: usize, trial: &Trial, reached: bool) {
        let worth = trial.robustness(&self.id);
        let (became, count) = match worth {
            None => (Became::Undecided, &mut self.undecided),
            Some(_) if trial.violates(&self.id) => (Became::Failed, &mut self.failed),
            Some(_) if reached => (Became::Passed, &mut self.passed),
            Some(_) => (Became::NotReached, &mut self.not_reached),
        };
        *count += 1;
        self.by_test[position] = became;
        if became == Became::Failed {
            self.violated_in.push(trial.index);
        }
        let Some(worth) = worth else { return };
        if self.worst().is_none_or(|(worst, _)| worth < worst) {
            self.worst = Some(Least { index: trial.index, robustness: Number(Some(worth)) });
        }
    }

    /// Returns the reason why the requirement is untested, if it is.
    fn gap(&self) -> Option<String> {
        let judged = self.passed + self.failed;
        if judged > 0 {
            return None;
        }
        Some(match (self.undecided, self.not_reached) {
            (0, 0) if self.formula.is_empty() => "the requirement has no formula, and nothing judged it".to_owned(),
            (0, 0) => "no test judged the requirement".to_owned(),
            (0, _) => "no test came to the situation that the requirement is about".to_owned(),
            (_, 0) => "the requirement was undecided in every test".to_owned(),
            (..) => {
                "in every test the requirement was undecided, or the test never came to the situation that it is about"
                    .to_owned()
            }
        })
    }
}

/// Checks for each trial whether it came to the situation that the tests are about. A scenario without such a premise
/// never reports that it did, but then no decided trial is inconclusive either.
fn reached(trials: &[&Trial]) -> Vec<bool> {
    let triggered = |trial: &Trial| trial.triggered() == Some(true);
    let decided = |trial: &Trial| trial.requirements().all(|id| trial.robustness(id).is_some());
    let waits = |trial: &&Trial| trial.verdict == Verdict::Inconclusive && !triggered(trial);
    let has_premise = trials.iter().any(|trial| triggered(trial) || waits(trial) && decided(trial));
    trials.iter().map(|trial| !(has_premise && waits(trial))).collect()
}

impl Traceability {
    /// Traces the requirements of a campaign to its trials.
    ///
    /// # Errors
    /// A trial does not fit into the study's space.
    pub fn of(log: &Log) -> Result<Self, Error> {
        let (study, trials) = (log.study(), log.trials());
        let (positions, judging): (Vec<usize>, Vec<&Trial>) =
            trials.iter().enumerate().filter(|(_, trial)| trial.covers()).unzip();
        let new = |id: &str| Traced::new(study, id, trials.len());
        let mut requirements: Vec<Traced> =
            study.requirements().iter().map(|requirement| new(&requirement.id)).collect();
        for ((at, trial), reached) in positions.into_iter().zip(&judging).zip(reached(&judging)) {
            for id in trial.requirements() {
                let position = requirements.iter().position(|traced| traced.id == id).unwrap_or_else(|| {
                    requirements.push(new(id));
                    requirements.len() - 1
                });
                requirements[position].add(at, trial, reached);
            }
        }
        let parameters = Tried::of(study, &judging)?;
        let of_requirements = requirements.iter().filter_map(|traced| gap(&traced.id, traced.gap()?));
        let of_parameters = parameters.iter().flat_map(Tried::untried);
        let of_fixed = study
            .fixed()
            .iter()
            .filter_map(|(name, value)| gap(name, format!("the same in all tests: {}", tried::words(value))));
        let excluded = study.odd().into_iter().flat_map(Odd::iter);
        let excluded = excluded.filter_map(|(name, attribute)| {
            gap(name, format!("excluded from the design domain: {}", attribute.excluded.as_ref()?))
        });
        let untested = of_requirements.chain(of_parameters).chain(of_fixed).chain(excluded).collect();
        Ok(Self {
            tests: trials.len(),
            indices: trials.iter().map(|trial| trial.index).collect(),
            broken: trials.len() - judging.len(),
            parameters,
            fixed: study.fixed().clone(),
            odd: study.odd().cloned(),
            untested,
            requirements,
        })
    }
}

impl Traceability {
    /// Adds the parameters without effect to what is untested.
    pub fn with_effects(mut self, effects: &Effects) -> Self {
        let gaps = effects.without_effect().filter_map(|(name, why)| gap(name, format!("no effect: {why}")));
        self.untested.extend(gaps);
        self
    }
}

fn gap(what: &str, why: String) -> Option<Gap> {
    Some(Gap { what: what.to_owned(), why })
}
