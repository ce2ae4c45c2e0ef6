//! What a run leaves behind.

use paracosm_oracles::{Formula, Semantics, Trace, Verdict};
use std::fmt;

/// A number, a flag or a word that describes a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Metric {
    /// A quantity.
    Number(f64),
    /// Whether something happened.
    Flag(bool),
    /// One of a few words; `None` where none applies.
    Word(Option<String>),
}

impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Metric::Number(number) => write!(f, "{number}"),
            Metric::Flag(flag) => write!(f, "{flag}"),
            Metric::Word(word) => f.write_str(word.as_deref().unwrap_or_default()),
        }
    }
}

/// What became of a test, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// What became of it.
    pub verdict: Verdict,
    /// The robustness of each requirement by its id; `None` where the run ended before it was decided: it is inconclusive
    /// then, unless another was violated.
    pub robustness: Vec<(String, Option<f64>)>,
    /// `travelled` (m); `ended_early`, of runs that may end as soon as all is decided; of a contact `impact_speed` (the car's, m/s; 0 without one), `contact_face` (the side of the car),
    /// `contact_with` (the name of the object), `contact_class` (what it is taken for), `contact_motion` (whether the car
    /// was `driving`, `braking` or `standing`) and `other_speed` (the object's, m/s); `triggered`: whether the premise of
    /// the scenario came about. For each violated requirement the [`violation_metrics`].
    pub metrics: Vec<(String, Metric)>,
    /// The record of the run; `None` where there was none.
    pub trace: Option<Trace>,
    /// Why the verdict is `invalid` or `error`.
    pub error: Option<String>,
}

impl Outcome {
    /// A test that came to nothing.
    pub fn broken(verdict: Verdict, message: impl Into<String>) -> Self {
        Self { verdict, robustness: Vec::new(), metrics: Vec::new(), trace: None, error: Some(message.into()) }
    }
}

/// How many ticks a critical time may be away from a sample at which it is, as both are rounded.
const SAME_TICK: f64 = 1e-6;

/// Why and when the violated requirement ID came to be worth what it is: `critical_part.ID`, the sub-formula on which it
/// depends, and `critical_time.ID` (s), at which it does; of a trace with a car, `critical_travelled.ID` (m) and
/// `critical_speed.ID` (m/s) say how far that had come then and how fast it was. Between two samples these are on the straight
/// line, as the formula takes them in dense time. Nothing where the formula does not fit the trace.
pub fn violation_metrics(id: &str, formula: &Formula, semantics: Semantics, trace: &Trace) -> Vec<(String, Metric)> {
    let Ok(Some(cause)) = formula.explain_in(semantics, trace) else { return Vec::new() };
    let ticks = cause.time / trace.dt();
    let ticks = if (ticks - ticks.round()).abs() <= SAME_TICK { ticks.round() } else { ticks };
    let at = |signal: &str| {
        let mut samples = trace.signal(signal)?.skip(ticks as usize);
        let (before, after) = (samples.next()?, samples.next());
        Some(after.filter(|_| ticks.fract() > 0.0).map_or(before, |after| before + (after - before) * ticks.fract()))
    };
    let numbers = [
        ("critical_time", Some(cause.time)),
        ("critical_travelled", at("car.travelled")),
        ("critical_speed", at("car.speed")),
    ];
    let numbers = numbers.into_iter().filter_map(|(name, value)| Some((name, Metric::Number(value?))));
    let part = ("critical_part", Metric::Word(Some(cause.part.to_string())));
    numbers.chain([part]).map(|(name, metric)| (format!("{name}.{id}"), metric)).collect()
}
