//! Trials: a test with its result, which is a line of `trials.jsonl`.

mod line;
mod metric;

pub(crate) use line::Line;
pub use metric::{Metric, UnknownWord};

use paracosm_engine::driver::FaultKind;
use paracosm_engine::stream::GivenUp;
use paracosm_engine::{Breakdown, Contact, Ending, Judgement, Measurements, Outcome, Violation, panic_message};
use paracosm_oracles::{Trace, Verdict};
use paracosm_space::{Record, Values};
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::fmt;
use std::time::Duration;

/// A test of a campaign, with the result of the test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "line::Line", into = "line::Line")]
pub struct Trial {
    /// The position of the test in the campaign, from 0.
    pub index: usize,
    /// The values of the open parameters in the test.
    pub test: Values,
    /// The verdict on the test, for example pass or fail.
    pub verdict: Verdict,
    /// The reason for the verdict `invalid` or `error`; `None` for all other verdicts.
    pub problem: Option<Problem>,
    /// The judgement of each requirement, in the order in which the requirements were judged.
    pub judgements: Vec<Judgement>,
    /// The measurements of the simulated run; `None` if the test was not simulated.
    pub measured: Option<Measurements>,
    /// Metrics of a perceiver, and metrics of other versions of the software.
    others: Record<Metric>,
    /// The number of ticks of the trace; 0 if the trial has no trace.
    pub ticks: usize,
    /// The hash of the trace; `None` if the trial has no trace.
    pub trace_hash: Option<String>,
}

/// The reason why a test has no result.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The kind of the problem.
    pub kind: ProblemKind,
    /// The description of the problem in words.
    pub message: String,
}

/// Metrics of older versions that tests no longer have.
const RETIRED: [&str; 1] = ["ended_early"];

fn owned((name, metric): (&str, &Metric)) -> (String, Metric) {
    (name.to_owned(), metric.clone())
}

impl Problem {
    /// Makes a problem of the given kind with a description.
    pub fn new(kind: ProblemKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }

    /// Makes the problem that the run or the perceiver panicked, or that a function of a stream gave up.
    pub(crate) fn panicked(who: &str, panic: &(dyn Any + Send)) -> Self {
        let message = match panic.downcast_ref() {
            Some(GivenUp(reason)) => reason.clone(),
            None => format!("the {who} panicked: {}", panic_message(panic)),
        };
        Self::new(ProblemKind::Panic, message)
    }

    /// Makes the problem that a system did not answer in time.
    pub(crate) fn timed_out(timeout: Duration) -> Self {
        Self::new(ProblemKind::TimedOut, format!("no answer within {} s", timeout.as_secs_f64()))
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Problem {}

/// The kind of a problem that leaves a test without a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProblemKind {
    /// The world of the test cannot be built; the verdict is `invalid`.
    World,
    /// The program of the scenario cannot run the test.
    Program,
    /// The simulated world reached an impossible state.
    State,
    /// The run of the test ended in a panic.
    Panic,
    /// The driver reported a fault, or could not be made.
    Driver,
    /// The driver did not get the images of its cameras.
    Camera,
    /// The external system reported that it cannot run the test.
    System,
    /// The system or the driver cannot be started, or the process has ended.
    Process,
    /// The system or the driver did not answer in time.
    TimedOut,
    /// The system or the driver gave an invalid answer.
    Answer,
    /// The external system judged different requirements than in its first answer.
    Requirements,
    /// A formula cannot judge any trace of the system or the scenario.
    Misfit {
        /// The id of the requirement.
        requirement: String,
        /// The sample period in seconds, if the time bounds of the formula do not fit the period.
        #[serde(skip_serializing_if = "Option::is_none", default)]
        period: Option<f64>,
    },
    /// A formula cannot judge the trace of the test, but may judge the traces of other tests.
    Unasked {
        /// The id of the requirement.
        requirement: String,
    },
    /// The campaign was stopped before the test ended.
    Interrupted,
    /// The kind is not known, because an older version of the software wrote the log.
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
    /// Makes the trial of a test with the given verdict and judgements, without a trace.
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

    /// Makes the trial of a test that has no result because of a problem.
    pub fn broken(index: usize, test: Values, problem: Problem) -> Self {
        Self { problem: Some(problem), ..Self::judged(index, test, Verdict::Error, Vec::new()) }
    }

    /// Makes the trial of a simulated test, and returns the trial with the trace.
    pub fn simulated(index: usize, test: Values, outcome: Outcome) -> (Self, Option<Trace>) {
        let Outcome { ending, judgements, measured, trace } = outcome;
        let problem = Problem::of(&ending);
        let trial = Self { problem, measured, ..Self::judged(index, test, ending.verdict(), judgements) };
        let trial = trace.as_ref().into_iter().fold(trial, Self::traced);
        (trial, trace)
    }

    /// Adds metrics to the trial.
    #[cfg(feature = "camera")]
    pub(crate) fn with_metrics(mut self, metrics: impl IntoIterator<Item = (String, Metric)>) -> Self {
        self.others = self.others.iter().map(owned).chain(metrics).collect();
        self
    }

    /// Adds the length and the hash of a trace to the trial.
    pub fn traced(self, trace: &Trace) -> Self {
        // The first sample is the start, before any tick has passed.
        Self { ticks: trace.len() - 1, trace_hash: Some(trace.hash()), ..self }
    }

    /// Appends the trial to trials that are kept in memory. The trial shares the names of parameters and requirements
    /// with the last of them, and takes no memory that no value needs.
    pub fn append_to(mut self, kept: &mut Vec<Self>) {
        if let Some(last) = kept.last() {
            self.share_names(last);
        }
        kept.push(self);
    }

    fn share_names(&mut self, other: &Self) {
        self.test.share_names(&other.test);
        for (judgement, others) in self.judgements.iter_mut().zip(&other.judgements) {
            if judgement.requirement == others.requirement {
                judgement.requirement.clone_from(&others.requirement);
            }
        }
        self.judgements.shrink_to_fit();
    }

    /// Returns the robustness of a requirement in the requirement's unit; `None` if the requirement was not decided.
    pub fn robustness(&self, requirement: &str) -> Option<f64> {
        self.judgement(requirement)?.robustness
    }

    fn judgement(&self, requirement: &str) -> Option<&Judgement> {
        self.judgements.iter().find(|judgement| *judgement.requirement == *requirement)
    }

    /// Returns the ids of all requirements by which the trial was judged, in the order of the judgements. Some
    /// requirements may be undecided.
    pub fn requirements(&self) -> impl Iterator<Item = &str> {
        self.judgements.iter().map(|judgement| &*judgement.requirement)
    }

    /// Returns the id and the robustness of each requirement that was decided, in the order of the judgements.
    pub fn decided(&self) -> impl Iterator<Item = (&str, f64)> {
        self.judgements.iter().filter_map(|judgement| Some((&*judgement.requirement, judgement.robustness?)))
    }

    /// Returns `true` if the trial violates the requirement with the given id. A robustness of 0 counts as a violation
    /// only in a failing trial in which no requirement has a negative robustness.
    pub fn violates(&self, requirement: &str) -> bool {
        let below = |id: &str| self.robustness(id).is_some_and(|robustness| robustness < 0.0);
        let is_zero = self.robustness(requirement) == Some(0.0);
        below(requirement) || is_zero && self.breaks_a_requirement() && !self.requirements().any(below)
    }

    /// Returns the ids of the requirements that the trial violates, in the order of the judgements.
    pub fn violated(&self) -> impl Iterator<Item = &str> {
        self.requirements().filter(|id| self.violates(id))
    }

    /// Returns the violation of a requirement, with the time and the violated part of the formula; `None` if not known.
    pub fn violation(&self, requirement: &str) -> Option<&Violation> {
        self.judgement(requirement)?.violation.as_deref()
    }

    /// Returns the contact of the ego vehicle with an object; `None` if no contact occurred.
    pub fn contact(&self) -> Option<&Contact> {
        self.measured.as_ref()?.contact.as_ref()
    }

    /// Returns `true` if the situation that the test is about occurred; `None` if the trial has no measurements.
    pub fn triggered(&self) -> Option<bool> {
        self.measured.as_ref().map(|measured| measured.triggered)
    }

    /// Returns all measurements as a flat list of names and metrics, in the order of the log.
    pub fn metrics(&self) -> Vec<(String, Metric)> {
        metric::flat(self)
    }

    /// Returns the reason why the test has no result, in words; `None` if the test has a result.
    pub fn error(&self) -> Option<&str> {
        self.problem.as_ref().map(|problem| problem.message.as_str())
    }

    /// Returns `true` if the trial has the same result as a logged trial of the same test. Logs of older versions do
    /// not state the kind of a problem, and have metrics that tests no longer have; these differences are ignored.
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

    /// Returns `true` if the trial violates a requirement, unless no reference driver avoids the violation.
    pub fn is_failure(&self) -> bool {
        self.verdict == Verdict::Fail
    }

    fn breaks_a_requirement(&self) -> bool {
        matches!(self.verdict, Verdict::Fail | Verdict::Unpreventable)
    }

    /// Returns `true` if the driver of this trial prevents the failure of another trial of the same test: this trial
    /// satisfies every requirement that the other trial violates, and violates no requirement that the other trial
    /// satisfies. Returns `None` if this trial has no result.
    pub fn prevents(&self, failing: &Self) -> Option<bool> {
        let holds = |trial: &Self, id: &str| trial.robustness(id).is_some() && !trial.violates(id);
        self.covers()
            .then(|| failing.violated().all(|id| holds(self, id)) && !self.violated().any(|id| holds(failing, id)))
    }

    /// Returns `true` if the test counts for coverage, because the verdict is neither `error` nor `invalid`.
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
