//! What a formula is worth on a recorded trace, in time linear in the trace whatever the bounds.
//!
//! Node by node, operands first, a column of worths is made for as many ticks as the formula's first tick depends on.
//! An operator of the past is one of the future on reversed columns.

use crate::core::{Beyond, Core, Kind, Node, Sight};
use crate::fold::{Clamp, Fold, Reversed, Window};
use crate::worth::Worth;
use crate::{EvaluationError, Trace};

/// The columns of a trace's evaluation.
pub(crate) struct Columns<'a> {
    core: &'a Core,
    trace: &'a Trace,
    needed: Vec<usize>,
}

impl<'a> Columns<'a> {
    pub fn new(core: &'a Core, trace: &'a Trace) -> Self {
        Self { core, trace, needed: core.needed(trace.len()) }
    }

    /// Whether nothing beyond the end of the trace is asked for.
    pub fn is_exact(&self) -> bool {
        let within = |(node, needed): (&Node, &usize)| match node.kind {
            Kind::Atom(_) | Kind::Or(..) => true,
            Kind::Any { sight, .. } | Kind::Until { sight, .. } => {
                let known = sight.past || (sight.endless && self.trace.is_complete());
                known || needed + sight.end <= self.trace.len()
            }
        };
        self.core.nodes.iter().zip(&self.needed).all(within)
    }

    /// What the formula is worth at the first tick.
    pub fn root(&self, beyond: Beyond) -> Result<Worth, EvaluationError> {
        let mut users = vec![0; self.core.nodes.len()];
        for node in &self.core.nodes {
            match node.kind {
                Kind::Atom(_) => {}
                Kind::Any { operand, .. } => users[operand] += 1,
                Kind::Or(left, right) | Kind::Until { hold: left, goal: right, .. } => {
                    users[left] += 1;
                    users[right] += 1;
                }
            }
        }
        let mut columns: Vec<Vec<Worth>> = Vec::with_capacity(users.len());
        for (id, node) in self.core.nodes.iter().enumerate() {
            let mut take = |columns: &mut Vec<Vec<Worth>>, operand: usize| {
                users[operand] -= 1;
                if users[operand] == 0 { std::mem::take(&mut columns[operand]) } else { columns[operand].clone() }
            };
            let column = self.column(id, node, beyond, |operand| take(&mut columns, operand))?;
            columns.push(column);
        }
        Ok(columns[columns.len() - 1][0])
    }

    /// All columns, of which the last is the formula's.
    pub fn all(&self, beyond: Beyond) -> Result<Vec<Vec<Worth>>, EvaluationError> {
        let mut columns: Vec<Vec<Worth>> = Vec::new();
        for (id, node) in self.core.nodes.iter().enumerate() {
            let column = self.column(id, node, beyond, |operand| columns[operand].clone())?;
            columns.push(column);
        }
        Ok(columns)
    }

    fn column(
        &self,
        id: usize,
        node: &Node,
        beyond: Beyond,
        mut operand: impl FnMut(usize) -> Vec<Worth>,
    ) -> Result<Vec<Worth>, EvaluationError> {
        let ticks = self.needed[id];
        let complete = self.trace.is_complete();
        let outside = |sight| beyond.operand(node, sight, complete);
        Ok(match &node.kind {
            Kind::Atom(atom) => atom.column(self.trace.rows().take(ticks), self.trace.dt())?,
            Kind::Or(left, right) => {
                let mut column = operand(*left);
                column.truncate(ticks);
                for (worth, other) in column.iter_mut().zip(operand(*right)) {
                    *worth = if node.dual { (*worth).min(other) } else { (*worth).max(other) };
                }
                column
            }
            Kind::Any { operand: id, start, sight } => {
                any(operand(*id), ticks, *start, *sight, node.dual, outside(*sight))
            }
            Kind::Until { hold, goal, sight } => {
                until(operand(*hold), operand(*goal), ticks, *sight, node.dual, outside(*sight))
            }
        })
    }
}

/// The greatest of `column` from `start` to the end of sight, at each of the first so many ticks; beyond the column it
/// is `outside`.
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
    let span = sight.end - start;
    if span < column.len() {
        let mut window = Window::new(span + 1, outside);
        for worth in column.iter_mut().rev() {
            *worth = window.push(worth.flipped(dual)).flipped(dual);
        }
    } else {
        // Every window reaches beyond the column.
        let mut rest = outside;
        for worth in column.iter_mut().rev() {
            rest = rest.max(worth.flipped(dual));
            *worth = rest.flipped(dual);
        }
    }
    column.resize(ticks, outside.flipped(dual));
    if sight.past {
        column.reverse();
    }
    column
}

/// The `until` of two columns, at each of the first so many ticks.
fn until(
    mut hold: Vec<Worth>,
    mut goal: Vec<Worth>,
    ticks: usize,
    sight: Sight,
    dual: bool,
    outside: Option<Worth>,
) -> Vec<Worth> {
    let length = hold.len().min(goal.len());
    hold.truncate(length);
    goal.truncate(length);
    if sight.past {
        hold.truncate(ticks);
        goal.truncate(ticks);
        hold.reverse();
        goal.reverse();
    }
    let outside = outside.map_or(Clamp::NEUTRAL, |worth| Clamp { goal: worth, hold: worth });
    let mut window = Window::new(sight.end.min(goal.len()) + 1, Reversed(outside));
    for at in (0..goal.len()).rev() {
        let step = Clamp { goal: goal[at].flipped(dual), hold: hold[at].flipped(dual) };
        goal[at] = window.push(Reversed(step)).0.goal.flipped(dual);
    }
    goal.resize(ticks, outside.goal.flipped(dual));
    if sight.past {
        goal.reverse();
    }
    goal
}
