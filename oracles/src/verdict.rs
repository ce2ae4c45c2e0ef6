//! Truths of formulas and verdicts of tests.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The truth of a formula on a trace, which the trace may leave undecided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    /// The formula holds, for every continuation of the trace.
    Holds,
    /// The formula is violated, for every continuation of the trace.
    Violated,
    /// The trace does not decide the formula. It ends too early or, in dense time, the robustness is 0.
    Undecided,
}

impl Truth {
    /// Converts `true` into `Holds` and `false` into `Violated`.
    pub fn of(holds: bool) -> Self {
        if holds { Truth::Holds } else { Truth::Violated }
    }

    /// Returns the truth of the conjunction of two formulas, by Kleene's three-valued logic.
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Truth::Violated, _) | (_, Truth::Violated) => Truth::Violated,
            (Truth::Holds, Truth::Holds) => Truth::Holds,
            _ => Truth::Undecided,
        }
    }

    /// Returns the truth of the disjunction of two formulas, by Kleene's three-valued logic.
    pub fn or(self, other: Self) -> Self {
        self.not().and(other.not()).not()
    }

    /// Returns the truth of the negated formula.
    #[expect(clippy::should_implement_trait, reason = "it stands beside `and` and `or`")]
    pub fn not(self) -> Self {
        match self {
            Truth::Holds => Truth::Violated,
            Truth::Violated => Truth::Holds,
            Truth::Undecided => Truth::Undecided,
        }
    }
}

/// The result of a test, such as `pass` or `fail`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The run of the test violates no requirement.
    Pass,
    /// The run of the test violates a requirement.
    Fail,
    /// The run of the test violates a requirement, and none of the reference drivers avoids the violation.
    Unpreventable,
    /// The run violates no requirement, but the situation that the test examines never occurred.
    Inconclusive,
    /// The world of the test cannot be built.
    Invalid,
    /// The run failed because of a crash, a time-out or a simulation state that is not finite.
    Error,
}

impl Verdict {
    /// All verdicts, in the order in which tables show them.
    pub const ALL: [Self; 6] =
        [Self::Fail, Self::Unpreventable, Self::Pass, Self::Inconclusive, Self::Invalid, Self::Error];
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Verdict::Pass => "pass",
            Verdict::Fail => "fail",
            Verdict::Unpreventable => "unpreventable",
            Verdict::Inconclusive => "inconclusive",
            Verdict::Invalid => "invalid",
            Verdict::Error => "error",
        })
    }
}
