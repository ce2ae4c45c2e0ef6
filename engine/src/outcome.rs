//! What a run leaves behind: how it ended, what became of each requirement, and what was measured.

use crate::contact::Contact;
use crate::driver::Fault;
use crate::program::ProgramError;
use crate::upset::Upset;
use paracosm_oracles::{Formula, Semantics, Trace, Verdict};
use thiserror::Error;

/// What became of a test, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub ending: Ending,
    /// What became of each requirement, in their order; none where nothing could be judged.
    pub judgements: Vec<Judgement>,
    /// What was measured; `None` where there was no run.
    pub measured: Option<Measurements>,
    /// The record of the run; `None` where there was none.
    pub trace: Option<Trace>,
}

impl Outcome {
    /// A test that came to nothing.
    pub fn broken(ending: impl Into<Ending>) -> Self {
        Self { ending: ending.into(), judgements: Vec::new(), measured: None, trace: None }
    }

    /// What became of it, in a word.
    pub fn verdict(&self) -> Verdict {
        self.ending.verdict()
    }

    /// The robustness of a requirement in its unit; `None` where it was not decided.
    pub fn robustness(&self, requirement: &str) -> Option<f64> {
        self.judgements.iter().find(|judgement| judgement.requirement == requirement)?.robustness
    }
}

/// How a test ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// Every requirement holds.
    Pass,
    /// A requirement is violated.
    Fail,
    /// The situation that the test is about never came about, or a requirement stayed undecided.
    Inconclusive,
    /// Its world cannot be built.
    Invalid(Invalid),
    /// The run broke.
    Error(Breakdown),
}

impl Ending {
    /// The same in a word.
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::Pass => Verdict::Pass,
            Self::Fail => Verdict::Fail,
            Self::Inconclusive => Verdict::Inconclusive,
            Self::Invalid(_) => Verdict::Invalid,
            Self::Error(_) => Verdict::Error,
        }
    }

    /// Why there was no run, or no whole one, in words.
    pub fn message(&self) -> Option<String> {
        match self {
            Self::Pass | Self::Fail | Self::Inconclusive => None,
            Self::Invalid(invalid) => Some(invalid.to_string()),
            Self::Error(breakdown) => Some(breakdown.to_string()),
        }
    }
}

impl From<Invalid> for Ending {
    fn from(invalid: Invalid) -> Self {
        Self::Invalid(invalid)
    }
}

impl From<Breakdown> for Ending {
    fn from(breakdown: Breakdown) -> Self {
        Self::Error(breakdown)
    }
}

/// Why the world of a test cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Invalid {
    /// The program refuses these values.
    #[error(transparent)]
    World(ProgramError),
    /// Two bodies are in the same place.
    #[error("{first} and {second} overlap at the start")]
    Overlap {
        /// What the one is called.
        first: String,
        /// What the other is called.
        second: String,
    },
}

/// Why a run broke.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Breakdown {
    /// The program cannot be run on such a test at all.
    #[error(transparent)]
    Program(ProgramError),
    /// The world came to a state that is none.
    #[error("{cause} at {time:.3} s")]
    World {
        /// What is wrong.
        cause: Upset,
        /// When, in seconds since the run began.
        time: f64,
    },
    /// The driver cannot go on.
    #[error("the driver gave up at {time:.3} s: {fault}")]
    Driver {
        /// Why.
        fault: Fault,
        /// When, in seconds since the run began.
        time: f64,
    },
}

/// What became of a requirement.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// The id of the requirement.
    pub requirement: String,
    /// Its robustness in its unit; `None` where the run ended before it was decided.
    pub robustness: Option<f64>,
    /// Why it is violated, if it is and that is known.
    pub violation: Option<Violation>,
}

impl Judgement {
    /// A requirement that was judged so, without a reason.
    pub fn new(requirement: impl Into<String>, robustness: Option<f64>) -> Self {
        Self { requirement: requirement.into(), robustness, violation: None }
    }
}

/// Why and when a violated requirement came to be worth what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// The critical time in seconds, at which the robustness depends on `part`.
    pub time: f64,
    /// How far the car under test had come by then, in metres; `None` where there is no car.
    pub travelled: Option<f64>,
    /// How fast it was then, in m/s; `None` where there is no car.
    pub speed: Option<f64>,
    /// The sub-formula on which the robustness depends, as text.
    pub part: String,
}

/// How many ticks a critical time may be away from a sample at which it is, as both are rounded.
const SAME_TICK: f64 = 1e-6;

impl Violation {
    /// Why a formula is worth what it is on a trace. Between two samples, `travelled` and `speed` are on the straight line, as
    /// the formula takes them in dense time. `None` where the formula does not fit the trace.
    pub fn of(formula: &Formula, semantics: Semantics, trace: &Trace) -> Option<Self> {
        let cause = formula.explain_in(semantics, trace).ok().flatten()?;
        let ticks = cause.time / trace.dt();
        let ticks = if (ticks - ticks.round()).abs() <= SAME_TICK { ticks.round() } else { ticks };
        let at = |signal: &str| {
            let mut samples = trace.signal(signal)?.skip(ticks as usize);
            let (before, after) = (samples.next()?, samples.next());
            Some(
                after.filter(|_| ticks.fract() > 0.0).map_or(before, |after| before + (after - before) * ticks.fract()),
            )
        };
        let (travelled, speed) = (at("car.travelled"), at("car.speed"));
        Some(Self { time: cause.time, travelled, speed, part: cause.part.to_string() })
    }
}

/// What is measured of a run beside its requirements.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurements {
    /// How far the car under test came, in metres.
    pub travelled: f64,
    /// What it touched, which ended the run.
    pub contact: Option<Contact>,
    /// Whether the premise of the scenario came about; false where it has none.
    pub triggered: bool,
}
