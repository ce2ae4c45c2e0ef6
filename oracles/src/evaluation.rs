//! What a formula is worth on a trace, and why.

use crate::worth::{Worth, truth};
use crate::{Formula, Truth};
use serde::{Deserialize, Serialize};

/// What a trace says of the time between its samples.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Semantics {
    /// Nothing: formulas speak of the samples.
    #[default]
    Sampled,
    /// Signals are straight lines from sample to sample, and formulas speak of every instant. A robustness of 0 is left
    /// undecided. Windows are closed as they are written, to the instant: where a robustness jumps, because an operator
    /// comes to see the first instant of the trace or loses sight of the last one, it has a value at that very instant
    /// beside the limits from before and after it.
    Dense,
}

/// What a formula is worth at the beginning of a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// Whether it holds.
    pub truth: Truth,
    /// How far it is from the other answer, judging by what was recorded.
    pub robustness: f64,
    /// The least that this could have become, had the trace gone on in the worst way.
    pub lower: f64,
    /// The most, had it gone on in the best way.
    pub upper: f64,
}

impl Evaluation {
    /// What is known before anything was recorded.
    pub(crate) const UNKNOWN: Self =
        Self { truth: Truth::Undecided, robustness: f64::NAN, lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    pub(crate) fn new(recorded: Worth, lower: Worth, upper: Worth) -> Self {
        Self {
            truth: truth(lower, upper),
            robustness: recorded.robustness(),
            lower: lower.robustness(),
            upper: upper.robustness(),
        }
    }
}

/// What the robustness of a formula comes down to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cause<'f> {
    /// The critical time in seconds.
    pub time: f64,
    /// The sub-formula whose worth at that time is, up to its sign, that of the whole: a comparison, or a temporal
    /// operator within whose bounds nothing was recorded.
    pub part: &'f Formula,
    /// The robustness of the whole.
    pub robustness: f64,
}
