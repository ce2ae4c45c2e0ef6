//! Grows small decision trees: they find the ranges and levels that separate failing tests from passing tests.
//!
//! The method is CART (Breiman, Friedman, Olshen and Stone 1984). The leaf with the greatest gain is split next, so that
//! a tree with fewer leaves is always the beginning of a tree with more leaves.
//!
//! Failing and passing tests have the same total weight (CART's priors of one half each), however rare failures are.
//! A leaf predicts failure if a larger share of its tests fails than among all tests, because this rule separates the
//! verdicts best.

use super::table::{Condition, Part, Split, Table, Weights};

/// A decision tree, as a list of nodes that begins with the root.
#[derive(Debug, Clone, Default)]
pub struct Tree {
    pub nodes: Vec<Node>,
}

/// A node of a decision tree, with the numbers of tests and failures that reach the node.
#[derive(Debug, Clone)]
pub struct Node {
    pub tests: usize,
    pub failures: usize,
    /// The condition of the node, and the indices of the child nodes for yes and no; `None` at a leaf.
    pub split: Option<(Condition, [usize; 2])>,
    /// The decrease of impurity by the split, in weighted tests; 0 at a leaf.
    pub gain: f64,
}

impl Tree {
    /// Grows a tree for these rows, with at most `leaves` leaves of at least `least` tests each.
    pub fn grow(table: &Table, rows: &[usize], leaves: usize, least: usize) -> Self {
        let leaf = |part: &Part| {
            let [tests, failures] = part.counts(table);
            Node { tests, failures, split: None, gain: 0.0 }
        };
        let all = Part::of(table, rows);
        let mut tree = Self { nodes: vec![leaf(&all)] };
        let weights = Weights::balanced(rows.len(), tree.nodes[0].failures);
        let split = table.best_split(&all, weights, least);
        let mut open = vec![(0, all, split)];
        for _ in 1..leaves {
            let gain = |split: &Option<Split>| split.as_ref().map_or(0.0, |split| split.gain);
            let best = (0..open.len()).rev().max_by(|&a, &b| gain(&open[a].2).total_cmp(&gain(&open[b].2)));
            let Some(best) = best.filter(|&best| open[best].2.is_some()) else { break };
            let (node, part, Some(Split { condition, gain })) = open.remove(best) else { break };
            let children = [tree.nodes.len(), tree.nodes.len() + 1];
            for (child, part) in children.into_iter().zip(part.divided(table, &condition)) {
                tree.nodes.push(leaf(&part));
                let split = table.best_split(&part, weights, least);
                open.push((child, part, split));
            }
            (tree.nodes[node].split, tree.nodes[node].gain) = (Some((condition, children)), gain);
        }
        tree
    }

    /// Returns the tree at the stage of its growth at which the tree had this number of leaves.
    pub fn with_leaves(&self, leaves: usize) -> Self {
        let kept = (2 * leaves - 1).min(self.nodes.len());
        let mut nodes = self.nodes[..kept].to_vec();
        for node in &mut nodes {
            node.split.take_if(|(_, children)| children[1] >= kept);
        }
        Self { nodes }
    }

    /// Returns the decrease of impurity by all splits of each of `columns` columns.
    pub fn gains(&self, columns: usize) -> Vec<f64> {
        let mut gains = vec![0.0; columns];
        for node in &self.nodes {
            if let Some((condition, _)) = &node.split {
                gains[condition.column()] += node.gain;
            }
        }
        gains
    }

    /// Checks whether a node predicts failure, which it does if a larger share of its tests failed than among all
    /// tests.
    fn says_fail(&self, node: &Node) -> bool {
        node.failures * self.nodes[0].tests > self.nodes[0].failures * node.tests
    }

    /// Returns `true` if the tree predicts that the test in a row fails.
    pub fn fails(&self, table: &Table, row: usize) -> bool {
        let mut at = &self.nodes[0];
        while let Some((condition, [yes, no])) = &at.split {
            at = &self.nodes[if table.is_yes(condition, row) { *yes } else { *no }];
        }
        self.says_fail(at)
    }

    /// Returns the tree without the splits whose two sides give the same prediction.
    pub fn pruned(&self) -> Self {
        let mut tree = self.clone();
        // Children come after their parents in the list.
        for index in (0..tree.nodes.len()).rev() {
            let Some((_, [yes, no])) = &tree.nodes[index].split else { continue };
            let (yes, no) = (&tree.nodes[*yes], &tree.nodes[*no]);
            if yes.split.is_none() && no.split.is_none() && tree.says_fail(yes) == tree.says_fail(no) {
                tree.nodes[index].split = None;
            }
        }
        tree
    }

    /// Returns the leaves that predict failure, each with the conditions and the answers on the path from the root to
    /// the leaf.
    pub fn failing(&self) -> Vec<(Vec<(&Condition, bool)>, &Node)> {
        let mut failing = Vec::new();
        let mut open = vec![(0, Vec::new())];
        while let Some((index, path)) = open.pop() {
            let node = &self.nodes[index];
            match &node.split {
                None if self.says_fail(node) => failing.push((path, node)),
                None => {}
                Some((condition, children)) => {
                    for (child, answer) in children.iter().zip([true, false]).rev() {
                        open.push((*child, path.iter().copied().chain([(condition, answer)]).collect()));
                    }
                }
            }
        }
        failing
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explanation::table::tests::tables;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn smaller_trees_are_the_beginnings_of_larger_ones(table in tables(), leaves in 1..5_usize) {
            let rows: Vec<usize> = (0..table.failed.len()).collect();
            let (small, large) = (Tree::grow(&table, &rows, leaves, 1), Tree::grow(&table, &rows, 5, 1));
            let cut = large.with_leaves(leaves);
            prop_assert_eq!(small.nodes.len(), cut.nodes.len());
            for &row in &rows {
                prop_assert_eq!(small.fails(&table, row), cut.fails(&table, row));
                prop_assert_eq!(small.fails(&table, row), small.pruned().fails(&table, row));
            }
        }
    }
}
