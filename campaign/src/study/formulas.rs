//! The formulas that are given in addition to the requirements of a scenario, checked against the signals of its
//! traces.

use super::{StatedRequirement, Study, Subject};
use crate::{Error, Reason};
use paracosm_engine::signal;
use paracosm_oracles::{EvaluationError, Formula, ParseError, Semantics, Trace};
use paracosm_space::nearest;
use thiserror::Error;

/// The reason why a formula cannot judge any trace of a study.
#[derive(Debug, Error)]
pub enum FormulaFlaw {
    /// The text is not a valid formula.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// The formula names a signal that the scenario does not have.
    #[error("{source}{}; `paracosm-fuzz describe {scenario}` shows all signals", definition(nearest))]
    Signal {
        /// The error in the formula.
        source: Box<ParseError>,
        /// The name of the most similar signal; `None` if no name is similar.
        nearest: Option<String>,
        /// The name of the scenario.
        scenario: String,
    },
    /// The formula cannot be evaluated on the traces of the study.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// The signals of the traces are not known, because the nominal world of the scenario cannot be built.
    #[error(transparent)]
    World(#[from] Error),
}

/// Says what the signal measures that was probably meant.
fn definition(nearest: &Option<String>) -> String {
    let described = nearest.as_ref().and_then(|name| Some((name, signal::about(name)?)));
    described.map_or_else(String::new, |(name, about)| format!("; `{name}`: {}", about.in_words()))
}

/// The error that a formula of the option `--spec` cannot judge any trace of a study.
#[derive(Debug, Error)]
#[error("--spec {text}: {flaw}")]
pub struct SpecFlaw {
    /// The text of the formula.
    pub text: String,
    /// The reason why the formula cannot judge any trace.
    pub flaw: Box<FormulaFlaw>,
}

impl Reason for FormulaFlaw {}
impl Reason for SpecFlaw {}

impl Study {
    /// Judges every trace by this formula as well. Its id is the first of `spec-1`, `spec-2` and so on that
    /// is free. The formula has no unit and no scale.
    pub(super) fn ask(&mut self, time: Semantics, text: &str) -> Result<(), SpecFlaw> {
        self.record_for(text);
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

    /// Records the signals that a formula asks for, as far as they are measured on request. An error in the text is found elsewhere.
    pub(super) fn record_for(&mut self, text: &str) {
        if let (Subject::Scenario(simulation), Ok(formula)) = (&mut self.subject, text.parse::<Formula>()) {
            simulation.record(formula.signals());
        }
    }

    /// Returns a formula that can judge this study's traces, as far as their signals are known.
    pub(super) fn checked(&self, text: &str, time: Semantics) -> Result<Formula, FormulaFlaw> {
        let formula: Formula = text.parse()?;
        let signals = self.signals()?;
        if let (Subject::Scenario(simulation), Some(signals)) = (&self.subject, &signals) {
            let scenario = || simulation.scenario().to_owned();
            // A slip in the name of a signal that is measured on request is found, too.
            let known: Vec<String> =
                signals.iter().cloned().chain(signal::on_request().map(|(name, _)| name.to_owned())).collect();
            Formula::parse(text, &known).map_err(|source| {
                let unknown = formula.signals().into_iter().find(|name| !known.iter().any(|known| known == name));
                let nearest = unknown.and_then(|name| nearest(name, known.iter().map(String::as_str)));
                FormulaFlaw::Signal { source: source.into(), nearest: nearest.map(str::to_owned), scenario: scenario() }
            })?;
            if time == Semantics::Sampled {
                formula.evaluate(&Trace::new(simulation.dt(), signals.clone()))?;
            }
        }
        if time == Semantics::Dense {
            // Whatever the signals are, the formula's comparisons have to be linear between samples.
            let names: Vec<String> = formula.signals().into_iter().map(str::to_owned).chain([String::new()]).collect();
            let mut sample = Trace::new(1.0, names.clone());
            sample.record(&vec![0.0; names.len()]);
            formula.evaluate_in(time, &sample)?;
        }
        Ok(formula)
    }

    /// Returns the requirements that the user has added to the study with a formula.
    pub fn given(&self) -> impl Iterator<Item = &StatedRequirement> {
        self.requirements.iter().filter(|requirement| requirement.given && requirement.formula.is_some())
    }

    /// Returns the formulas that the user has added and that refer to times after the end of a test. Each entry has the
    /// id of the requirement, and the part of the formula that looks too far ahead.
    pub fn outlasting(&self) -> Vec<(String, Formula)> {
        let Subject::Scenario(simulation) = &self.subject else { return Vec::new() };
        let part = |requirement: &StatedRequirement| {
            let formula = requirement.formula.as_ref()?;
            Some((requirement.id.clone(), formula.outlasting(simulation.duration())?.clone()))
        };
        self.given().filter_map(part).collect()
    }
}
