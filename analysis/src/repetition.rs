//! Repetitions: they compare a campaign with a later run of the same study, test by test.
//!
//! Others can trust the numbers of a campaign if they get the same numbers. So a repetition asks for the same test, verdict, robustness and
//! trace at each index.

use paracosm_campaign::{Log, Trial};
use serde::Serialize;

/// The comparison of a campaign with a later run of its study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Repetition {
    /// The number of tests that both have.
    pub tests: usize,
    /// The number of tests that are the same in both, with the same result and the same trace.
    pub same: usize,
    /// The tests that differ, in the order of their indices.
    pub differing: Vec<Differing>,
    /// The numbers of tests that only the campaign has, and that only the later run has.
    pub only: [usize; 2],
}

/// A test that differs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Differing {
    /// The index of the test.
    pub index: usize,
    /// The first difference: of the values, the verdict, the robustness, the trace, or another result.
    pub what: What,
    /// The verdicts in the campaign and in the later run.
    pub verdicts: [String; 2],
}

/// A kind of difference between two runs of a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum What {
    /// The values of the parameters.
    Test,
    /// The verdict.
    Verdict,
    /// The judgement of a requirement.
    Robustness,
    /// The trace of the signals.
    Trace,
    /// A measurement, a metric or a message.
    Measurement,
}

impl What {
    /// Returns the name in words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Test => "values",
            Self::Verdict => "verdict",
            Self::Robustness => "robustness",
            Self::Trace => "trace",
            Self::Measurement => "measurement",
        }
    }

    /// Returns what differs first; `None` if the trials are the same.
    fn of(one: &Trial, other: &Trial) -> Option<Self> {
        let differences = [
            (Self::Test, one.test != other.test),
            (Self::Verdict, one.verdict != other.verdict),
            (Self::Robustness, one.judgements != other.judgements),
            (Self::Trace, one.trace_hash != other.trace_hash),
            (Self::Measurement, one != other),
        ];
        differences.into_iter().find_map(|(what, differs)| differs.then_some(what))
    }
}

impl Repetition {
    /// Compares the log of a campaign with the log of a later run.
    pub fn of(campaign: &Log, later: &Log) -> Self {
        let [first, second] = [campaign, later].map(Log::trials);
        let pairs = first.iter().zip(second);
        let tests = pairs.len();
        let differing: Vec<Differing> = pairs
            .filter_map(|(one, other)| {
                let what = What::of(one, other)?;
                let verdicts = [one, other].map(|trial| trial.verdict.to_string());
                Some(Differing { index: one.index, what, verdicts })
            })
            .collect();
        let only = [first, second].map(|trials| trials.len() - tests);
        Self { tests, same: tests - differing.len(), differing, only }
    }

    /// Returns `true` if both have the same tests with the same results.
    pub fn is_exact(&self) -> bool {
        self.differing.is_empty() && self.only == [0, 0]
    }
}
