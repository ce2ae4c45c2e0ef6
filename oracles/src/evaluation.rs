//! What a formula is worth on a trace, and why.

use crate::core::{Core, Id, Kind, Sight};
use crate::offline::{Column, columns};
use crate::worth::{Worth, truth};
use crate::{EvaluationError, Formula, Trace, Truth, dense};
use serde::{Deserialize, Serialize};

/// What a trace says of the time between its samples.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Semantics {
    /// Nothing: formulas speak of the samples.
    #[default]
    Sampled,
    /// Signals are straight lines from sample to sample, and formulas speak of every instant. A robustness of 0 is left
    /// undecided. Windows are closed as they are written, to the instant: where a robustness jumps, because an operator
    /// comes to see the first instant of the trace or loses sight of the last one, it has a value at that very instant
    /// beside the limits from before and after it.
    Dense,
}

/// What a formula is worth at the beginning of a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// Whether it holds.
    pub truth: Truth,
    /// How far it is from the other answer, judging by what was recorded.
    pub robustness: f64,
    /// The least that this could have become, had the trace gone on in the worst way.
    pub lower: f64,
    /// The most, had it gone on in the best way.
    pub upper: f64,
}

impl Evaluation {
    /// What is known before anything was recorded.
    pub(crate) const UNKNOWN: Self =
        Self { truth: Truth::Undecided, robustness: f64::NAN, lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    pub(crate) fn new(recorded: Worth, lower: Worth, upper: Worth) -> Self {
        Self {
            truth: truth(lower, upper),
            robustness: recorded.robustness(),
            lower: lower.robustness(),
            upper: upper.robustness(),
        }
    }
}

/// What the robustness of a formula comes down to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cause<'f> {
    /// The critical time in seconds.
    pub time: f64,
    /// The sub-formula whose worth at that time is, up to its sign, that of the whole: a comparison, or a temporal
    /// operator within whose bounds nothing was recorded.
    pub part: &'f Formula,
    /// The robustness of the whole.
    pub robustness: f64,
}

impl Formula {
    /// What the formula is worth at the beginning of the trace, by its samples or between them.
    ///
    /// # Errors
    /// As for [`evaluate`](Self::evaluate); in dense time also if a comparison is not piecewise linear or a sample is
    /// infinite, while time bounds may be any.
    pub fn evaluate_in(&self, semantics: Semantics, trace: &Trace) -> Result<Evaluation, EvaluationError> {
        match semantics {
            Semantics::Sampled => self.evaluate(trace),
            Semantics::Dense if trace.is_empty() => Ok(Evaluation::UNKNOWN),
            Semantics::Dense => dense::evaluate(self, trace),
        }
    }

    /// What the formula is worth at the beginning of the trace, in time linear in the trace whatever the time bounds.
    ///
    /// On a trace without a sample nothing is decided, and the robustness is NaN.
    ///
    /// # Errors
    /// The formula names a signal that the trace does not have, or has a time bound between two samples; or a number
    /// that it depends on is NaN.
    pub fn evaluate(&self, trace: &Trace) -> Result<Evaluation, EvaluationError> {
        let (core, _) = Core::new(self, trace.signals(), trace.dt())?;
        if trace.is_empty() {
            return Ok(Evaluation::UNKNOWN);
        }
        let columns = columns(&core, trace, false)?;
        let [recorded, lower, upper] = columns[columns.len() - 1].first();
        Ok(Evaluation::new(recorded, lower, upper))
    }

    /// Which part of the formula, at which time, its robustness on this trace comes down to; if there are several, the
    /// leftmost and the one nearest to where its operator stands. Nothing on a trace without a sample.
    ///
    /// # Errors
    /// As for [`evaluate`](Self::evaluate).
    pub fn explain(&self, trace: &Trace) -> Result<Option<Cause<'_>>, EvaluationError> {
        let (core, parts) = Core::new(self, trace.signals(), trace.dt())?;
        if trace.is_empty() {
            return Ok(None);
        }
        let columns = columns(&core, trace, true)?;
        let mut at = (columns.len() - 1, 0);
        while let Some(next) = responsible(&core, &columns, at) {
            at = next;
        }
        let robustness = columns[columns.len() - 1].recorded[0].robustness();
        Ok(Some(Cause { time: at.1 as f64 * trace.dt(), part: parts[at.0], robustness }))
    }

    /// The same by the samples or between them. In dense time the part is worth at that time what the whole is but for
    /// rounding, and where two are, as lines meet, it is one of them. It takes up to twice as long as the evaluation.
    ///
    /// # Errors
    /// As for [`evaluate_in`](Self::evaluate_in).
    pub fn explain_in(&self, semantics: Semantics, trace: &Trace) -> Result<Option<Cause<'_>>, EvaluationError> {
        match semantics {
            Semantics::Sampled => self.explain(trace),
            Semantics::Dense if trace.is_empty() => Ok(None),
            Semantics::Dense => dense::explain(self, trace).map(Some),
        }
    }
}

/// The operand, and the tick of it, that the worth of a node at a tick is taken from.
fn responsible(core: &Core, columns: &[Column], (id, tick): (Id, usize)) -> Option<(Id, usize)> {
    let dual = core.nodes[id].dual;
    let worth = columns[id].recorded[tick].flipped(dual);
    let of = |operand: Id, tick: usize| columns[operand].recorded[tick].flipped(dual);
    match core.nodes[id].kind {
        Kind::Atom(_) => None,
        Kind::Or(left, right) => {
            [left, right].into_iter().find(|operand| of(*operand, tick) == worth).map(|operand| (operand, tick))
        }
        Kind::Any { operand, start, sight } => {
            let mut seen = seen(tick, start, sight, columns[operand].recorded.len());
            seen.find(|at| of(operand, *at) == worth).map(|at| (operand, at))
        }
        Kind::Until { hold, goal, sight } => {
            let length = columns[hold].recorded.len().min(columns[goal].recorded.len());
            let mut weakest = (Worth::BEST, tick);
            for at in seen(tick, 0, sight, length) {
                let reached = of(goal, at);
                if reached.min(weakest.0) == worth {
                    return Some(if reached == worth { (goal, at) } else { (hold, weakest.1) });
                }
                weakest = weakest.min((of(hold, at), at));
            }
            None
        }
    }
}

/// The ticks that an operator sees from where it stands, going away from there, in a column of so many ticks.
fn seen(tick: usize, start: usize, sight: Sight, length: usize) -> Box<dyn Iterator<Item = usize>> {
    if sight.past {
        Box::new((start..=sight.end.min(tick)).map(move |back| tick - back))
    } else {
        Box::new(tick + start..(tick + sight.end + 1).min(length))
    }
}
