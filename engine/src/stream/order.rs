//! In which order the nodes of a graph are evaluated, or why there is none.
//!
//! Operands come before what uses them; a `pre` uses its operand only once the tick is over. What is left is a search
//! in depth (Tarjan, SIAM J. Comput. 1, 1972) that stops at the first node it meets again on its own path: that path is
//! a causal cycle, as the compilers of synchronous languages know it (Halbwachs et al., Proc. IEEE 79(9), 1991).

use super::node::{Equation, Node, NodeKind};
use std::collections::{HashMap, VecDeque};
use std::rc::Rc;

/// Why a graph has no meaning.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Fault {
    /// A stream that something reads and nothing defines.
    Undefined(String),
    /// Streams that depend on themselves within a tick: the labels of the nodes, each the operand of the next, the last
    /// that of the first.
    Cycle(Vec<String>),
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Fault::Undefined(name) => write!(f, "the stream `{name}` is read, but nothing defines it"),
            Fault::Cycle(labels) => {
                f.write_str("a stream depends on its own value at the same tick: ")?;
                for label in labels {
                    write!(f, "`{label}` -> ")?;
                }
                write!(f, "`{}`; put a `pre` on the way", labels[0])
            }
        }
    }
}

/// What a node needs evaluated before itself.
fn operands<'a>(node: &'a Rc<Node>, equations: &'a [Equation]) -> Result<&'a [Rc<Node>], Fault> {
    match &node.kind {
        NodeKind::Pre => Ok(&[]),
        NodeKind::Forward { equation, name } => {
            let definition = equations.get(*equation).and_then(|equation| equation.definition.as_ref());
            definition.map(std::slice::from_ref).ok_or_else(|| Fault::Undefined(name.clone()))
        }
        _ => Ok(&node.inputs),
    }
}

/// All that the roots are made of, operands first. Nodes are told apart by where they are.
pub(crate) fn order<'a>(
    roots: impl IntoIterator<Item = &'a Rc<Node>>,
    equations: &'a [Equation],
) -> Result<Vec<&'a Rc<Node>>, Fault> {
    let mut ordered = Vec::new();
    // Whether a node is done, or else on the path. Only looked up, never iterated over: addresses differ between runs.
    let mut done: HashMap<*const Node, bool> = HashMap::new();
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
                    return Err(Fault::Cycle(path[from..].iter().rev().map(|(node, _)| node.label()).collect()));
                }
            }
        }
    }
    Ok(ordered)
}
