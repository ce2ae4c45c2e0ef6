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
    #[error("`{formula}` is no piecewise linear function of its signals, as dense time asks for")]
    NotLinear {
        /// The part of the formula.
        formula: String,
    },
    /// Bounds that are no interval; only formulas built in Rust can have them.
    #[error("the time bounds [{},{}] are no interval, expected 0 <= start <= end in seconds", .0.start, .0.end)]
    Interval(Interval),
}

impl EvaluationError {
    /// Whether the formula will fit other traces of the same source no better. A signal that one trace lacks another may
    /// have, unless one that is there is called the same but for a slip of the pen.
    pub fn fits_no_trace(&self) -> bool {
        match self {
            EvaluationError::UnknownSignal { name, nearest } => {
                nearest.as_ref().is_some_and(|nearest| is_slip(name, nearest))
            }
            EvaluationError::NoValue { .. } => false,
            EvaluationError::TimeBound { .. } | EvaluationError::NotLinear { .. } | EvaluationError::Interval(_) => {
                true
            }
        }
    }

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

/// Whether one name is written for the other: with other capitals or separators, or in one word with two letters swapped, or
/// with one that is wrong, missing or too many between its first and its last. What differs by a digit or at the edge of a word,
/// as `car1` and `car2`, `gap_l` and `gap_r` do, are names of two things.
fn is_slip(name: &str, other: &str) -> bool {
    let [name, other] = [name, other].map(str::to_lowercase);
    let words = |name: &str| -> Vec<String> {
        name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_owned).collect()
    };
    let [words, others] = [words(&name), words(&other)];
    if words.concat() == others.concat() {
        return true;
    }
    let mut differing = words.iter().zip(&others).filter(|(word, other)| word != other);
    let (Some((word, other)), None) = (differing.next(), differing.next()) else { return false };
    let letters = |word: &str| {
        let mut letters: Vec<char> = word.chars().collect();
        letters.sort_unstable();
        letters
    };
    let digits = |word: &str| -> String { word.chars().filter(char::is_ascii_digit).collect() };
    let edges = |word: &str| (word.chars().next(), word.chars().next_back());
    words.len() == others.len()
        && digits(word) == digits(other)
        && strsim::damerau_levenshtein(word, other) == 1
        && (letters(word) == letters(other) || edges(word) == edges(other))
}

fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_pen_is_told_from_the_name_of_another_thing() {
        let slips = [("rmp", "rpm"), ("sped", "speed"), ("car.speeed", "car.speed"), ("Car.Speed", "car.speed")];
        for (name, other) in slips.into_iter().chain([("carspeed", "car.speed"), ("lead_distence", "lead_distance")]) {
            assert!(is_slip(name, other), "{name} {other}");
        }
        for (name, other) in [
            ("car1.speed", "car2.speed"),
            ("a.speed", "b.speed"),
            ("car.x", "car.y"),
            ("gap_l", "gap_r"),
            ("car", "cars"),
            ("lead.speed", "car.speed"),
            ("car.sped.x", "car.speed"),
            ("velocity", "speed"),
        ] {
            assert!(!is_slip(name, other), "{name} {other}");
        }
    }
}
