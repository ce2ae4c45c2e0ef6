//! One test with what became of it: a line of `trials.jsonl`.

use crate::json::{MetricValue, Number};
use paracosm_coverage::{Record, Values};
use paracosm_engine::{Metric, Outcome};
use paracosm_oracles::{Trace, Verdict};
use serde::{Deserialize, Serialize};

/// A test with what became of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trial {
    /// Its position in the campaign, from 0.
    pub index: usize,
    /// The values of the open parameters.
    pub test: Values,
    /// What became of it.
    pub verdict: Verdict,
    robustness: Record<Number>,
    metrics: Record<MetricValue>,
    /// The simulated ticks.
    pub ticks: usize,
    /// The fingerprint of its trace; `None` where there was none.
    pub trace_hash: Option<String>,
    /// Why the verdict is `invalid` or `error`.
    pub error: Option<String>,
}

impl Trial {
    /// The trial of a test that ended so.
    pub(crate) fn new(index: usize, test: Values, outcome: Outcome, trace: Option<&Trace>) -> Self {
        let robustness = outcome.robustness.into_iter().map(|(id, value)| (id, Number(value)));
        let metrics = outcome.metrics.into_iter().map(|(name, metric)| (name, MetricValue(metric)));
        Self {
            index,
            test,
            verdict: outcome.verdict,
            robustness: robustness.collect(),
            metrics: metrics.collect(),
            // The first sample is the start, before any tick has passed.
            ticks: trace.map_or(0, |trace| trace.len() - 1),
            trace_hash: trace.map(Trace::hash),
            error: outcome.error,
        }
    }

    /// The robustness of a requirement in its unit; `None` where it was not decided.
    pub fn robustness(&self, requirement: &str) -> Option<f64> {
        self.robustness.get(requirement).and_then(|number| number.0)
    }

    /// The ids of the requirements that it was judged by, in order; some may be undecided.
    pub fn requirements(&self) -> impl Iterator<Item = &str> {
        self.robustness.iter().map(|(id, _)| id)
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

    /// What a violated requirement comes down to: the critical time in seconds and the part of its formula that is
    /// responsible, as far as they are known.
    pub fn cause(&self, requirement: &str) -> Option<(f64, &str)> {
        match [
            self.metric(&format!("critical_time.{requirement}")),
            self.metric(&format!("critical_part.{requirement}")),
        ] {
            [Some(Metric::Number(time)), Some(Metric::Word(Some(part)))] => Some((*time, part)),
            _ => None,
        }
    }

    /// What was measured under that name.
    pub fn metric(&self, name: &str) -> Option<&Metric> {
        self.metrics.get(name).map(|value| &value.0)
    }

    /// The names of what was measured, in order.
    pub fn metric_names(&self) -> impl Iterator<Item = &str> {
        self.metrics.iter().map(|(name, _)| name)
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
