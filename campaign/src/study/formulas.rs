//! The formulas that are given beside the requirements of a scenario, checked against the signals that its traces have.

use super::{StatedRequirement, Study, Subject};
use crate::{Error, Reason};
use paracosm_oracles::{EvaluationError, Formula, ParseError, Semantics, Trace};
use thiserror::Error;

/// A formula that no trace of a study can be asked.
#[derive(Debug, Error)]
pub enum FormulaFlaw {
    /// It is no formula.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// It speaks of a signal that the scenario does not have.
    #[error("{source}; `paracosm-fuzz describe {scenario}` shows its signals")]
    Signal {
        /// What is wrong.
        source: ParseError,
        /// The scenario.
        scenario: String,
    },
    /// It cannot be evaluated.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// The world that says which signals there are cannot be built.
    #[error(transparent)]
    World(#[from] Error),
}

/// A formula of `--spec` that no trace of a study can be asked.
#[derive(Debug, Error)]
#[error("--spec {text}: {flaw}")]
pub struct SpecFlaw {
    /// The formula.
    pub text: String,
    /// What is wrong with it.
    pub flaw: Box<FormulaFlaw>,
}

impl Reason for FormulaFlaw {}
impl Reason for SpecFlaw {}

impl Study {
    /// Asks this formula, too, of every trace: as `spec-1`, the next as `spec-2`, in no unit and without a scale.
    pub(super) fn ask(&mut self, time: Semantics, text: &str) -> Result<(), SpecFlaw> {
        let formula = self.checked(text, time).map_err(|flaw| SpecFlaw { text: text.to_owned(), flaw: flaw.into() })?;
        let mut ids = (1..).map(|number| format!("spec-{number}"));
        let id = ids.find(|id| self.requirement(id).is_none()).expect("there is always another number");
        self.requirements.push(StatedRequirement {
            id,
            text: formula.to_string(),
            formula: Some(formula),
            unit: String::new(),
            scale: None,
            source: None,
            severity: None,
            time,
            given: true,
        });
        Ok(())
    }

    /// A formula that can be asked of this study's traces, as far as these are known.
    pub(super) fn checked(&self, text: &str, time: Semantics) -> Result<Formula, FormulaFlaw> {
        let formula: Formula = text.parse()?;
        let signals = self.signals()?;
        if let (Subject::Scenario(simulation), Some(signals)) = (&self.subject, &signals) {
            let scenario = || simulation.scenario().to_owned();
            Formula::parse(text, signals).map_err(|source| FormulaFlaw::Signal { source, scenario: scenario() })?;
            if time == Semantics::Sampled {
                formula.evaluate(&Trace::new(simulation.dt(), signals.clone()))?;
            }
        }
        if time == Semantics::Dense {
            // Its comparisons have to be straight between samples, whatever the signals are.
            let names: Vec<String> = formula.signals().into_iter().map(str::to_owned).chain([String::new()]).collect();
            let mut sample = Trace::new(1.0, names.clone());
            sample.record(&vec![0.0; names.len()]);
            formula.evaluate_in(time, &sample)?;
        }
        Ok(formula)
    }

    /// The requirements that were given with the study and have a formula, in order.
    pub fn given(&self) -> impl Iterator<Item = &StatedRequirement> {
        self.requirements.iter().filter(|requirement| requirement.given && requirement.formula.is_some())
    }

    /// Given formulas that look further ahead than a test of the scenario lasts, each with the part that does.
    pub fn outlasting(&self) -> Vec<(String, Formula)> {
        let Subject::Scenario(simulation) = &self.subject else { return Vec::new() };
        let part = |requirement: &StatedRequirement| {
            let formula = requirement.formula.as_ref()?;
            Some((requirement.id.clone(), formula.outlasting(simulation.duration())?.clone()))
        };
        self.given().filter_map(part).collect()
    }
}
