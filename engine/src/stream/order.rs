//! Finds the order in which the nodes of a graph are evaluated, or the reason why no order exists.
//!
//! Operands come before the nodes that use them, but a `pre` uses its operand only once the tick is over. The rest is a
//! depth-first search (Tarjan, SIAM J. Comput. 1, 1972) that stops at the first node it meets again on its own path.
//! This is a causal cycle, as compilers of synchronous languages know it (Halbwachs et al., Proc. IEEE 79(9), 1991).

use super::node::{Equation, Node, NodeKind};
use rustc_hash::FxHashMap;
use std::collections::VecDeque;
use std::rc::Rc;
use thiserror::Error;

/// The reason why a graph of streams cannot be evaluated.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum GraphFlaw {
    /// A stream is read but not defined.
    #[error("the stream `{stream}` is read, but nothing defines it; call `define` on it")]
    Undefined {
        /// The name of the stream.
        stream: String,
    },
    /// A stream depends on its own value at the same tick.
    #[error("a stream depends on its own value at the same tick: {}; put a `pre` on this cycle", circle(.labels))]
    Cycle {
        /// The labels of the nodes on the cycle. Each node is an operand of the next, the last of the first.
        labels: Vec<String>,
    },
}

fn circle(labels: &[String]) -> String {
    labels.iter().chain(labels.first()).map(|label| format!("`{label}`")).collect::<Vec<_>>().join(" -> ")
}

/// Returns the nodes that have to be evaluated before a node.
fn operands<'a>(node: &'a Rc<Node>, equations: &'a [Equation]) -> Result<&'a [Rc<Node>], GraphFlaw> {
    match &node.kind {
        NodeKind::Pre => Ok(&[]),
        NodeKind::Forward { equation, name } => {
            let definition = equations.get(*equation).and_then(|equation| equation.definition.as_ref());
            definition.map(std::slice::from_ref).ok_or_else(|| GraphFlaw::Undefined { stream: name.clone() })
        }
        _ => Ok(&node.inputs),
    }
}

/// Returns the roots and all nodes that they depend on, operands first. Nodes are told apart by their addresses.
pub(crate) fn order<'a>(
    roots: impl IntoIterator<Item = &'a Rc<Node>>,
    equations: &'a [Equation],
) -> Result<Vec<&'a Rc<Node>>, GraphFlaw> {
    let mut ordered = Vec::new();
    // True for a node that is done, false for one on the path. Only looked up: addresses differ between runs.
    let mut done: FxHashMap<*const Node, bool> = FxHashMap::default();
    let mut waiting: VecDeque<&Rc<Node>> = roots.into_iter().collect();
    while let Some(root) = waiting.pop_front() {
        let mut path = vec![(root, 0)];
        while let Some((node, next)) = path.last_mut() {
            let node = *node;
            let address = Rc::as_ptr(node);
            if *next == 0 && done.get(&address) == Some(&true) {
                path.pop();
                continue;
            }
            done.insert(address, false);
            let Some(operand) = operands(node, equations)?.get(*next) else {
                done.insert(address, true);
                ordered.push(node);
                if matches!(node.kind, NodeKind::Pre) {
                    waiting.push_back(&node.inputs[0]);
                }
                path.pop();
                continue;
            };
            *next += 1;
            match done.get(&Rc::as_ptr(operand)) {
                Some(true) => {}
                None => path.push((operand, 0)),
                Some(false) => {
                    let from = path.iter().position(|(node, _)| Rc::ptr_eq(node, operand)).unwrap_or(0);
                    let labels = path[from..].iter().rev().map(|(node, _)| node.label()).collect();
                    return Err(GraphFlaw::Cycle { labels });
                }
            }
        }
    }
    Ok(ordered)
}
