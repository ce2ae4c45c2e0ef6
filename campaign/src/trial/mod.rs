//! One test with what became of it: a line of `trials.jsonl`.

mod line;
mod metric;

pub use metric::Metric;

use paracosm_engine::driver::FaultKind;
use paracosm_engine::{Breakdown, Contact, Ending, Judgement, Measurements, Outcome, Violation};
use paracosm_oracles::{Trace, Verdict};
use paracosm_space::{Record, Values};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A test with what became of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "line::Line", into = "line::Line")]
pub struct Trial {
    /// Its position in the campaign, from 0.
    pub index: usize,
    /// The values of the open parameters.
    pub test: Values,
    /// What became of it.
    pub verdict: Verdict,
    /// Why the verdict is `invalid` or `error`.
    pub problem: Option<Problem>,
    /// What became of each requirement, in the order in which they were judged.
    pub judgements: Vec<Judgement>,
    /// What was measured; `None` where there was no simulated run.
    pub measured: Option<Measurements>,
    /// Metrics of other versions of the software.
    others: Record<Metric>,
    /// The simulated ticks.
    pub ticks: usize,
    /// The fingerprint of its trace; `None` where there was none.
    pub trace_hash: Option<String>,
}

/// Why a test came to nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// What kind of problem it is.
    pub kind: ProblemKind,
    /// What happened, for people.
    pub message: String,
}

/// Metrics of older versions that no test has any more.
const RETIRED: [&str; 1] = ["ended_early"];

fn owned((name, metric): (&str, &Metric)) -> (String, Metric) {
    (name.to_owned(), metric.clone())
}

impl Problem {
    /// A problem of some kind, in words.
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
    /// Its world cannot be built; the verdict is `invalid`.
    World,
    /// The program cannot be run on such a test at all.
    Program,
    /// The world came to a state that is none.
    State,
    /// The run panicked.
    Panic,
    /// The driver cannot go on.
    Driver,
    /// The driver could not be shown what its cameras see.
    Camera,
    /// The system says itself that it cannot do the test.
    System,
    /// The system or the driver cannot be started, or its process is gone.
    Process,
    /// The system or the driver did not answer in time.
    TimedOut,
    /// The system or the driver answers what is no answer.
    Answer,
    /// The system was judged by other requirements than in earlier tests.
    Requirements,
    /// A formula does not fit the trace, and will fit no other trace of the same source.
    Misfit {
        /// The id of the requirement.
        requirement: String,
        /// The sample period in seconds, if the time bounds of the formula do not fit that.
        #[serde(skip_serializing_if = "Option::is_none", default)]
        period: Option<f64>,
    },
    /// A formula cannot be asked of this trace; it may fit another one.
    Unasked {
        /// The id of the requirement.
        requirement: String,
    },
    /// Nobody waited for the test any more.
    Interrupted,
    /// The log of an older version does not say.
    Unstated,
}

impl ProblemKind {
    /// The cause that a fault of a driver is.
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
    /// The trial of a test that was judged so, without a trace.
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

    /// The trial of a test that broke.
    pub fn broken(index: usize, test: Values, problem: Problem) -> Self {
        Self { problem: Some(problem), ..Self::judged(index, test, Verdict::Error, Vec::new()) }
    }

    /// The trial of a test that was simulated, and its trace.
    pub fn simulated(index: usize, test: Values, outcome: Outcome) -> (Self, Option<Trace>) {
        let Outcome { ending, judgements, measured, trace } = outcome;
        let problem = Problem::of(&ending);
        let trial = Self { problem, measured, ..Self::judged(index, test, ending.verdict(), judgements) };
        let trial = trace.as_ref().into_iter().fold(trial, Self::traced);
        (trial, trace)
    }

    /// The trial with a trace behind it.
    pub fn traced(self, trace: &Trace) -> Self {
        // The first sample is the start, before any tick has passed.
        Self { ticks: trace.len() - 1, trace_hash: Some(trace.hash()), ..self }
    }

    /// The robustness of a requirement in its unit; `None` where it was not decided.
    pub fn robustness(&self, requirement: &str) -> Option<f64> {
        self.judgement(requirement)?.robustness
    }

    fn judgement(&self, requirement: &str) -> Option<&Judgement> {
        self.judgements.iter().find(|judgement| judgement.requirement == requirement)
    }

    /// The ids of the requirements that it was judged by, in order; some may be undecided.
    pub fn requirements(&self) -> impl Iterator<Item = &str> {
        self.judgements.iter().map(|judgement| judgement.requirement.as_str())
    }

    /// Whether it violates this requirement. A robustness of 0 says so of a failure that no other requirement explains.
    pub fn violates(&self, requirement: &str) -> bool {
        let below = |id: &str| self.robustness(id).is_some_and(|robustness| robustness < 0.0);
        let is_zero = self.robustness(requirement) == Some(0.0);
        below(requirement) || is_zero && self.is_failure() && !self.requirements().any(below)
    }

    /// The ids of the requirements that it violates, in order.
    pub fn violated(&self) -> impl Iterator<Item = &str> {
        self.requirements().filter(|id| self.violates(id))
    }

    /// When and by which part of its formula a requirement is violated, as far as that is known.
    pub fn violation(&self, requirement: &str) -> Option<&Violation> {
        self.judgement(requirement)?.violation.as_ref()
    }

    /// What the car under test touched.
    pub fn contact(&self) -> Option<&Contact> {
        self.measured.as_ref()?.contact.as_ref()
    }

    /// Whether the situation that the test is about came about; `None` where nobody says.
    pub fn triggered(&self) -> Option<bool> {
        self.measured.as_ref().map(|measured| measured.triggered)
    }

    /// Everything that was measured as a flat list of names and metrics, in the order in which the log has it.
    pub fn metrics(&self) -> Vec<(String, Metric)> {
        metric::flat(self)
    }

    /// Why it came to nothing, in words.
    pub fn error(&self) -> Option<&str> {
        self.problem.as_ref().map(|problem| problem.message.as_str())
    }

    /// Whether a test that was logged so has come to the same again. Logs of older versions do not say of what kind a problem
    /// is, and have metrics that no test has any more.
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

    /// Whether it violates a requirement.
    pub fn is_failure(&self) -> bool {
        self.verdict == Verdict::Fail
    }

    /// Whether it says anything of the place where it is: broken and impossible tests cover nothing.
    pub fn covers(&self) -> bool {
        !matches!(self.verdict, Verdict::Error | Verdict::Invalid)
    }
}

impl Problem {
    /// Why a simulated run came to nothing, if it did.
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
