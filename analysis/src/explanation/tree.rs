//! Grows small decision trees: they find the ranges and levels that separate failing tests from passing tests.
//!
//! The method is CART (Breiman, Friedman, Olshen and Stone 1984): every split is the one that reduces Gini's impurity
//! most, over all columns and all places between two different numbers. Levels without an order are first sorted by
//! their share of failures; for two classes no division of the levels is better than the best one in this order
//! (their theorem 4.5; splits with too few tests on a side are skipped). The leaf with the greatest gain is split
//! next, so that a tree with fewer leaves is always the beginning of a tree with more leaves.
//!
//! Failing and passing tests have the same total weight (CART's priors of one half each), however rare failures are.
//! A leaf predicts failure if a larger share of its tests fails than among all tests, because this rule separates the
//! verdicts best.

/// A column of the table that a decision tree explains, with a value for each test.
#[derive(Debug, Clone)]
pub enum Column {
    /// A column of numbers, one number for each test.
    Numbers(Vec<f64>),
    /// A column of levels without an order, and the number of levels.
    Levels(Vec<usize>, usize),
}

/// The tests as columns of values, with a mark for each test that failed.
#[derive(Debug, Clone)]
pub struct Table {
    pub columns: Vec<Column>,
    pub failed: Vec<bool>,
}

/// The condition at a node of a tree.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// The condition that the number in a column is below a limit.
    Below(usize, f64),
    /// The condition that the level in a column is one of the levels marked `true`.
    Among(usize, Vec<bool>),
}

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
}

/// A division of tests into two parts by a condition.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// The decrease of Gini's impurity by the split, in weighted tests.
    pub gain: f64,
    pub test: Condition,
}

impl Table {
    fn is_yes(&self, test: &Condition, row: usize) -> bool {
        match test {
            Condition::Below(column, limit) => {
                matches!(&self.columns[*column], Column::Numbers(all) if all[row] < *limit)
            }
            Condition::Among(column, levels) => {
                matches!(&self.columns[*column], Column::Levels(all, _) if levels[all[row]])
            }
        }
    }

    fn failures(&self, rows: &[usize]) -> usize {
        rows.iter().filter(|&&row| self.failed[row]).count()
    }

    /// Finds the best split of these rows with at least `least` rows on either side; among equal splits the first
    /// split.
    pub fn best_split(&self, rows: &[usize], weights: Weights, least: usize) -> Option<Split> {
        let cutting = Cutting { weights, least };
        let splits = (0..self.columns.len()).filter_map(|column| match &self.columns[column] {
            Column::Numbers(values) => self.split_numbers(rows, column, values, cutting),
            Column::Levels(values, levels) => self.split_levels(rows, column, values, *levels, cutting),
        });
        splits.fold(None, |best: Option<Split>, split| match best {
            Some(best) if best.gain >= split.gain => Some(best),
            _ => Some(split),
        })
    }

    fn split_numbers(&self, rows: &[usize], column: usize, values: &[f64], cutting: Cutting) -> Option<Split> {
        let mut rows = rows.to_vec();
        rows.sort_by(|&a, &b| values[a].total_cmp(&values[b]).then(a.cmp(&b)));
        let counts: Vec<[usize; 2]> = rows.iter().map(|&row| [1, usize::from(self.failed[row])]).collect();
        let apart = |i: usize| values[rows[i - 1]] < values[rows[i]];
        let (gain, at) = cutting.best(&counts, apart)?;
        Some(Split { gain, test: Condition::Below(column, round_between(values[rows[at - 1]], values[rows[at]])) })
    }

    fn split_levels(
        &self,
        rows: &[usize],
        column: usize,
        values: &[usize],
        levels: usize,
        cutting: Cutting,
    ) -> Option<Split> {
        let mut counts = vec![[0, 0]; levels];
        for &row in rows {
            counts[values[row]][0] += 1;
            counts[values[row]][1] += usize::from(self.failed[row]);
        }
        let mut order: Vec<usize> = (0..levels).filter(|&level| counts[level][0] > 0).collect();
        let share = |level: usize| counts[level][1] as f64 / counts[level][0] as f64;
        order.sort_by(|&a, &b| share(b).total_cmp(&share(a)).then(a.cmp(&b)));
        let sorted: Vec<[usize; 2]> = order.iter().map(|&level| counts[level]).collect();
        let (gain, at) = cutting.best(&sorted, |_| true)?;
        let mut among = vec![false; levels];
        order[..at].iter().for_each(|&level| among[level] = true);
        Some(Split { gain, test: Condition::Among(column, among) })
    }
}

/// The weights of a passing and of a failing test.
#[derive(Debug, Clone, Copy)]
pub struct Weights {
    pass: f64,
    fail: f64,
}

impl Weights {
    /// Returns the weights that give passing and failing tests half of the total weight each.
    pub fn balanced(tests: usize, failures: usize) -> Self {
        let each = |of: usize| 0.5 * tests as f64 / of.max(1) as f64;
        Self { pass: each(tests - failures), fail: each(failures) }
    }

    /// Returns Gini's impurity times the weight of the tests: `2 p (1 - p) w`.
    fn impurity(self, [tests, failures]: [usize; 2]) -> f64 {
        let (pass, fail) = (self.pass * (tests - failures) as f64, self.fail * failures as f64);
        if tests == 0 { 0.0 } else { 2.0 * fail * pass / (fail + pass) }
    }
}

/// The rules for dividing rows into two parts.
#[derive(Debug, Clone, Copy)]
struct Cutting {
    weights: Weights,
    /// The least number of tests on either side.
    least: usize,
}

impl Cutting {
    /// Finds the best place to cut a list of (tests, failures), with the impurity that the cut removes. Only places
    /// for which `apart` is true are allowed.
    fn best(self, counts: &[[usize; 2]], apart: impl Fn(usize) -> bool) -> Option<(f64, usize)> {
        let all = counts.iter().fold([0, 0], |sum, count| [sum[0] + count[0], sum[1] + count[1]]);
        let mut left = [0, 0];
        let mut best: Option<(f64, usize)> = None;
        for cut in 1..counts.len() {
            left = [left[0] + counts[cut - 1][0], left[1] + counts[cut - 1][1]];
            let right = [all[0] - left[0], all[1] - left[1]];
            if !apart(cut) || left[0] < self.least || right[0] < self.least {
                continue;
            }
            let impurity = |side| self.weights.impurity(side);
            let gain = impurity(all) - impurity(left) - impurity(right);
            // A gain that only rounding explains does not count.
            if gain > 1e-9 && best.is_none_or(|(other, _)| gain > other) {
                best = Some((gain, cut));
            }
        }
        best
    }
}

/// Returns a number in the middle half of the interval from `a` to `b` with as few digits as possible.
pub fn round_between(a: f64, b: f64) -> f64 {
    let (middle, width) = (a + 0.5 * (b - a), b - a);
    for digits in -12_i32..=15 {
        let step = libm::exp10(f64::from(-digits));
        // The number goes through its text, so that it is exactly the number that the text shows.
        let number = (middle / step).round();
        let text =
            if digits > 0 { format!("{:.*}", digits as usize, number * step) } else { format!("{:.0}", number * step) };
        let near = text.parse::<f64>().ok().filter(|x| (x - middle).abs() <= 0.25 * width && a < *x && *x < b);
        if let Some(near) = near {
            return near;
        }
    }
    if a < middle && middle < b { middle } else { b }
}

impl Tree {
    /// Grows a tree for these rows, with at most `leaves` leaves of at least `least` tests each.
    pub fn grow(table: &Table, rows: &[usize], leaves: usize, least: usize) -> Self {
        let leaf = |rows: &[usize]| Node { tests: rows.len(), failures: table.failures(rows), split: None };
        let mut tree = Self { nodes: vec![leaf(rows)] };
        let weights = Weights::balanced(rows.len(), tree.nodes[0].failures);
        let mut open = vec![(0, rows.to_vec(), table.best_split(rows, weights, least))];
        for _ in 1..leaves {
            let gain = |split: &Option<Split>| split.as_ref().map_or(0.0, |split| split.gain);
            let best = (0..open.len()).rev().max_by(|&a, &b| gain(&open[a].2).total_cmp(&gain(&open[b].2)));
            let Some(best) = best.filter(|&best| open[best].2.is_some()) else { break };
            let (node, rows, Some(Split { test, .. })) = open.remove(best) else { break };
            let sides: (Vec<usize>, Vec<usize>) = rows.into_iter().partition(|&row| table.is_yes(&test, row));
            let children = [tree.nodes.len(), tree.nodes.len() + 1];
            for (child, rows) in children.into_iter().zip([sides.0, sides.1]) {
                tree.nodes.push(leaf(&rows));
                let split = table.best_split(&rows, weights, least);
                open.push((child, rows, split));
            }
            tree.nodes[node].split = Some((test, children));
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

    /// Checks whether a node predicts failure, which it does if a larger share of its tests failed than among all
    /// tests.
    fn says_fail(&self, node: &Node) -> bool {
        node.failures * self.nodes[0].tests > self.nodes[0].failures * node.tests
    }

    /// Returns `true` if the tree predicts that the test in a row fails.
    pub fn fails(&self, table: &Table, row: usize) -> bool {
        let mut at = &self.nodes[0];
        while let Some((test, [yes, no])) = &at.split {
            at = &self.nodes[if table.is_yes(test, row) { *yes } else { *no }];
        }
        self.says_fail(at)
    }

    /// Returns the tree without the splits of which both sides give the same prediction.
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
                Some((test, children)) => {
                    for (child, answer) in children.iter().zip([true, false]).rev() {
                        open.push((*child, path.iter().copied().chain([(test, answer)]).collect()));
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
    use proptest::prelude::*;

    fn tables() -> impl Strategy<Value = Table> {
        let row = (0..12_u32, 0..6_u32, 0..4_usize, any::<bool>());
        prop::collection::vec(row, 2..40).prop_map(|rows| Table {
            columns: vec![
                Column::Numbers(rows.iter().map(|row| f64::from(row.0) * 0.7).collect()),
                Column::Numbers(rows.iter().map(|row| f64::from(row.1) - 3.0).collect()),
                Column::Levels(rows.iter().map(|row| row.2).collect(), 4),
            ],
            failed: rows.iter().map(|row| row.3).collect(),
        })
    }

    /// `2 p (1 - p) w`, where p is the failing tests' share of the weight w, and all that fail weigh as much as all
    /// that pass.
    fn gini([tests, failures]: [usize; 2], [all, failing]: [usize; 2]) -> f64 {
        let share = |part: usize, of: usize| if part == 0 { 0.0 } else { part as f64 / of as f64 };
        let (fail, pass) = (share(failures, failing), share(tests - failures, all - failing));
        let p = if tests == 0 { 0.0 } else { fail / (fail + pass) };
        2.0 * p * (1.0 - p) * (fail + pass) * all as f64 / 2.0
    }

    /// The greatest gain of all divisions that one question can make: every threshold, and every set of levels.
    fn naive(table: &Table, least: usize) -> f64 {
        let n = table.failed.len();
        let of = [n, table.failed.iter().filter(|failed| **failed).count()];
        let gain = |yes: &dyn Fn(usize) -> bool| {
            let count = |side: bool| {
                let rows: Vec<usize> = (0..n).filter(|&row| yes(row) == side).collect();
                [rows.len(), rows.iter().filter(|&&row| table.failed[row]).count()]
            };
            let (yes, no) = (count(true), count(false));
            if yes[0].min(no[0]) < least {
                return 0.0;
            }
            gini([n, yes[1] + no[1]], of) - gini(yes, of) - gini(no, of)
        };
        let mut best = 0.0_f64;
        for column in &table.columns {
            match column {
                Column::Numbers(values) => {
                    for limit in values {
                        best = best.max(gain(&|row| values[row] < *limit));
                    }
                }
                Column::Levels(values, levels) => {
                    for set in 0..1_usize << levels {
                        best = best.max(gain(&|row| set >> values[row] & 1 == 1));
                    }
                }
            }
        }
        best
    }

    proptest! {
        #[test]
        fn the_best_split_is_that_of_a_search_through_all(table in tables(), least in 1..4_usize) {
            // With more than one test to a side the order of the levels is no proof any more, but of numbers all is
            // tried.
            let mut table = table;
            table.columns.truncate(if least == 1 { 3 } else { 2 });
            let rows: Vec<usize> = (0..table.failed.len()).collect();
            let of = [rows.len(), table.failures(&rows)];
            let found = table.best_split(&rows, Weights::balanced(of[0], of[1]), least);
            let gain = naive(&table, least);
            prop_assert!((found.as_ref().map_or(0.0, |split| split.gain) - gain).abs() < 1e-8, "{found:?} {gain}");
            if let Some(Split { gain, test }) = found {
                let count = |side: bool| {
                    let rows = rows.iter().filter(|&&row| table.is_yes(&test, row) == side);
                    [rows.clone().count(), rows.filter(|&&row| table.failed[row]).count()]
                };
                let (yes, no) = (count(true), count(false));
                prop_assert!((gini(of, of) - gini(yes, of) - gini(no, of) - gain).abs() < 1e-8);
            }
        }

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

        #[test]
        fn thresholds_lie_between_the_numbers_that_they_divide(a in -1e6..1e6_f64, width in 1e-9..1e4_f64) {
            let found = round_between(a, a + width);
            prop_assert!(a < found && found < a + width);
        }
    }

    #[test]
    fn thresholds_are_short() {
        let cases = [
            ((4.0632, 4.1719), 4.1),
            ((22.4, 23.9), 23.0),
            ((0.0, 1.0), 0.5),
            ((-3.0, -1.0), -2.0),
            ((0.19, 0.31), 0.25),
        ];
        for ((a, b), expected) in cases {
            assert_eq!(round_between(a, b), expected, "{a} {b}");
        }
        assert_eq!(round_between(1.0, 1.0_f64.next_up()), 1.0_f64.next_up());
    }
}
