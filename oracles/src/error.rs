//! Errors of an evaluation, and the search for the nearest known name.

use crate::Interval;
use thiserror::Error;

/// The reason why a formula cannot be evaluated on a trace.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EvaluationError {
    /// The formula names a signal that the trace does not have.
    #[error("the trace has no signal `{name}`{}", did_you_mean(.nearest))]
    UnknownSignal {
        /// The name of the signal that the trace does not have.
        name: String,
        /// The name of the most similar signal of the trace, if a name is similar enough.
        nearest: Option<String>,
    },
    /// A sample or an expression has no value. The sample is NaN, or the expression is infinity minus infinity, 0 / 0,
    /// or zero times infinity. In dense time, infinite numbers cause this error, too.
    #[error("`{what}` has no value at {time} s")]
    NoValue {
        /// The signal, the expression or the comparison without a value.
        what: String,
        /// The time in seconds at which the value is missing.
        time: f64,
    },
    /// A time bound lies between two samples, and the formula does not allow rounding.
    #[error("the time bound {bound} s is not a multiple of the sample period {dt} s; write {widened} to round outward")]
    TimeBound {
        /// The time bound that lies between two samples, in seconds.
        bound: f64,
        /// The sample period of the trace, in seconds.
        dt: f64,
        /// The time interval of the operator in the accepted form `~[a,b]`, whose bounds are rounded outward to
        /// samples.
        widened: Interval,
    },
    /// A formula in dense time has a comparison that is not piecewise linear in time, or uses a signal as a truth
    /// value. Dense time cannot follow such parts between samples. A truth value has no distance to the other truth
    /// value.
    #[error("`{formula}` is not a piecewise linear function of its signals, which dense time needs")]
    NotLinear {
        /// The part of the formula that dense time cannot evaluate, as text.
        formula: String,
    },
    /// The time bounds of an operator are not a valid interval. Only formulas built in Rust can have such bounds.
    #[error("the time bounds [{},{}] are not an interval, expected 0 <= start <= end in seconds", .0.start, .0.end)]
    Interval(Interval),
}

impl EvaluationError {
    /// Returns `true` if other traces of the same source would cause the same error. Another trace may have a signal
    /// that this trace lacks. But if this trace has a signal whose name differs only by a typing mistake, the result is
    /// `true`.
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

/// Returns the candidate that is most similar to `name`, by the normalised Damerau-Levenshtein similarity without
/// regard to case. `None` if no similarity is at least 0.4.
pub(crate) fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| (strsim::normalized_damerau_levenshtein(&name, &candidate.to_lowercase()), candidate))
        .filter(|(likeness, _)| *likeness >= 0.4)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// Returns `true` if one name is probably a mistyped form of the other. Then the names differ in capitals and
/// separators only. Or, in one word, two neighbouring letters are swapped, or one letter other than the first and the
/// last is wrong, missing or added. Names that differ in a digit or at the edge of a word name two things: `car1` and
/// `car2`, `gap_l` and `gap_r`.
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
