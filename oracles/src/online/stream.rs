//! Computes the robustness of a formula while the trace is being recorded.
//!
//! Every node passes on its worth at its next tick as soon as the worth is certain. So an operator that looks `b`
//! ticks ahead is `b` ticks late. At the end of the trace, the uncertain values are computed three times: for the
//! recorded samples only, for the worst and for the best continuation.

use super::scan::Scan;
use crate::core::{Beyond, Core, CoreKind, Id, Node};
use crate::fold::{Clamp, Fold, Reversed};
use crate::worth::Worth;
use std::collections::VecDeque;

/// The values of two operands that wait for each other.
type Queues = [VecDeque<Worth>; 2];

#[derive(Debug, Clone)]
enum State {
    Atom,
    Or(Queues),
    Any(Scan<Worth>),
    Until(Queues, Scan<Clamp>),
    Since(Queues, Scan<Reversed<Clamp>>),
}

/// Follows a formula tick by tick, and computes its robustness.
#[derive(Debug, Clone)]
pub(super) struct Stream {
    states: Vec<State>,
    /// The worth of each node at its next tick, if this tick made it certain.
    values: Vec<Option<Worth>>,
    /// The worth of each node at its first tick, if it is certain.
    firsts: Vec<Option<Worth>>,
}

impl Stream {
    /// Makes a stream that computes the robustness of a formula. `needed` has the number of ticks that are needed of
    /// each node.
    pub fn new(core: &Core, needed: &[usize]) -> Self {
        let state = |(node, needed): (&Node, &usize)| match node.kind {
            CoreKind::Atom(_) => State::Atom,
            CoreKind::Or(..) => State::Or(Queues::default()),
            CoreKind::Any { start, sight, .. } => State::Any(Scan::new(start, sight, *needed)),
            CoreKind::Until { sight, .. } if sight.past => {
                State::Since(Queues::default(), Scan::new(0, sight, *needed))
            }
            CoreKind::Until { sight, .. } => State::Until(Queues::default(), Scan::new(0, sight, *needed)),
        };
        let nodes = core.nodes.len();
        Self {
            states: core.nodes.iter().zip(needed).map(state).collect(),
            values: vec![None; nodes],
            firsts: vec![None; nodes],
        }
    }

    /// Takes the robustness of the comparisons and flags at the next tick, and updates the robustness of all nodes.
    pub fn step(&mut self, core: &Core, atoms: &[Option<Worth>]) {
        for (id, node) in core.nodes.iter().enumerate() {
            let value = |operand: Id| self.values[operand].map(|worth| worth.flipped(node.dual));
            let worth = match (&mut self.states[id], &node.kind) {
                (State::Atom, _) => atoms[id],
                (State::Any(scan), CoreKind::Any { operand, .. }) => value(*operand).and_then(|worth| scan.push(worth)),
                (state, CoreKind::Or(left, right) | CoreKind::Until { hold: left, goal: right, .. }) => {
                    state.meet(value(*left), value(*right))
                }
                _ => unreachable!("states are made from kinds"),
            };
            let worth = worth.map(|worth| worth.flipped(node.dual));
            self.values[id] = worth;
            self.firsts[id] = self.firsts[id].or(worth);
        }
    }

    /// Returns a lower and an upper bound of a node's robustness at the first tick, from the values that are already
    /// certain.
    pub fn bounds(&self, core: &Core, id: Id) -> (Worth, Worth) {
        if let Some(worth) = self.firsts[id] {
            return (worth, worth);
        }
        let dual = core.nodes[id].dual;
        let flip = |(lower, upper): (Worth, Worth)| {
            if dual { (upper.flipped(true), lower.flipped(true)) } else { (lower, upper) }
        };
        flip(match (&self.states[id], &core.nodes[id].kind) {
            (State::Or(_), CoreKind::Or(left, right)) => {
                let (left, right) = (flip(self.bounds(core, *left)), flip(self.bounds(core, *right)));
                (left.0.max(right.0), left.1.max(right.1))
            }
            (State::Any(scan), _) => (scan.first().unwrap_or(Worth::WORST), Worth::BEST),
            (State::Until(_, scan), _) => {
                scan.first().map_or((Worth::WORST, Worth::BEST), |clamp| (clamp.goal, clamp.goal.max(clamp.hold)))
            }
            _ => (Worth::WORST, Worth::BEST),
        })
    }

    /// Returns the robustness of the formula on the trace so far, if the trace ends after `ticks` ticks.
    pub fn finish(mut self, core: &Core, needed: &[usize], ticks: usize, complete: bool, beyond: Beyond) -> Worth {
        let root = core.nodes.len() - 1;
        let mut rests: Vec<Vec<Worth>> = Vec::with_capacity(core.nodes.len());
        for (id, node) in core.nodes.iter().enumerate() {
            let own = needed[id].min(ticks);
            let outside = |sight| beyond.operand(node, sight, complete);
            let clamp = |sight| outside(sight).map_or(Clamp::NEUTRAL, |worth| Clamp { goal: worth, hold: worth });
            let value = |worth: &Worth| worth.flipped(node.dual);
            let mut rest: Vec<Worth> = match (&mut self.states[id], &node.kind) {
                (State::Any(scan), CoreKind::Any { operand, sight, .. }) => {
                    let mut rest: Vec<_> = rests[*operand].iter().filter_map(|worth| scan.push(value(worth))).collect();
                    rest.extend(scan.rest(own, outside(*sight).unwrap_or(Worth::NEUTRAL)));
                    rest
                }
                (state, CoreKind::Or(left, right) | CoreKind::Until { hold: left, goal: right, .. }) => {
                    let mut rest = Vec::new();
                    for at in 0..rests[*left].len().max(rests[*right].len()) {
                        let (left, right) = (rests[*left].get(at).map(value), rests[*right].get(at).map(value));
                        rest.extend(state.meet(left, right));
                    }
                    if let (State::Until(_, scan), CoreKind::Until { sight, .. }) = (state, &node.kind) {
                        rest.extend(scan.rest(own, clamp(*sight)).iter().map(|clamp| clamp.goal));
                    }
                    rest
                }
                _ => Vec::new(),
            };
            rest.iter_mut().for_each(|worth| *worth = worth.flipped(node.dual));
            rests.push(rest);
        }
        self.firsts[root].unwrap_or_else(|| rests[root][0])
    }
}

impl State {
    /// Takes the operands' values at their next ticks, if they are known. Returns the node's value at its next tick,
    /// if the values of both operands for this tick have come.
    fn meet(&mut self, left: Option<Worth>, right: Option<Worth>) -> Option<Worth> {
        let (State::Or(queues) | State::Until(queues, _) | State::Since(queues, _)) = self else { return None };
        let (left, right) = pair(queues, left, right)?;
        let step = Clamp { hold: left, goal: right };
        match self {
            State::Until(_, scan) => scan.push(step).map(|clamp| clamp.goal),
            State::Since(_, scan) => scan.push(Reversed(step)).map(|clamp| clamp.0.goal),
            _ => Some(left.max(right)),
        }
    }
}

fn pair(queues: &mut Queues, left: Option<Worth>, right: Option<Worth>) -> Option<(Worth, Worth)> {
    if let (Some(left), Some(right)) = (left, right)
        && queues.iter().all(VecDeque::is_empty)
    {
        return Some((left, right));
    }
    queues[0].extend(left);
    queues[1].extend(right);
    if queues.iter().any(VecDeque::is_empty) {
        return None;
    }
    Some((queues[0].pop_front()?, queues[1].pop_front()?))
}
