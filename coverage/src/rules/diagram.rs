//! Decision diagrams of groups of parameters: every path from the root is a way to keep the clauses.
//!
//! The diagram is compiled from the root down. What the parameters so far leave to those that follow is only
//! which of the clauses between both are kept already; nodes with the same such clauses are one (Bergman, Cire,
//! van Hoeve, Hooker, *Decision Diagrams for Optimization*, 2016). Then nodes without a path to the end go, and
//! nodes with the same children become one.

mod chain;

pub(super) use chain::Chain;

use super::group::ClassClause;
use std::collections::HashMap;

/// The largest number of edges of a diagram that is not given up; a pass over as many takes some 0.1 ms.
const MOST_EDGES: usize = 1 << 16;

/// The same for two members, whose diagram is a table that a solver could only look through cell by cell.
const MOST_EDGES_OF_TWO: usize = 1 << 22;

/// No child.
const NONE: u32 = u32::MAX;

/// The nodes at which the same member is chosen.
#[derive(Debug)]
struct Layer {
    /// The member.
    place: usize,
    classes: usize,
    /// For each node and class, the node of the next layer.
    children: Vec<u32>,
}

impl Layer {
    fn nodes(&self) -> usize {
        self.children.len() / self.classes
    }

    /// The children of a node with their classes, of the fixed class if there is one.
    fn edges(&self, node: usize, fixed: Option<usize>) -> impl Iterator<Item = (usize, usize)> {
        let classes = fixed.map_or(0..self.classes, |class| class..class + 1);
        let children = classes.map(move |class| (class, self.children[node * self.classes + class]));
        children.filter(|&(_, child)| child != NONE).map(|(class, child)| (class, child as usize))
    }
}

/// A reduced decision diagram; the root is node 0 of the first layer, the end node 0 after the last.
#[derive(Debug)]
pub(super) struct Diagram {
    layers: Vec<Layer>,
}

impl Diagram {
    /// Compiles the clauses among members with so many classes; none if the diagram is too large.
    pub(super) fn new(members: &[usize], sizes: &[Vec<usize>], clauses: &[ClassClause]) -> Option<Self> {
        let place = |parameter: usize| members.binary_search(&parameter).expect("clauses are among the members");
        let places: Vec<Vec<usize>> =
            clauses.iter().map(|clause| clause.literals.iter().map(|l| place(l.parameter)).collect()).collect();
        let order = order(members.len(), &places);
        let mut turn = vec![0; order.len()];
        for (i, &place) in order.iter().enumerate() {
            turn[place] = i;
        }
        let last: Vec<usize> =
            places.iter().map(|places| places.iter().map(|&p| turn[p]).max().expect("no clause is empty")).collect();

        let mut layers = Vec::new();
        let mut edges = 0;
        let mut states = vec![vec![0u64; clauses.len().div_ceil(64)]];
        for (i, &place) in order.iter().enumerate() {
            let touched: Vec<(usize, &[bool])> = (0..clauses.len())
                .filter_map(|c| {
                    let literal = places[c].iter().position(|&p| p == place)?;
                    Some((c, clauses[c].literals[literal].holds.as_slice()))
                })
                .collect();
            let classes = sizes[place].len();
            edges += states.len() * classes;
            if edges > if members.len() == 2 { MOST_EDGES_OF_TWO } else { MOST_EDGES } {
                return None;
            }
            let mut number: HashMap<Vec<u64>, u32> = HashMap::new();
            let mut next: Vec<Vec<u64>> = Vec::new();
            let mut children = Vec::with_capacity(states.len() * classes);
            for state in &states {
                for class in 0..classes {
                    let Some(state) = follow(state, class, &touched, |clause| last[clause] == i) else {
                        children.push(NONE);
                        continue;
                    };
                    children.push(*number.entry(state).or_insert_with_key(|state| {
                        next.push(state.clone());
                        next.len() as u32 - 1
                    }));
                }
            }
            layers.push(Layer { place, classes, children });
            states = next;
        }
        let mut diagram = Self { layers };
        diagram.reduce(states.len());
        Some(diagram)
    }

    /// Drops nodes without a path to the end and merges nodes with the same children.
    fn reduce(&mut self, ends: usize) {
        let mut kept: Vec<u32> = (0..ends as u32).collect();
        for layer in self.layers.iter_mut().rev() {
            let mut number: HashMap<Vec<u32>, u32> = HashMap::new();
            let mut children = Vec::new();
            let renumbered = layer.children.chunks_exact(layer.classes).map(|node| {
                let node: Vec<u32> = node.iter().map(|&c| if c == NONE { NONE } else { kept[c as usize] }).collect();
                if node.iter().all(|&child| child == NONE) {
                    return NONE;
                }
                *number.entry(node).or_insert_with_key(|node| {
                    children.extend_from_slice(node);
                    (children.len() / layer.classes) as u32 - 1
                })
            });
            kept = renumbered.collect();
            layer.children = children;
        }
    }

    /// Whether there is no path at all.
    pub(super) fn is_empty(&self) -> bool {
        self.layers.first().is_some_and(|layer| layer.children.is_empty())
    }

    /// The nodes of each layer that paths of the fixed classes reach.
    fn reached(&self, fixed: &[Option<usize>]) -> Vec<Vec<bool>> {
        let mut reached: Vec<Vec<bool>> = self.layers.iter().map(|layer| vec![false; layer.nodes()]).collect();
        reached.push(vec![false]);
        reached[0][0] = true;
        for (i, layer) in self.layers.iter().enumerate() {
            let (here, below) = reached.split_at_mut(i + 1);
            for node in (0..layer.nodes()).filter(|&node| here[i][node]) {
                for (_, child) in layer.edges(node, fixed[layer.place]) {
                    below[0][child] = true;
                }
            }
        }
        reached
    }

    /// Whether a path has the fixed classes.
    pub(super) fn holds(&self, fixed: &[Option<usize>]) -> bool {
        self.reached(fixed)[self.layers.len()][0]
    }

    /// For each member and class, whether a path has it with the fixed ones.
    pub(super) fn supported(&self, fixed: &[Option<usize>]) -> Vec<Vec<bool>> {
        let reached = self.reached(fixed);
        let mut supported = vec![Vec::new(); self.layers.len()];
        let mut ends = vec![true];
        for (layer, reached) in self.layers.iter().zip(&reached).rev() {
            let mut classes = vec![false; layer.classes];
            let mut leads = vec![false; layer.nodes()];
            for node in (0..layer.nodes()).filter(|&node| reached[node]) {
                for (class, _) in layer.edges(node, fixed[layer.place]).filter(|&(_, child)| ends[child]) {
                    classes[class] = true;
                    leads[node] = true;
                }
            }
            supported[layer.place] = classes;
            ends = leads;
        }
        supported
    }

    /// The number of paths, each as many times as its classes have levels.
    pub(super) fn tests(&self, sizes: &[Vec<usize>]) -> f64 {
        let mut below = vec![1.0];
        for layer in self.layers.iter().rev() {
            let paths = |node: usize| {
                layer.edges(node, None).map(|(class, child)| sizes[layer.place][class] as f64 * below[child]).sum()
            };
            below = (0..layer.nodes()).map(paths).collect();
        }
        below[0]
    }
}

/// The clauses kept after a choice, less those that no later member has; none if one of these is not kept.
fn follow(
    state: &[u64],
    class: usize,
    touched: &[(usize, &[bool])],
    is_last: impl Fn(usize) -> bool,
) -> Option<Vec<u64>> {
    let mut state = state.to_vec();
    for &(clause, holds) in touched {
        let (word, bit) = (clause / 64, 1 << (clause % 64));
        let kept = holds[class] || state[word] & bit != 0;
        if is_last(clause) {
            if !kept {
                return None;
            }
            state[word] &= !bit;
        } else if kept {
            state[word] |= bit;
        }
    }
    Some(state)
}

/// An order of the members in which few clauses have members on both sides: next comes always the member that
/// leaves the fewest clauses open.
fn order(members: usize, clauses: &[Vec<usize>]) -> Vec<usize> {
    let mut placed = vec![false; members];
    let mut order = Vec::with_capacity(members);
    let open = |placed: &[bool]| {
        clauses.iter().filter(|c| c.iter().any(|&p| placed[p]) && c.iter().any(|&p| !placed[p])).count()
    };
    for _ in 0..members {
        let rank = |&place: &usize| {
            let mut placed = placed.clone();
            placed[place] = true;
            open(&placed)
        };
        let next = (0..members).filter(|&place| !placed[place]).min_by_key(rank).expect("a member is left");
        placed[next] = true;
        order.push(next);
    }
    order
}
