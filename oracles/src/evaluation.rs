//! The result of evaluating a formula on a trace, and the cause of its robustness.

use crate::worth::{Worth, truth};
use crate::{Formula, Truth};
use serde::{Deserialize, Serialize};

/// The meaning of a trace between its samples.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Semantics {
    /// Sampled time, in which formulas refer to the samples only.
    #[default]
    Sampled,
    /// Dense time, in which signals are straight lines from sample to sample and formulas refer to every instant. A
    /// robustness of 0 is undecided.
    ///
    /// Windows include both of their ends exactly. The robustness may jump when the window of an operator reaches the
    /// first instant of the trace or leaves the last one. At this instant, the robustness has a value of its own,
    /// beside the limits from before and after.
    Dense,
}

/// The truth and the robustness of a formula at the beginning of a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// The truth of the formula at the beginning of the trace. It is valid for every continuation of the trace.
    pub truth: Truth,
    /// The margin by which the formula holds (above 0) or is violated (below 0), for the recorded samples only. It is
    /// NaN if the trace is empty.
    pub robustness: f64,
    /// The lowest robustness that a continuation of the trace can give the formula.
    pub lower: f64,
    /// The highest robustness that a continuation of the trace can give the formula.
    pub upper: f64,
}

impl Evaluation {
    /// The evaluation of a formula on an empty trace.
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

/// A part of a formula and a time that together determine the robustness of the formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cause<'f> {
    /// The time at which the part determines the robustness of the formula, in seconds.
    pub time: f64,
    /// The sub-formula that determines the robustness of the whole formula. At this time the sub-formula has the same
    /// robustness, up to the sign. It is a comparison, a flag or a constant, or a temporal operator whose bounds
    /// contain no sample.
    pub part: &'f Formula,
    /// The robustness of the whole formula.
    pub robustness: f64,
}
