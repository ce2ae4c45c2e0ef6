//! Why a formula cannot be asked of a trace, and the nearest name to one that is unknown.

use crate::Interval;
use thiserror::Error;

/// A formula that does not fit the trace, or a trace with a hole in it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EvaluationError {
    /// The formula names a signal that the trace does not have.
    #[error("the trace has no signal `{name}`{}", did_you_mean(.nearest))]
    UnknownSignal {
        /// The name that is in the formula only.
        name: String,
        /// The signal of the trace that is most like it, if one is like it.
        nearest: Option<String>,
    },
    /// A sample that is NaN, or an expression without a value: infinity minus infinity, zero by zero, zero times
    /// infinity.
    #[error("`{what}` has no value at {time} s")]
    NoValue {
        /// The signal or the comparison in question.
        what: String,
        /// When, in seconds.
        time: f64,
    },
    /// A time bound between two samples, which the formula does not say to round.
    #[error(
        "a time bound of {bound} s is no multiple of the sample period of {dt} s; {widened} would round it outward"
    )]
    TimeBound {
        /// The bound in seconds.
        bound: f64,
        /// The sample period in seconds.
        dt: f64,
        /// The interval that would be accepted.
        widened: Interval,
    },
    /// An expression that is not piecewise linear where its signals are, or a truth that has no distance to the other:
    /// neither can be followed between samples.
    #[error("`{0}` is no piecewise linear function of its signals, as dense time asks for")]
    NotLinear(String),
    /// Bounds that are no interval; only formulas built in Rust can have them.
    #[error("the time bounds [{},{}] are no interval, expected 0 <= start <= end in seconds", .0.start, .0.end)]
    Interval(Interval),
}

impl EvaluationError {
    pub(crate) fn unknown(name: &str, signals: &[String]) -> Self {
        let nearest = nearest(name, signals.iter().map(String::as_str)).map(str::to_owned);
        EvaluationError::UnknownSignal { name: name.to_owned(), nearest }
    }
}

/// The candidate most like `name`, by the normalised Damerau-Levenshtein distance without regard to case; none below
/// a likeness of 0.4.
pub(crate) fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| (strsim::normalized_damerau_levenshtein(&name, &candidate.to_lowercase()), candidate))
        .filter(|(likeness, _)| *likeness >= 0.4)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}
