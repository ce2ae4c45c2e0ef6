//! A diagram as a Markov chain whose paths are equally probable.
//!
//! Where every edge is taken with the share that the tests beyond it have of those beyond its node, all tests come
//! with the same probability (Knuth, *The Art of Computer Programming* 4A, 7.1.4, on random solutions). The same
//! shares add up to the probability of any combination of classes.

use super::Diagram;

/// A choice at a node.
#[derive(Debug)]
struct Edge {
    class: usize,
    child: usize,
    /// The probability that it is chosen.
    share: f64,
}

/// The nodes at which the same member is chosen.
#[derive(Debug)]
struct Layer {
    /// The member.
    place: usize,
    nodes: Vec<Vec<Edge>>,
}

/// Uniformly random paths of a diagram that is not empty, a level counting as much as any other.
#[derive(Debug)]
pub(in crate::rules) struct Chain {
    layers: Vec<Layer>,
    /// How many classes each member has.
    classes: Vec<usize>,
}

impl Chain {
    /// The chain of a diagram whose members have classes of so many levels.
    pub(in crate::rules) fn new(diagram: &Diagram, sizes: &[Vec<usize>]) -> Self {
        let mut layers = Vec::new();
        let mut below = vec![1.0];
        for layer in diagram.layers.iter().rev() {
            let weigh = |node: usize| {
                let weight = |class: usize, child: usize| sizes[layer.place][class] as f64 * below[child];
                let edges =
                    layer.edges(node, None).map(|(class, child)| Edge { class, child, share: weight(class, child) });
                let mut edges: Vec<Edge> = edges.collect();
                let all: f64 = edges.iter().map(|edge| edge.share).sum();
                edges.iter_mut().filter(|_| all > 0.0).for_each(|edge| edge.share /= all);
                (edges, all)
            };
            let (nodes, weights): (Vec<_>, Vec<f64>) = (0..layer.nodes()).map(weigh).unzip();
            // Only their ratios matter; the numbers themselves would soon be too large.
            let most = weights.iter().copied().fold(0.0, f64::max);
            below = weights.iter().map(|weight| weight / most).collect();
            layers.push(Layer { place: layer.place, nodes });
        }
        layers.reverse();
        Self { layers, classes: sizes.iter().map(Vec::len).collect() }
    }

    /// The classes of a random path, by member; `share` gives numbers from 0 to below 1.
    pub(in crate::rules) fn draw(&self, mut share: impl FnMut() -> f64) -> Vec<usize> {
        let mut drawn = vec![0; self.layers.len()];
        let mut node = 0;
        for layer in &self.layers {
            let edges = &layer.nodes[node];
            let mut left = share();
            let chosen = edges.iter().find(|edge| {
                left -= edge.share;
                left < 0.0
            });
            // Rounding may leave a little beyond the last edge.
            let chosen = chosen.or(edges.last()).expect("every node leads to the end");
            drawn[layer.place] = chosen.class;
            node = chosen.child;
        }
        drawn
    }

    /// For each member and class, how probable it is that a path has it and the fixed classes.
    pub(in crate::rules) fn joint(&self, fixed: &[Option<usize>]) -> Vec<Vec<f64>> {
        let allows = |layer: &Layer, edge: &&Edge| fixed[layer.place].is_none_or(|class| class == edge.class);
        // How probable it is to come to each node by fixed classes.
        let mut reached = vec![vec![1.0]];
        for (i, layer) in self.layers.iter().enumerate() {
            let nodes = self.layers.get(i + 1).map_or(1, |next| next.nodes.len());
            let mut next = vec![0.0; nodes];
            for (edges, reached) in layer.nodes.iter().zip(&reached[i]).filter(|(_, reached)| **reached > 0.0) {
                edges
                    .iter()
                    .filter(|edge| allows(layer, edge))
                    .for_each(|edge| next[edge.child] += reached * edge.share);
            }
            reached.push(next);
        }
        let mut joint: Vec<Vec<f64>> = self.classes.iter().map(|&classes| vec![0.0; classes]).collect();
        // How probable it is to go on from each node that is reached by fixed classes.
        let mut agree = vec![1.0];
        for (layer, reached) in self.layers.iter().zip(&reached).rev() {
            let mut here = vec![0.0; layer.nodes.len()];
            for (node, edges) in layer.nodes.iter().enumerate().filter(|&(node, _)| reached[node] > 0.0) {
                for edge in edges.iter().filter(|edge| allows(layer, edge)) {
                    let on = edge.share * agree[edge.child];
                    here[node] += on;
                    joint[layer.place][edge.class] += reached[node] * on;
                }
            }
            agree = here;
        }
        joint
    }
}
