//! The words in which a run is judged.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Whether a trace satisfies a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    /// It does, whatever might have followed.
    Holds,
    /// It does not, whatever might have followed.
    Violated,
    /// The trace was cut short before that was decided.
    Undecided,
}

impl Truth {
    /// The truth of a statement about a sample.
    pub fn of(holds: bool) -> Self {
        if holds { Truth::Holds } else { Truth::Violated }
    }

    /// Both hold (Kleene's conjunction).
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Truth::Violated, _) | (_, Truth::Violated) => Truth::Violated,
            (Truth::Holds, Truth::Holds) => Truth::Holds,
            _ => Truth::Undecided,
        }
    }

    /// One holds (Kleene's disjunction).
    pub fn or(self, other: Self) -> Self {
        self.not().and(other.not()).not()
    }

    /// The contrary.
    #[expect(clippy::should_implement_trait, reason = "it stands beside `and` and `or`")]
    pub fn not(self) -> Self {
        match self {
            Truth::Holds => Truth::Violated,
            Truth::Violated => Truth::Holds,
            Truth::Undecided => Truth::Undecided,
        }
    }
}

/// What became of a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// No requirement is violated.
    Pass,
    /// A requirement is violated.
    Fail,
    /// The situation that the test is about never came about.
    Inconclusive,
    /// The test's world cannot be built.
    Invalid,
    /// The run broke: a crash, a time-out, a state that is no number.
    Error,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Verdict::Pass => "pass",
            Verdict::Fail => "fail",
            Verdict::Inconclusive => "inconclusive",
            Verdict::Invalid => "invalid",
            Verdict::Error => "error",
        })
    }
}
