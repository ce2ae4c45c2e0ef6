//! What a run leaves behind.

use paracosm_oracles::{Trace, Verdict};
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
    /// `travelled` (m); of a contact `impact_speed` (the car's, m/s; 0 without one), `contact_face` (the side of the car),
    /// `contact_with` (the name of the object), `contact_class` (what it is taken for), `contact_motion` (whether the car
    /// was `driving`, `braking` or `standing`) and `other_speed` (the object's, m/s); `triggered`: whether the premise of
    /// the scenario came about. For each violated requirement ID `critical_time.ID` (s), the time at which its formula came
    /// to be worth what it is, with `critical_travelled.ID` (m) and `critical_speed.ID` (m/s) of the car then.
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
