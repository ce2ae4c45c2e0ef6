//! Requirements: formulas with the texts, units and scales that reports need.

use crate::{Evaluation, EvaluationError, Formula, Trace};

/// A requirement that every run of a scenario should satisfy.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirement {
    /// The short name of the requirement in logs and commands, such as `no-collision`.
    pub id: String,
    /// The text of the requirement for people, in one sentence.
    pub text: String,
    /// The formula that the trace of a run should satisfy.
    pub formula: Formula,
    /// The unit of the requirement's robustness.
    pub unit: String,
    /// The robustness that counts as large for this requirement, in the requirement's unit. Requirements are compared
    /// by robustness / scale.
    pub scale: f64,
}

impl Requirement {
    /// Evaluates the formula of the requirement at the beginning of a trace.
    ///
    /// # Errors
    /// The formula does not fit the trace, or a number that it depends on is NaN.
    pub fn judge(&self, trace: &Trace) -> Result<Evaluation, EvaluationError> {
        self.formula.evaluate(trace)
    }
}
