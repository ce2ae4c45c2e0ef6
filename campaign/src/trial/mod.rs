//! Trials: a test with its result, which is a line of `trials.jsonl`.

mod line;
mod metric;

pub use metric::Metric;

use paracosm_engine::driver::FaultKind;
use paracosm_engine::{Breakdown, Contact, Ending, Judgement, Measurements, Outcome, Violation};
use paracosm_oracles::{Trace, Verdict};
use paracosm_space::{Record, Values};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A test with its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "line::Line", into = "line::Line")]
pub struct Trial {
    /// The position of the test in the campaign, from 0.
    pub index: usize,
    /// The values of the open parameters.
    pub test: Values,
    /// The verdict on the test.
    pub verdict: Verdict,
    /// The reason for the verdict `invalid` or `error`.
    pub problem: Option<Problem>,
    /// The judgements of the requirements, in the order in which they were made.
    pub judgements: Vec<Judgement>,
    /// The measurements; `None` if there was no simulated run.
    pub measured: Option<Measurements>,
    /// Metrics of other versions of the software.
    others: Record<Metric>,
    /// The number of simulated ticks.
    pub ticks: usize,
    /// The fingerprint of the trace; `None` if there is no trace.
    pub trace_hash: Option<String>,
}

/// The reason why a test has no result.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The kind of the problem.
    pub kind: ProblemKind,
    /// The description of the problem, for people.
    pub message: String,
}

/// Metrics of older versions that tests no longer have.
const RETIRED: [&str; 1] = ["ended_early"];

fn owned((name, metric): (&str, &Metric)) -> (String, Metric) {
    (name.to_owned(), metric.clone())
}

impl Problem {
    /// Makes a problem of a kind, with its description.
    pub fn new(kind: ProblemKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// The kinds of problems that end a test without an answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProblemKind {
    /// The world of the test cannot be built; the verdict is `invalid`.
    World,
    /// The program cannot run such a test at all.
    Program,
    /// The world reached an impossible state.
    State,
    /// The run panicked.
    Panic,
    /// The driver cannot continue.
    Driver,
    /// The driver could not be shown the images of its cameras.
    Camera,
    /// The system itself reports that it cannot do the test.
    System,
    /// The system or the driver cannot be started, or its process is gone.
    Process,
    /// The system or the driver did not answer in time.
    TimedOut,
    /// The answer of the system or the driver is not a valid answer.
    Answer,
    /// The system was judged by other requirements than in earlier tests.
    Requirements,
    /// A formula does not fit the trace, and will not fit any other trace of the same source.
    Misfit {
        /// The id of the requirement.
        requirement: String,
        /// The sample period in seconds, if the time bounds of the formula do not fit the period.
        #[serde(skip_serializing_if = "Option::is_none", default)]
        period: Option<f64>,
    },
    /// A formula cannot judge this trace, but may fit another one.
    Unasked {
        /// The id of the requirement.
        requirement: String,
    },
    /// The campaign no longer waited for the test.
    Interrupted,
    /// The log of an older version does not state the kind.
    Unstated,
}

impl ProblemKind {
    /// Returns the kind of problem for a fault of a driver.
    pub fn of(fault: FaultKind) -> Self {
        match fault {
            FaultKind::Stated | FaultKind::Equipment => Self::Driver,
            FaultKind::Answer => Self::Answer,
            FaultKind::TimedOut => Self::TimedOut,
            FaultKind::Lost => Self::Process,
            FaultKind::Interrupted => Self::Interrupted,
        }
    }
}

impl Trial {
    /// Makes the trial of a test with this verdict and these judgements, without a trace.
    pub fn judged(index: usize, test: Values, verdict: Verdict, judgements: Vec<Judgement>) -> Self {
        Self {
            index,
            test,
            verdict,
            problem: None,
            judgements,
            measured: None,
            others: Record::default(),
            ticks: 0,
            trace_hash: None,
        }
    }

    /// Makes the trial of a test that broke.
    pub fn broken(index: usize, test: Values, problem: Problem) -> Self {
        Self { problem: Some(problem), ..Self::judged(index, test, Verdict::Error, Vec::new()) }
    }

    /// Makes the trial of a simulated test, and returns it with its trace.
    pub fn simulated(index: usize, test: Values, outcome: Outcome) -> (Self, Option<Trace>) {
        let Outcome { ending, judgements, measured, trace } = outcome;
        let problem = Problem::of(&ending);
        let trial = Self { problem, measured, ..Self::judged(index, test, ending.verdict(), judgements) };
        let trial = trace.as_ref().into_iter().fold(trial, Self::traced);
        (trial, trace)
    }

    /// Adds the length and the hash of a trace to the trial.
    pub fn traced(self, trace: &Trace) -> Self {
        // The first sample is the start, before any tick has passed.
        Self { ticks: trace.len() - 1, trace_hash: Some(trace.hash()), ..self }
    }

    /// Returns the robustness of a requirement in its unit; `None` if it was not decided.
    pub fn robustness(&self, requirement: &str) -> Option<f64> {
        self.judgement(requirement)?.robustness
    }

    fn judgement(&self, requirement: &str) -> Option<&Judgement> {
        self.judgements.iter().find(|judgement| judgement.requirement == requirement)
    }

    /// Returns the ids of the requirements that the trial was judged by, in order; some may be undecided.
    pub fn requirements(&self) -> impl Iterator<Item = &str> {
        self.judgements.iter().map(|judgement| judgement.requirement.as_str())
    }

    /// Returns `true` if the trial violates this requirement. A robustness of 0 counts as a violation only in a failing
    /// trial in which no requirement has a negative robustness.
    pub fn violates(&self, requirement: &str) -> bool {
        let below = |id: &str| self.robustness(id).is_some_and(|robustness| robustness < 0.0);
        let is_zero = self.robustness(requirement) == Some(0.0);
        below(requirement) || is_zero && self.is_failure() && !self.requirements().any(below)
    }

    /// Returns the ids of the requirements that the trial violates, in order.
    pub fn violated(&self) -> impl Iterator<Item = &str> {
        self.requirements().filter(|id| self.violates(id))
    }

    /// Returns the time and the part of the formula at which a requirement is violated, as far as they are known.
    pub fn violation(&self, requirement: &str) -> Option<&Violation> {
        self.judgement(requirement)?.violation.as_ref()
    }

    /// Returns the contact of the ego vehicle with another object, if there was one.
    pub fn contact(&self) -> Option<&Contact> {
        self.measured.as_ref()?.contact.as_ref()
    }

    /// Returns `true` if the situation that the test is about occurred; `None` if it is not known.
    pub fn triggered(&self) -> Option<bool> {
        self.measured.as_ref().map(|measured| measured.triggered)
    }

    /// Returns all measurements as a flat list of names and metrics, in the order of the log.
    pub fn metrics(&self) -> Vec<(String, Metric)> {
        metric::flat(self)
    }

    /// Returns the reason why the test has no result, in words.
    pub fn error(&self) -> Option<&str> {
        self.problem.as_ref().map(|problem| problem.message.as_str())
    }

    /// Returns `true` if this trial repeats the result of a logged one. Logs of older versions do not state the kind of
    /// a problem, and have metrics that tests no longer have; these differences are ignored.
    pub fn repeats(&self, logged: &Self) -> bool {
        let mut logged = logged.clone();
        logged.others = logged.others.iter().filter(|(name, _)| !RETIRED.contains(name)).map(owned).collect();
        if let (Some(problem), Some(found)) = (&mut logged.problem, &self.problem)
            && problem.kind == ProblemKind::Unstated
        {
            problem.kind.clone_from(&found.kind);
        }
        *self == logged
    }

    /// Returns `true` if the trial violates a requirement.
    pub fn is_failure(&self) -> bool {
        self.verdict == Verdict::Fail
    }

    /// Returns `true` if the trial covers its place in the space. Trials with the verdict `error` or `invalid` do not.
    pub fn covers(&self) -> bool {
        !matches!(self.verdict, Verdict::Error | Verdict::Invalid)
    }
}

impl Problem {
    /// Returns the problem of a simulated run, if it has one.
    fn of(ending: &Ending) -> Option<Self> {
        let cause = match ending {
            Ending::Pass | Ending::Fail | Ending::Inconclusive => return None,
            Ending::Invalid(_) => ProblemKind::World,
            Ending::Error(Breakdown::Program(_)) => ProblemKind::Program,
            Ending::Error(Breakdown::World { .. }) => ProblemKind::State,
            Ending::Error(Breakdown::Driver { fault, .. }) => ProblemKind::of(fault.kind),
        };
        Some(Self::new(cause, ending.message().unwrap_or_default()))
    }
}
