//! Reduces formulas to four kinds of nodes, with times in ticks and signals as columns.
//!
//! Negations are moved down to the comparisons. Every operator is expressed by its counterpart that takes maxima.
//! Conjunction, `always` and `release` become disjunction, `eventually` and `until` between two negations; the mark
//! `dual` stands for these negations. The remaining operators are monotone, so unknown values can be bounded from each
//! side independently. A sequence whose interval begins later is divided: `a until[s,e] b = always[0,s-1] a and
//! next[s] (a until[0,e-s] b)`. The parts share their operands. So the nodes form an acyclic graph, operands first.

use crate::atom::Atom;
use crate::ticks::FOREVER;
use crate::worth::Worth;
use crate::{Connective, EvaluationError, Formula, Modality, Sequence};

/// The position of a node in the graph.
pub(crate) type Id = usize;

/// The direction in which an operator looks in time, and the end of its interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Sight {
    pub past: bool,
    /// The distance in ticks from the operator's own tick to the last tick that the operator sees. [`FOREVER`] if there
    /// is no end.
    pub end: usize,
    /// `true` if the formula gives the operator a time interval without an end. On a complete trace it then runs to the
    /// end of the trace, and nothing exists behind the end. In all other cases, the samples behind the end are unknown.
    pub endless: bool,
}

#[derive(Debug, Clone)]
pub(crate) enum CoreKind {
    Atom(Atom),
    /// The greater robustness of two operands.
    Or(Id, Id),
    /// The greatest robustness of the operand from tick `start` to the end of the interval, counted from the operator's
    /// tick.
    Any {
        operand: Id,
        start: usize,
        sight: Sight,
    },
    /// The robustness of `hold until goal`. It is the greatest value, over all ticks to the end, of the lesser of
    /// `goal` at the tick and the least of `hold` before the tick.
    Until {
        hold: Id,
        goal: Id,
        sight: Sight,
    },
}

#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub kind: CoreKind,
    /// `true` if the node negates its operands and its result.
    pub dual: bool,
}

impl Node {
    pub fn operands(&self) -> impl Iterator<Item = Id> + use<> {
        let operands = match self.kind {
            CoreKind::Atom(_) => [None, None],
            CoreKind::Or(left, right) => [Some(left), Some(right)],
            CoreKind::Any { operand, .. } => [Some(operand), None],
            CoreKind::Until { hold, goal, .. } => [Some(hold), Some(goal)],
        };
        operands.into_iter().flatten()
    }
}

/// The nodes of a formula. Operands come first, and the formula itself is the last node.
#[derive(Debug, Clone)]
pub(crate) struct Core {
    pub nodes: Vec<Node>,
}

/// The assumption about a formula beyond the end of the trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Beyond {
    /// The assumption that no samples follow the end of the trace. Only the recorded samples count.
    Nothing,
    /// The assumption that the worst possible samples follow the end of the trace.
    Worst,
    /// The assumption that the best possible samples follow the end of the trace.
    Best,
}

impl Beyond {
    /// Returns the robustness of a node's operands beyond the end of the trace, negated if the node negates its
    /// operands. `None` if no samples lie there.
    pub fn operand(self, node: &Node, sight: Sight, complete: bool) -> Option<Worth> {
        match self {
            _ if sight.past || (sight.endless && complete) => None,
            Beyond::Nothing => None,
            Beyond::Worst => Some(Worth::WORST.flipped(node.dual)),
            Beyond::Best => Some(Worth::BEST.flipped(node.dual)),
        }
    }
}

impl Core {
    /// Reduces a formula to nodes, for rows of the given signals that are `dt` seconds apart. Also returns the
    /// sub-formula that each node belongs to.
    pub fn new<'f>(
        formula: &'f Formula,
        signals: &[String],
        dt: f64,
    ) -> Result<(Self, Vec<&'f Formula>), EvaluationError> {
        let mut builder = Builder { signals, dt, nodes: Vec::new(), parts: Vec::new() };
        builder.add(formula, false)?;
        Ok((Self { nodes: builder.nodes }, builder.parts))
    }

    /// Returns for each node the number of ticks that determine the formula at tick 0, on a trace of `ticks` ticks.
    pub fn needed(&self, ticks: usize) -> Vec<usize> {
        let mut needed = vec![0; self.nodes.len()];
        *needed.last_mut().expect("a formula has a node") = ticks.min(1);
        for (id, node) in self.nodes.iter().enumerate().rev() {
            let own = needed[id];
            let ahead = match node.kind {
                CoreKind::Any { sight, .. } | CoreKind::Until { sight, .. } if !sight.past => sight.end,
                _ => 0,
            };
            for operand in node.operands() {
                needed[operand] = needed[operand].max(ticks.min(own.saturating_add(ahead)));
            }
        }
        needed
    }
}

struct Builder<'s, 'f> {
    signals: &'s [String],
    dt: f64,
    nodes: Vec<Node>,
    parts: Vec<&'f Formula>,
}

impl<'f> Builder<'_, 'f> {
    fn push(&mut self, part: &'f Formula, kind: CoreKind, dual: bool) -> Id {
        self.nodes.push(Node { kind, dual });
        self.parts.push(part);
        self.nodes.len() - 1
    }

    fn add(&mut self, formula: &'f Formula, negated: bool) -> Result<Id, EvaluationError> {
        match formula {
            Formula::Constant(_) | Formula::Flag(_) | Formula::Compare(..) => {
                let atom = Atom::resolve(formula, negated, self.signals)?;
                Ok(self.push(formula, CoreKind::Atom(atom), false))
            }
            Formula::Not(inner) => self.add(inner, !negated),
            Formula::Join(connective, left, right) => {
                let left = self.add(left, negated ^ (*connective == Connective::Implies))?;
                let right = self.add(right, negated)?;
                let dual = negated ^ (*connective == Connective::And);
                Ok(self.push(formula, CoreKind::Or(left, right), dual))
            }
            Formula::Modal(modality, interval, inner) => {
                let (start, end) = interval.ticks(self.dt)?;
                let operand = self.add(inner, negated)?;
                let dual = negated ^ matches!(modality, Modality::Always | Modality::Historically);
                let past = matches!(modality, Modality::Historically | Modality::Once);
                let sight = Sight { past, end: end.unwrap_or(FOREVER), endless: end.is_none() };
                Ok(self.push(formula, CoreKind::Any { operand, start, sight }, dual))
            }
            Formula::Sequence(sequence, interval, hold, goal) => {
                let (start, end) = interval.ticks(self.dt)?;
                let hold = self.add(hold, negated)?;
                let goal = self.add(goal, negated)?;
                let dual = negated ^ (*sequence == Sequence::Release);
                let past = *sequence == Sequence::Since;
                let sight = |end| Sight { past, end, endless: interval.end.is_infinite() };
                let length = end.map_or(FOREVER, |end| end - start);
                let until = self.push(formula, CoreKind::Until { hold, goal, sight: sight(length) }, dual);
                if start == 0 {
                    return Ok(until);
                }
                let before = CoreKind::Any { operand: hold, start: 0, sight: sight(start - 1) };
                let before = self.push(formula, before, !dual);
                let then = self.push(formula, CoreKind::Any { operand: until, start, sight: sight(start) }, dual);
                Ok(self.push(formula, CoreKind::Or(before, then), !dual))
            }
        }
    }
}
