//! Evaluates a formula on a recorded trace. The time is linear in the length of the trace, for any time bounds.
//!
//! Each node gets a column of worths, operands first, for all ticks on which the formula's first tick depends. An
//! operator of the past is an operator of the future on reversed columns. The samples beyond the end of the trace
//! influence only the last ticks of a column, as far as the operators look ahead. For these ticks the worst and the
//! best possible worth are computed, too.

use crate::core::{Beyond, Core, CoreKind, Node, Sight};
use crate::fold::{Clamp, Fold, windows};
use crate::worth::Worth;
use crate::{EvaluationError, Trace};

/// The assumptions about the samples beyond the end.
const OPEN: [Beyond; 2] = [Beyond::Worst, Beyond::Best];

/// The worth of a node at each of its ticks.
#[derive(Debug, Clone, Default)]
pub(crate) struct Column {
    /// The robustness of the node at each tick, for the recorded samples only.
    pub recorded: Vec<Worth>,
    /// The first tick that depends on samples beyond the end of the trace.
    settled: usize,
    /// The worst and the best possible worth, from the tick `settled` on.
    open: [Vec<Worth>; 2],
}

impl Column {
    fn settled(recorded: Vec<Worth>) -> Self {
        Self { settled: recorded.len(), recorded, open: Default::default() }
    }

    /// Returns the worst or best worths of the ticks from `from` to before `to`.
    fn at(&self, side: usize, from: usize, to: usize) -> Vec<Worth> {
        let mut ticks = Vec::with_capacity(to - from);
        ticks.extend_from_slice(&self.recorded[from.min(self.settled)..to.min(self.settled)]);
        let open = |tick: usize| tick.max(self.settled) - self.settled;
        ticks.extend_from_slice(&self.open[side][open(from)..open(to)]);
        ticks
    }

    /// Returns the robustness at the first tick for the recorded samples, for the worst continuation and for the best
    /// continuation.
    pub fn first(&self) -> [Worth; 3] {
        let recorded = self.recorded[0];
        let open = |side: usize| if self.settled > 0 { recorded } else { self.open[side][0] };
        [recorded, open(0), open(1)]
    }
}

/// Computes the columns of all nodes, on a trace with samples. A column is emptied when no node needs it any more,
/// unless `kept` is true.
pub(crate) fn columns(core: &Core, trace: &Trace, kept: bool) -> Result<Vec<Column>, EvaluationError> {
    let mut columns: Vec<Column> = Vec::with_capacity(core.nodes.len());
    let mut users = vec![usize::from(kept); core.nodes.len()];
    core.nodes.iter().flat_map(Node::operands).for_each(|operand| users[operand] += 1);
    for (node, ticks) in core.nodes.iter().zip(core.needed(trace.len())) {
        let mut operand = |id: usize| {
            users[id] -= 1;
            if users[id] == 0 { std::mem::take(&mut columns[id]) } else { columns[id].clone() }
        };
        let column = match &node.kind {
            CoreKind::Atom(atom) => Column::settled(atom.column(trace.rows().take(ticks), trace.dt())?),
            CoreKind::Or(left, right) => or([operand(*left), operand(*right)], ticks, node.dual),
            CoreKind::Any { operand: id, start, sight } => {
                let scope = Scope { node, sight: *sight, complete: trace.is_complete(), ticks };
                scope.temporal([operand(*id)], |[column], ticks, outside| {
                    any(column, ticks, *start, *sight, node.dual, outside)
                })
            }
            CoreKind::Until { hold, goal, sight } => {
                let scope = Scope { node, sight: *sight, complete: trace.is_complete(), ticks };
                scope.temporal([operand(*hold), operand(*goal)], |[hold, goal], ticks, outside| {
                    until(hold, goal, ticks, *sight, node.dual, outside)
                })
            }
        };
        columns.push(column);
    }
    Ok(columns)
}

fn or([left, right]: [Column; 2], ticks: usize, dual: bool) -> Column {
    let join = |mut left: Vec<Worth>, right: &[Worth]| {
        left.truncate(ticks);
        let pairs = left.iter_mut().zip(right);
        if dual {
            pairs.for_each(|(worth, other)| *worth = (*worth).min(*other));
        } else {
            pairs.for_each(|(worth, other)| *worth = (*worth).max(*other));
        }
        left
    };
    let settled = left.settled.min(right.settled).min(ticks);
    let open = [0, 1].map(|side| join(left.at(side, settled, ticks), &right.at(side, settled, ticks)));
    Column { recorded: join(left.recorded, &right.recorded), settled, open }
}

/// A temporal operator on a trace, for a number of ticks.
struct Scope<'a> {
    node: &'a Node,
    sight: Sight,
    complete: bool,
    ticks: usize,
}

impl Scope<'_> {
    /// Computes the column of an operator. `apply` computes it from columns of the operands, for a number of ticks,
    /// with the worth beyond their end.
    fn temporal<const N: usize>(
        &self,
        operands: [Column; N],
        apply: impl Fn([Vec<Worth>; N], usize, Option<Worth>) -> Vec<Worth>,
    ) -> Column {
        let Self { node, sight, complete, ticks } = *self;
        let length = operands.iter().map(|column| column.recorded.len()).min().expect("it has an operand");
        let known = operands.iter().map(|column| column.settled).min().expect("it has an operand").min(length);
        let settled = if sight.past {
            known.min(ticks)
        } else if known == length && sight.endless && complete {
            ticks
        } else {
            known.saturating_sub(sight.end).min(ticks)
        };
        let open = [0, 1].map(|side| {
            if settled == ticks {
                return Vec::new();
            }
            let base = if sight.past { 0 } else { settled };
            let values = operands.each_ref().map(|column| column.at(side, base, length));
            let mut open = apply(values, ticks - base, OPEN[side].operand(node, sight, complete));
            open.drain(..settled - base);
            open
        });
        let values = operands.map(|column| column.recorded);
        Column { recorded: apply(values, ticks, Beyond::Nothing.operand(node, sight, complete)), settled, open }
    }
}

/// Returns the greatest worth in `column` from `start` to the end of sight, for each of the first `ticks` ticks.
/// Beyond the column the worth is `outside`.
fn any(
    mut column: Vec<Worth>,
    ticks: usize,
    start: usize,
    sight: Sight,
    dual: bool,
    outside: Option<Worth>,
) -> Vec<Worth> {
    if sight.past {
        column.truncate(ticks);
        column.reverse();
    }
    column.drain(..start.min(column.len()));
    let outside = outside.unwrap_or(Worth::NEUTRAL);
    column.iter_mut().for_each(|worth| *worth = worth.flipped(dual));
    windows(&mut column, sight.end - start, outside);
    column.resize(ticks, outside);
    column.iter_mut().for_each(|worth| *worth = worth.flipped(dual));
    if sight.past {
        column.reverse();
    }
    column
}

/// Returns the worth of `until` on two columns, for each of the first `ticks` ticks.
fn until(
    mut hold: Vec<Worth>,
    mut goal: Vec<Worth>,
    ticks: usize,
    sight: Sight,
    dual: bool,
    outside: Option<Worth>,
) -> Vec<Worth> {
    if sight.past {
        hold.truncate(ticks);
        goal.truncate(ticks);
        hold.reverse();
        goal.reverse();
    }
    let step = |(hold, goal): (&Worth, &Worth)| Clamp { hold: hold.flipped(dual), goal: goal.flipped(dual) };
    let mut steps: Vec<Clamp> = hold.iter().zip(&goal).map(step).collect();
    let outside = outside.map_or(Clamp::NEUTRAL, |worth| Clamp { hold: worth, goal: worth });
    windows(&mut steps, sight.end, outside);
    steps.resize(ticks, outside);
    goal.clear();
    goal.extend(steps.iter().map(|step| step.goal.flipped(dual)));
    if sight.past {
        goal.reverse();
    }
    goal
}
