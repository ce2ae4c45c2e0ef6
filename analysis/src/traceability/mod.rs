//! Requirement by test: how many tests of a campaign kept each requirement and how many violated it, and what no test
//! has tried.
//!
//! A requirement *passed* in a test if it holds there and the test came to the situation that it is about; where it did not,
//! the requirement was *not reached*, though nothing violated it. It is *undecided* where the test ended too early. Tests
//! that broke or could not be built judge nothing. What is untested here is untested by these tests: nothing is said of
//! what lies between two of them.

#[cfg(test)]
mod tests;
mod tried;

pub use tried::Tried;

use paracosm_campaign::study::Odd;
use paracosm_campaign::{Error, Log, Number, StatedRequirement, Study, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::Values;
use serde::Serialize;
use std::fmt;

/// What the tests of a campaign say of its requirements, and what they leave untested.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Traceability {
    /// How many tests there are.
    pub tests: usize,
    /// Their indices, in order.
    pub indices: Vec<usize>,
    /// How many of them broke or could not be built.
    pub broken: usize,
    /// The requirements in the order in which they are stated, then those that only the system knows.
    pub requirements: Vec<Traced>,
    /// What was tried of each open parameter.
    pub parameters: Vec<Tried>,
    /// The parameters that are the same in all tests.
    pub fixed: Values,
    /// What of the operational design domain the tests are about, if anybody has said so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub odd: Option<Odd>,
    /// What is untested.
    pub untested: Vec<Gap>,
}

/// What became of a requirement in a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Became {
    /// It holds, and the test came to the situation that it is about.
    Passed,
    /// It is violated.
    Failed,
    /// The test ended too early.
    Undecided,
    /// It holds, but the test never came to the situation that it is about.
    NotReached,
    /// The test broke, could not be built, or said nothing of it.
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

/// A requirement with what became of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Traced {
    /// Its short name.
    pub id: String,
    /// One sentence; empty where only the system knows.
    pub text: String,
    /// Where it comes from.
    pub source: Option<String>,
    /// How severe a violation is.
    pub severity: Option<String>,
    /// What is asked; empty where that is not known here.
    pub formula: String,
    /// The unit of its robustness.
    pub unit: String,
    /// In how many tests it holds.
    pub passed: usize,
    /// In how many tests it is violated.
    pub failed: usize,
    /// In how many tests it was left undecided.
    pub undecided: usize,
    /// How many tests that kept it never came to the situation that they are about.
    pub not_reached: usize,
    worst: Option<Least>,
    /// The indices of the tests that violate it.
    pub violated_in: Vec<usize>,
    /// What became of it in each test, in the order of the tests.
    pub by_test: Vec<Became>,
}

/// The least robustness with the index of the first test that has it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct Least {
    index: usize,
    robustness: Number,
}

/// Something that is untested, and in what sense.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Gap {
    /// A requirement, a parameter, or an attribute of the design domain.
    pub what: String,
    /// Why it counts as untested.
    pub why: String,
}

impl Traced {
    /// The least robustness, in its unit, with the index of the first test that has it.
    pub fn worst(&self) -> Option<(f64, usize)> {
        self.worst.and_then(|Least { index, robustness }| Some((robustness.0?, index)))
    }

    /// A requirement of which none of so many tests has said anything yet.
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

    /// Adds what the test at a position says.
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

    /// In what sense it is untested, if it is.
    fn gap(&self) -> Option<String> {
        let judged = self.passed + self.failed;
        if judged > 0 {
            return None;
        }
        Some(match (self.undecided, self.not_reached) {
            (0, 0) if self.formula.is_empty() => "it has no formula, and nothing judged it".to_owned(),
            (0, 0) => "no test judged it".to_owned(),
            (0, _) => "no test came to the situation that it is about".to_owned(),
            (_, 0) => "it was undecided in every test".to_owned(),
            (..) => "it was undecided, or its test never came to the situation that it is about".to_owned(),
        })
    }
}

/// Whether each of these trials came to the situation that the tests are about. A scenario without such a premise never
/// says that it did, but then no decided trial is inconclusive either.
fn reached(trials: &[&Trial]) -> Vec<bool> {
    let triggered = |trial: &Trial| trial.triggered() == Some(true);
    let decided = |trial: &Trial| trial.requirements().all(|id| trial.robustness(id).is_some());
    let waits = |trial: &&Trial| trial.verdict == Verdict::Inconclusive && !triggered(trial);
    let has_premise = trials.iter().any(|trial| triggered(trial) || waits(trial) && decided(trial));
    trials.iter().map(|trial| !(has_premise && waits(trial))).collect()
}

impl Traceability {
    /// What the trials of a campaign say.
    ///
    /// # Errors
    /// A trial is none of the study's space.
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
        let of_fixed =
            study.fixed().iter().filter_map(|(name, value)| gap(name, format!("always {}", tried::words(value))));
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

fn gap(what: &str, why: String) -> Option<Gap> {
    Some(Gap { what: what.to_owned(), why })
}
