//! The result of a run: how it ended, how each requirement was judged, and what was measured.

use crate::contact::Contact;
use crate::driver::Fault;
use crate::program::ProgramError;
use crate::upset::Upset;
use paracosm_oracles::{Formula, Semantics, Trace, Verdict};
use std::sync::Arc;
use thiserror::Error;

/// The result of a test, with its reasons.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The ending of the test.
    pub ending: Ending,
    /// The judgements of all requirements, in the order of the requirements. Empty if the run could not be judged.
    pub judgements: Vec<Judgement>,
    /// The measurements of the run; `None` if there was no run.
    pub measured: Option<Measurements>,
    /// The recorded signals of the run; `None` if there was no run.
    pub trace: Option<Trace>,
}

impl Outcome {
    /// Makes the outcome of a test that has no run, or whose run ended with an error.
    pub fn broken(ending: impl Into<Ending>) -> Self {
        Self { ending: ending.into(), judgements: Vec::new(), measured: None, trace: None }
    }

    /// Returns the verdict of the test.
    pub fn verdict(&self) -> Verdict {
        self.ending.verdict()
    }

    /// Returns the robustness of a requirement in its unit; `None` if the requirement was not decided.
    pub fn robustness(&self, requirement: &str) -> Option<f64> {
        self.judgements.iter().find(|judgement| *judgement.requirement == *requirement)?.robustness
    }
}

/// The ending of a test.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// Every requirement holds.
    Pass,
    /// A requirement is violated.
    Fail,
    /// The premise of the test never occurred, or a requirement stayed undecided.
    Inconclusive,
    /// The world of the test cannot be built.
    Invalid(Invalid),
    /// The run ended with an error.
    Error(Breakdown),
}

impl Ending {
    /// Returns the verdict that belongs to the ending.
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::Pass => Verdict::Pass,
            Self::Fail => Verdict::Fail,
            Self::Inconclusive => Verdict::Inconclusive,
            Self::Invalid(_) => Verdict::Invalid,
            Self::Error(_) => Verdict::Error,
        }
    }

    /// Returns the reason for a missing or incomplete run, in words; `None` if the run was complete.
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

/// The reason why the world of a test cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Invalid {
    /// The program refuses the values of the test.
    #[error(transparent)]
    World(ProgramError),
    /// Two bodies overlap at the start of the run.
    #[error("{first} and {second} overlap at the start; place them apart")]
    Overlap {
        /// The name of the first body.
        first: String,
        /// The name of the second body.
        second: String,
    },
}

/// The reason why a run ended with an error.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Breakdown {
    /// The program cannot be run on the test, because their parameters differ or are not valid.
    #[error(transparent)]
    Program(ProgramError),
    /// The world reached an impossible state.
    #[error("{cause} at {time:.3} s")]
    World {
        /// The cause of the breakdown.
        cause: Upset,
        /// The time of the breakdown, in seconds since the run began.
        time: f64,
    },
    /// The driver cannot go on.
    #[error("the driver gave up at {time:.3} s: {fault}")]
    Driver {
        /// The fault of the driver.
        fault: Fault,
        /// The time of the fault, in seconds since the run began.
        time: f64,
    },
}

/// The result of a requirement in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// The id of the requirement.
    pub requirement: Arc<str>,
    /// The robustness in the requirement's unit; `None` if the run ended before the requirement was decided.
    pub robustness: Option<f64>,
    /// The cause of the violation, if the requirement is violated and the cause is known.
    pub violation: Option<Box<Violation>>,
}

impl Judgement {
    /// Makes a judgement without a violation, from a requirement's id and robustness.
    pub fn new(requirement: impl Into<Arc<str>>, robustness: Option<f64>) -> Self {
        Self { requirement: requirement.into(), robustness, violation: None }
    }
}

/// The cause of a violated requirement's robustness, as a time, a place and a part of the formula.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// The critical time in seconds, at which the robustness depends on `part`.
    pub time: f64,
    /// The distance that the ego vehicle had covered at the critical time, in metres; `None` if there is no car.
    pub travelled: Option<f64>,
    /// The speed of the ego vehicle at the critical time, in m/s; `None` if there is no car.
    pub speed: Option<f64>,
    /// The sub-formula on which the robustness depends, as text.
    pub part: String,
}

/// The number of ticks by which a critical time may differ from a sample's time and still count as equal to it.
const SAME_TICK: f64 = 1e-6;

impl Violation {
    /// Explains the robustness of a formula on a trace. Between two samples, `travelled` and `speed` are interpolated
    /// linearly, as in dense time. `None` if the formula does not fit the trace.
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

/// The measurements of a run in addition to its requirements.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurements {
    /// The distance that the ego vehicle covered, in metres.
    pub travelled: f64,
    /// The contact that ended the run, if there was a contact.
    pub contact: Option<Contact>,
    /// True if the premise of the scenario occurred; false if the scenario has no premise.
    pub triggered: bool,
}
