//! A requirement: a formula with what a test report needs to speak of it.

use crate::{Evaluation, EvaluationError, Formula, Trace};

/// What is asked of every run of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirement {
    /// The short name by which logs and commands know it: `no-collision`.
    pub id: String,
    /// One sentence for people.
    pub text: String,
    /// What is asked.
    pub formula: Formula,
    /// The unit of its robustness.
    pub unit: String,
    /// How much robustness is a lot, in that unit: requirements are compared by robustness / scale.
    pub scale: f64,
}

impl Requirement {
    /// Judges a trace.
    ///
    /// # Errors
    /// The formula does not fit the trace, or a number that it depends on is NaN.
    pub fn judge(&self, trace: &Trace) -> Result<Evaluation, EvaluationError> {
        self.formula.evaluate(trace)
    }
}
