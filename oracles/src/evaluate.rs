//! Evaluates formulas on a trace, and finds the part of a formula that determines its robustness.

use crate::core::{Core, CoreKind, Id, Sight};
use crate::offline::{Column, columns};
use crate::worth::Worth;
use crate::{Cause, Evaluation, EvaluationError, Formula, Semantics, Trace, dense};

impl Formula {
    /// Evaluates the formula at the beginning of the trace, in sampled or in dense time.
    ///
    /// # Errors
    /// The same errors as [`evaluate`](Self::evaluate). In dense time there is also an error if a comparison is not
    /// piecewise linear or if a sample is infinite. Time bounds between two samples are allowed in dense time.
    pub fn evaluate_in(&self, semantics: Semantics, trace: &Trace) -> Result<Evaluation, EvaluationError> {
        match semantics {
            Semantics::Sampled => self.evaluate(trace),
            Semantics::Dense if trace.is_empty() => Ok(Evaluation::UNKNOWN),
            Semantics::Dense => dense::evaluate(self, trace),
        }
    }

    /// Evaluates the formula at the beginning of the trace, in sampled time. The time is linear in the length of the
    /// trace, for any time bounds.
    ///
    /// On a trace without samples nothing is decided, and the robustness is NaN.
    ///
    /// # Errors
    /// The formula names a signal that the trace does not have, or has a time bound between two samples, or depends on
    /// a number that is NaN.
    pub fn evaluate(&self, trace: &Trace) -> Result<Evaluation, EvaluationError> {
        let (core, _) = Core::new(self, trace.signals(), trace.dt())?;
        if trace.is_empty() {
            return Ok(Evaluation::UNKNOWN);
        }
        let columns = columns(&core, trace, false)?;
        let [recorded, lower, upper] = columns[columns.len() - 1].first();
        Ok(Evaluation::new(recorded, lower, upper))
    }

    /// Finds the part of the formula and the time that determine the robustness of the formula on the trace, in sampled
    /// time. If there are several such parts, the result is the leftmost part, at the time nearest to the instant of
    /// its operator. The result is `None` if the trace is empty.
    ///
    /// # Errors
    /// The same errors as [`evaluate`](Self::evaluate).
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

    /// Finds the part of the formula and the time that determine the robustness of the formula on the trace, in sampled
    /// or in dense time. In sampled time the result is that of [`explain`](Self::explain).
    ///
    /// In dense time the robustness of the part equals that of the whole formula up to rounding. If two parts have
    /// this robustness, because two lines meet, the result is one of them. The search takes up to twice as long as the
    /// evaluation.
    ///
    /// # Errors
    /// The same errors as [`evaluate_in`](Self::evaluate_in).
    pub fn explain_in(&self, semantics: Semantics, trace: &Trace) -> Result<Option<Cause<'_>>, EvaluationError> {
        match semantics {
            Semantics::Sampled => self.explain(trace),
            Semantics::Dense if trace.is_empty() => Ok(None),
            Semantics::Dense => dense::explain(self, trace).map(Some),
        }
    }
}

/// Finds the operand, and its tick, from which a node takes its worth at a tick.
fn responsible(core: &Core, columns: &[Column], (id, tick): (Id, usize)) -> Option<(Id, usize)> {
    let dual = core.nodes[id].dual;
    let worth = columns[id].recorded[tick].flipped(dual);
    let of = |operand: Id, tick: usize| columns[operand].recorded[tick].flipped(dual);
    match core.nodes[id].kind {
        CoreKind::Atom(_) => None,
        CoreKind::Or(left, right) => {
            [left, right].into_iter().find(|operand| of(*operand, tick) == worth).map(|operand| (operand, tick))
        }
        CoreKind::Any { operand, start, sight } => {
            let mut seen = seen(tick, start, sight, columns[operand].recorded.len());
            seen.find(|at| of(operand, *at) == worth).map(|at| (operand, at))
        }
        CoreKind::Until { hold, goal, sight } => {
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

/// Returns the ticks that an operator sees from its own tick, the nearest first, in a column of `length` ticks.
fn seen(tick: usize, start: usize, sight: Sight, length: usize) -> Box<dyn Iterator<Item = usize>> {
    if sight.past {
        Box::new((start..=sight.end.min(tick)).map(move |back| tick - back))
    } else {
        Box::new(tick + start..(tick + sight.end + 1).min(length))
    }
}
