//! What is asked of every run: the requirements of a scenario, and the formulas that were given beside them.

use super::{Study, Subject};
use crate::Error;
use paracosm_engine::{Outcome, violation_metrics};
use paracosm_oracles::{EvaluationError, Formula, Requirement, Semantics, Truth, Verdict};
use serde::{Deserialize, Serialize};

/// A requirement as it is written down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RequirementText {
    /// The short name.
    pub id: String,
    /// One sentence.
    pub text: String,
    /// What is asked; empty where it is not known here: the system under test judges itself by it, or nobody does.
    pub formula: String,
    /// The unit of its robustness.
    pub unit: String,
    /// How much robustness is a lot, in that unit; `None` where nobody said, and a search has to find out.
    pub scale: Option<f64>,
    /// Where it comes from: a regulation, a specification, a hazard.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub source: Option<String>,
    /// How severe a violation is, in a word of whoever states it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub severity: Option<String>,
    /// What is taken to happen between the samples of a trace.
    #[serde(skip_serializing_if = "is_sampled", default)]
    pub time: Semantics,
    /// Whether it is none of the scenario's own, but was given with the study.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    pub given: bool,
}

/// What is usual is not written down.
fn is_sampled(time: &Semantics) -> bool {
    *time == Semantics::Sampled
}

impl From<Requirement> for RequirementText {
    fn from(requirement: Requirement) -> Self {
        let Requirement { id, text, formula, unit, scale } = requirement;
        let formula = formula.to_string();
        let (scale, time) = (Some(scale), Semantics::Sampled);
        Self { id, text, formula, unit, scale, source: None, severity: None, time, given: false }
    }
}

impl RequirementText {
    /// Whether it is known what is asked.
    pub fn has_formula(&self) -> bool {
        !self.formula.is_empty()
    }
}

impl Study {
    /// Asks this formula, too, of every trace: as `spec-1`, the next as `spec-2`, in no unit and without a scale. To be
    /// called when all parameters are opened, fixed and varied.
    ///
    /// # Errors
    /// The text is no formula, speaks of a signal that the scenario does not have, or has a time bound between two ticks.
    pub fn spec(self, text: &str) -> Result<Self, Error> {
        self.spec_in(Semantics::Sampled, text)
    }

    /// The same by the samples or between them.
    ///
    /// # Errors
    /// As for [`spec`](Self::spec); in dense time also if a comparison is not piecewise linear, while time bounds may be any.
    pub fn spec_in(mut self, time: Semantics, text: &str) -> Result<Self, Error> {
        let formula = self.checked(text, time).map_err(|message| Error::Usage(format!("--spec {text}: {message}")))?;
        let formula = formula.to_string();
        let mut ids = (1..).map(|number| format!("spec-{number}"));
        let id = ids.find(|id| self.requirement(id).is_none()).expect("there is always another number");
        self.requirements.push(RequirementText {
            id,
            text: formula.clone(),
            formula,
            unit: String::new(),
            scale: None,
            source: None,
            severity: None,
            time,
            given: true,
        });
        Ok(self)
    }

    /// Given formulas that look further ahead than a test of the scenario lasts, each with the part that does.
    ///
    /// # Errors
    /// A requirement was read from a file and is no formula.
    pub fn outlasting(&self) -> Result<Vec<(String, String)>, Error> {
        let Subject::Scenario(simulation) = &self.subject else { return Ok(Vec::new()) };
        let specs = Specs::of(self)?;
        let part = |Spec { id, formula, .. }: &Spec| {
            formula.outlasting(simulation.duration()).map(|part| (id.clone(), part.to_string()))
        };
        Ok(specs.0.iter().filter_map(part).collect())
    }
}

/// The formulas that were given with a study, by their ids.
#[derive(Debug, Clone)]
pub(crate) struct Specs(Vec<Spec>);

#[derive(Debug, Clone)]
struct Spec {
    id: String,
    formula: Formula,
    time: Semantics,
}

/// What stands in the error of a trial whose trace a formula does not fit, as it will fit no other.
const MISFIT: &str = " does not fit the trace: ";
/// The same where another trace may be different.
const NO_ANSWER: &str = " cannot be asked of this trace: ";

impl Specs {
    /// Those of a study.
    ///
    /// # Errors
    /// One of them was read from a file and is no formula.
    pub fn of(study: &Study) -> Result<Self, Error> {
        let given = study.requirements.iter().filter(|requirement| requirement.given && requirement.has_formula());
        let parse = |requirement: &RequirementText| {
            let formula = requirement.formula.parse().map_err(|error| {
                Error::Usage(format!("requirement `{}`, `{}`: {error}", requirement.id, requirement.formula))
            })?;
            Ok(Spec { id: requirement.id.clone(), formula, time: requirement.time })
        };
        Ok(Self(given.map(parse).collect::<Result<_, Error>>()?))
    }

    /// The formulas, if all of them can be decided while a run goes on: not those in dense time.
    pub fn online(&self) -> Option<Vec<Formula>> {
        let sampled = |spec: &Spec| (spec.time == Semantics::Sampled).then(|| spec.formula.clone());
        self.0.iter().map(sampled).collect()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether the error of a trial says that one of them fits no trace.
    pub fn is_misfit(error: &str) -> bool {
        error.contains(MISFIT)
    }

    /// Asks them of the trace of a run that came to a verdict, and joins what they say with that.
    pub fn judge(&self, outcome: &mut Outcome) {
        let Some(trace) = outcome.trace.as_ref().filter(|_| outcome.error.is_none()) else { return };
        let mut wrong: Option<(bool, String)> = None;
        for Spec { id, formula, time } in &self.0 {
            let (truth, robustness) = match formula.evaluate_in(*time, trace) {
                Ok(evaluation) => (evaluation.truth, evaluation.robustness),
                Err(error) => {
                    let (is_misfit, says) = match &error {
                        EvaluationError::NoValue { .. } => (false, ": "),
                        error if error.fits_no_trace() => (true, MISFIT),
                        _ => (false, NO_ANSWER),
                    };
                    // What is wrong with all traces goes before what is wrong with this one.
                    if wrong.as_ref().is_none_or(|(was_misfit, _)| is_misfit && !was_misfit) {
                        wrong = Some((is_misfit, format!("{id}{says}{error}")));
                    }
                    (Truth::Undecided, f64::NAN)
                }
            };
            outcome.robustness.push((id.clone(), (truth != Truth::Undecided).then_some(robustness)));
            if truth == Truth::Violated {
                outcome.metrics.extend(violation_metrics(id, formula, *time, trace));
            }
            outcome.verdict = match (truth, outcome.verdict) {
                (Truth::Violated, _) | (_, Verdict::Fail) => Verdict::Fail,
                (Truth::Undecided, _) => Verdict::Inconclusive,
                (Truth::Holds, verdict) => verdict,
            };
        }
        if let Some((_, error)) = wrong {
            outcome.verdict = Verdict::Error;
            outcome.error = Some(error);
        }
    }
}
