//! A trial in the form of a line of the log.

use super::metric::{UnknownWord, read};
use super::{Metric, Problem, ProblemKind, Trial};
use crate::json::Number;
use paracosm_engine::Judgement;
use paracosm_oracles::Verdict;
use paracosm_space::{Record, Values};
use serde::{Deserialize, Serialize};

/// The entries of a line, in their order.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the entries of a trial")]
pub(crate) struct Line {
    index: usize,
    test: Values,
    verdict: Verdict,
    robustness: Record<Number>,
    metrics: Record<Metric>,
    ticks: usize,
    trace_hash: Option<String>,
    error: Option<String>,
    /// The kind of the error; logs of older versions do not have it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    cause: Option<ProblemKind>,
    /// The hash of the study to which the test belongs; logs of older versions do not have it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    study: Option<String>,
}

impl Line {
    /// Makes the line of a trial in the log of a study with the given hash; `None` for a log that does not name it.
    pub(crate) fn of(trial: &Trial, study: Option<&str>) -> Self {
        Self { study: study.map(str::to_owned), ..trial.clone().into() }
    }

    /// Returns the index of the test.
    pub(crate) fn index(&self) -> usize {
        self.index
    }

    /// Returns the name of an entry that contradicts the verdict, and whether the entry is there: only a test without a
    /// result has an error.
    pub(crate) fn contradiction(&self) -> Option<(&'static str, bool)> {
        let has_no_result = matches!(self.verdict, Verdict::Invalid | Verdict::Error);
        if self.error.is_some() != has_no_result {
            return Some(("error", self.error.is_some()));
        }
        (self.cause.is_some() && !has_no_result).then_some(("cause", true))
    }

    /// Returns the hash of the study to which the test belongs, if the line has it.
    pub(crate) fn study(&self) -> Option<&str> {
        self.study.as_deref()
    }
}

impl From<Trial> for Line {
    fn from(trial: Trial) -> Self {
        let robustness = trial.judgements.iter();
        let robustness = robustness.map(|judgement| (judgement.requirement.clone(), Number(judgement.robustness)));
        let cause = trial.problem.as_ref().map(|problem| problem.kind.clone());
        Self {
            index: trial.index,
            verdict: trial.verdict,
            robustness: robustness.collect(),
            metrics: trial.metrics().into_iter().collect(),
            ticks: trial.ticks,
            // If the world cannot be built, the verdict already says so.
            cause: cause.filter(|cause| !matches!(cause, ProblemKind::World | ProblemKind::Unstated)),
            error: trial.problem.map(|problem| problem.message),
            test: trial.test,
            trace_hash: trial.trace_hash,
            study: None,
        }
    }
}

impl TryFrom<Line> for Trial {
    type Error = UnknownWord;

    fn try_from(line: Line) -> Result<Self, UnknownWord> {
        let judgement = |(requirement, number): (&str, &Number)| Judgement::new(requirement, number.0);
        let mut judgements: Vec<Judgement> = line.robustness.iter().map(judgement).collect();
        let (measured, others) = read(line.metrics, &mut judgements)?;
        let usual = if line.verdict == Verdict::Invalid { ProblemKind::World } else { ProblemKind::Unstated };
        let cause = line.cause.unwrap_or(usual);
        Ok(Self {
            index: line.index,
            test: line.test,
            verdict: line.verdict,
            problem: line.error.map(|message| Problem { kind: cause, message }),
            judgements,
            measured,
            others,
            ticks: line.ticks,
            trace_hash: line.trace_hash,
        })
    }
}
