//! Compiles clauses into the nodes of a decision diagram.
//!
//! Each clause becomes a diagram, and the diagrams are joined in pairs (Bryant, *Graph-based algorithms for Boolean
//! function manipulation*, IEEE Transactions on Computers 35, 1986). Clauses whose first members are late in the order
//! come first. So the joined diagram is already complete for all members from there on.

use super::super::classes::ClassClause;
use super::{NONE, Segment};
use std::collections::HashMap;

/// The greatest number of nodes, including nodes that are dropped later. With more, the diagram is given up.
const MOST_NODES: usize = 1 << 20;

/// The greatest length of a path. The recursion is as deep as a path is long.
const LONGEST: usize = 1 << 12;

/// The mark of the end of a path, where all clauses are kept.
const END: u32 = u32::MAX - 1;

/// A choice between the two halves of a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Node {
    /// The position of the segment in the list of segments.
    pub(super) segment: u32,
    /// The children: positions of nodes, [`NONE`] or `END`.
    pub(super) low: u32,
    pub(super) high: u32,
}

/// Returns the nodes of the diagram in the order of their segments. The last node is the end and has the last segment.
/// The list is empty if nothing keeps the clauses. `turn` gives the position of a parameter in the order. `None` if
/// there are too many nodes.
pub(super) fn nodes(
    segments: &[Segment],
    classes: &[usize],
    clauses: &[ClassClause],
    turn: impl Fn(usize) -> usize,
) -> Option<Vec<Node>> {
    let depth: usize = classes.iter().map(|classes| classes.next_power_of_two().ilog2() as usize).sum();
    if depth > LONGEST {
        return None;
    }
    let first = classes.iter().scan(0, |next, classes| {
        let first = *next;
        *next += classes.saturating_sub(1) as u32;
        Some(first)
    });
    let mut table =
        Table { first: first.collect(), nodes: Vec::new(), number: HashMap::new(), joined: HashMap::new(), steps: 0 };
    let mut with_first: Vec<Vec<u32>> = vec![Vec::new(); classes.len()];
    for clause in clauses {
        let mut literals: Vec<(usize, &[bool])> =
            clause.literals.iter().map(|literal| (turn(literal.parameter), literal.holds.as_slice())).collect();
        literals.sort_unstable_by_key(|literal| literal.0);
        with_first[literals[0].0].push(table.clause(&literals));
    }
    let mut root = END;
    for clauses in with_first.into_iter().rev() {
        let joined = table.join_all(clauses)?;
        root = table.join(root, joined)?;
        table.joined.clear();
    }
    Some(table.reached(root, segments.len() as u32 - 1))
}

/// All nodes so far, each of them once.
struct Table {
    /// The first segment of each member.
    first: Vec<u32>,
    nodes: Vec<Node>,
    number: HashMap<Node, u32>,
    /// The results of joining pairs of nodes.
    joined: HashMap<(u32, u32), u32>,
    steps: usize,
}

impl Table {
    fn node(&mut self, segment: u32, low: u32, high: u32) -> u32 {
        if low == high {
            return low;
        }
        let node = Node { segment, low, high };
        *self.number.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            self.nodes.len() as u32 - 1
        })
    }

    /// Makes the diagram of a clause. The literals have to be in the order of their members.
    fn clause(&mut self, literals: &[(usize, &[bool])]) -> u32 {
        literals.iter().rev().fold(NONE, |otherwise, (turn, holds)| self.literal(self.first[*turn], holds, otherwise))
    }

    /// Makes a diagram that leads to the end if the class is marked, and otherwise to `otherwise`.
    fn literal(&mut self, segment: u32, holds: &[bool], otherwise: u32) -> u32 {
        match holds {
            [true] => END,
            [_] => otherwise,
            _ => {
                let (lower, upper) = holds.split_at(holds.len() / 2);
                let low = self.literal(segment + 1, lower, otherwise);
                let high = self.literal(segment + lower.len() as u32, upper, otherwise);
                self.node(segment, low, high)
            }
        }
    }

    /// Joins diagrams so that the result leads to the end if all diagrams do.
    fn join_all(&mut self, mut all: Vec<u32>) -> Option<u32> {
        while all.len() > 1 {
            all = all
                .chunks(2)
                .map(|pair| if let &[a, b] = pair { self.join(a, b) } else { Some(pair[0]) })
                .collect::<Option<_>>()?;
        }
        Some(all.pop().unwrap_or(END))
    }

    /// Joins two diagrams so that the result leads to the end if both diagrams do. `None` if there are too many nodes
    /// or steps.
    fn join(&mut self, a: u32, b: u32) -> Option<u32> {
        match (a.min(b), a.max(b)) {
            (a, b) if a == b => Some(a),
            (_, NONE) => Some(NONE),
            (a, END) => Some(a),
            (a, b) => {
                if let Some(&known) = self.joined.get(&(a, b)) {
                    return Some(known);
                }
                self.steps += 1;
                if self.nodes.len() > MOST_NODES || self.steps > 4 * MOST_NODES {
                    return None;
                }
                let (left, right) = (self.nodes[a as usize], self.nodes[b as usize]);
                let segment = left.segment.min(right.segment);
                let children =
                    |of: u32, node: Node| if node.segment == segment { (node.low, node.high) } else { (of, of) };
                let ((a_low, a_high), (b_low, b_high)) = (children(a, left), children(b, right));
                let low = self.join(a_low, b_low)?;
                let high = self.join(a_high, b_high)?;
                let node = self.node(segment, low, high);
                self.joined.insert((a, b), node);
                Some(node)
            }
        }
    }

    /// Returns the nodes that the root reaches, in the order of their segments, and the end unless nothing reaches it.
    fn reached(&self, root: u32, end: u32) -> Vec<Node> {
        let mut kept = vec![false; self.nodes.len()];
        let mut stack = vec![root];
        while let Some(node) = stack.pop() {
            if node < END && !std::mem::replace(&mut kept[node as usize], true) {
                stack.extend([self.nodes[node as usize].low, self.nodes[node as usize].high]);
            }
        }
        let mut order: Vec<usize> = (0..kept.len()).filter(|&node| kept[node]).collect();
        order.sort_by_key(|&node| self.nodes[node].segment);
        let mut number = vec![NONE; self.nodes.len()];
        order.iter().enumerate().for_each(|(i, &node)| number[node] = i as u32);
        let renumbered = |child: u32| match child {
            NONE => NONE,
            END => order.len() as u32,
            node => number[node as usize],
        };
        let nodes = order.iter().map(|&node| {
            let Node { segment, low, high } = self.nodes[node];
            Node { segment, low: renumbered(low), high: renumbered(high) }
        });
        let end = (root != NONE).then_some(Node { segment: end, low: NONE, high: NONE });
        nodes.chain(end).collect()
    }
}
