//! The tests as a table, and the divisions of its rows that separate failing tests from passing tests best.
//!
//! Every split reduces Gini's impurity most, over all columns and all places between two different
//! numbers (Breiman, Friedman, Olshen and Stone, "Classification and Regression Trees", 1984). Levels without an order
//! are first sorted by their share of failures. For two classes no division of the levels is better than the best
//! division in this order (their theorem 4.5; splits with too few tests on a side are skipped).
//!
//! Each column of numbers is sorted once, for all trees.

/// A column of the table that a decision tree explains, with a value for each test.
#[derive(Debug, Clone)]
pub enum Column {
    /// A column of numbers, one number for each test.
    Numbers(Vec<f64>),
    /// A column of levels without an order, and the number of levels.
    Levels(Vec<usize>, usize),
}

/// The tests as columns of values, with a mark for each test that failed. Each test is a row.
#[derive(Debug, Clone)]
pub struct Table {
    columns: Vec<Column>,
    pub failed: Vec<bool>,
    /// The rows in the order of each column of numbers; no rows for a column of levels.
    orders: Vec<Vec<u32>>,
}

/// The rows of a table that reach a node. The rows are never sorted again, because a part of sorted rows is sorted.
pub struct Part {
    rows: Vec<u32>,
    /// The rows of the part, in the orders of the table.
    orders: Vec<Vec<u32>>,
}

/// The condition at a node of a tree.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// The condition that the number in a column is below a limit.
    Below(usize, f64),
    /// The condition that the level in a column is one of the levels marked `true`.
    Among(usize, Vec<bool>),
}

impl Condition {
    /// Returns the column that the condition is about.
    pub fn column(&self) -> usize {
        match self {
            Self::Below(column, _) | Self::Among(column, _) => *column,
        }
    }
}

/// A division of tests into two parts by a condition.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// The decrease of Gini's impurity by the split, in weighted tests.
    pub gain: f64,
    pub condition: Condition,
}

impl Column {
    /// Returns the rows in the order of the numbers. Rows with equal numbers keep the order of the table.
    fn order(&self) -> Vec<u32> {
        let Self::Numbers(numbers) = self else { return Vec::new() };
        let mut rows: Vec<u32> = (0..numbers.len() as u32).collect();
        rows.sort_by(|&a, &b| numbers[a as usize].total_cmp(&numbers[b as usize]));
        rows
    }
}

impl Part {
    /// Makes the part with the given rows.
    pub fn of(table: &Table, rows: &[usize]) -> Self {
        let mut is_in = vec![false; table.failed.len()];
        rows.iter().for_each(|&row| is_in[row] = true);
        Self { rows: rows.iter().map(|&row| row as u32).collect(), orders: chosen(&table.orders, &is_in) }
    }

    /// Returns the numbers of tests and of failures.
    pub fn counts(&self, table: &Table) -> [usize; 2] {
        [self.rows.len(), self.rows.iter().filter(|&&row| table.failed[row as usize]).count()]
    }

    /// Returns the part that fulfils a condition, and the part that does not.
    pub fn divided(&self, table: &Table, condition: &Condition) -> [Self; 2] {
        let is_yes: Vec<bool> = (0..table.failed.len()).map(|row| table.is_yes(condition, row)).collect();
        let is_no: Vec<bool> = is_yes.iter().map(|yes| !yes).collect();
        [is_yes, is_no].map(|is_in| {
            let rows = self.rows.iter().copied().filter(|&row| is_in[row as usize]).collect();
            Self { rows, orders: chosen(&self.orders, &is_in) }
        })
    }
}

/// Returns the rows of some orders that are in a part.
fn chosen(orders: &[Vec<u32>], is_in: &[bool]) -> Vec<Vec<u32>> {
    orders.iter().map(|order| order.iter().copied().filter(|&row| is_in[row as usize]).collect()).collect()
}

impl Table {
    /// Makes all values of a column equal, so that no condition is about the column.
    pub fn flatten(&mut self, column: usize) {
        self.columns[column] = match &self.columns[column] {
            Column::Numbers(numbers) => Column::Numbers(vec![0.0; numbers.len()]),
            Column::Levels(rows, levels) => Column::Levels(vec![0; rows.len()], *levels),
        };
    }

    /// Makes a table. Each column has a value for each test.
    pub fn new(columns: Vec<Column>, failed: Vec<bool>) -> Self {
        let orders = columns.iter().map(Column::order).collect();
        Self { columns, failed, orders }
    }

    /// Returns `true` if the value of the row fulfils the condition.
    pub fn is_yes(&self, condition: &Condition, row: usize) -> bool {
        match condition {
            Condition::Below(column, limit) => {
                matches!(&self.columns[*column], Column::Numbers(all) if all[row] < *limit)
            }
            Condition::Among(column, levels) => {
                matches!(&self.columns[*column], Column::Levels(all, _) if levels[all[row]])
            }
        }
    }

    /// Finds the best split of these rows with at least `least` rows on either side. Of equal splits it returns the
    /// first split.
    pub fn best_split(&self, part: &Part, weights: Weights, least: usize) -> Option<Split> {
        let cutting = Cutting { weights, least };
        let splits = (0..self.columns.len()).filter_map(|column| match &self.columns[column] {
            Column::Numbers(values) => self.split_numbers(&part.orders[column], column, values, cutting),
            Column::Levels(values, levels) => self.split_levels(&part.rows, column, values, *levels, cutting),
        });
        splits.fold(None, |best: Option<Split>, split| match best {
            Some(best) if best.gain >= split.gain => Some(best),
            _ => Some(split),
        })
    }

    /// Finds the best split by the numbers of a column, for rows in the order of these numbers.
    fn split_numbers(&self, order: &[u32], column: usize, numbers: &[f64], cutting: Cutting) -> Option<Split> {
        let counts: Vec<[usize; 2]> = order.iter().map(|&row| [1, usize::from(self.failed[row as usize])]).collect();
        let number = |i: usize| numbers[order[i] as usize];
        let (gain, at) = cutting.best(&counts, |i| number(i - 1) < number(i))?;
        Some(Split { gain, condition: Condition::Below(column, round_between(number(at - 1), number(at))) })
    }

    fn split_levels(
        &self,
        rows: &[u32],
        column: usize,
        values: &[usize],
        levels: usize,
        cutting: Cutting,
    ) -> Option<Split> {
        let mut counts = vec![[0, 0]; levels];
        for row in rows.iter().map(|&row| row as usize) {
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
        Some(Split { gain, condition: Condition::Among(column, among) })
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

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(in crate::explanation) fn tables() -> impl Strategy<Value = Table> {
        let row = (0..12_u32, 0..6_u32, 0..4_usize, any::<bool>());
        prop::collection::vec(row, 2..40).prop_map(|rows| {
            let columns = vec![
                Column::Numbers(rows.iter().map(|row| f64::from(row.0) * 0.7).collect()),
                Column::Numbers(rows.iter().map(|row| f64::from(row.1) - 3.0).collect()),
                Column::Levels(rows.iter().map(|row| row.2).collect(), 4),
            ];
            Table::new(columns, rows.iter().map(|row| row.3).collect())
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
            let mut columns = table.columns;
            columns.truncate(if least == 1 { 3 } else { 2 });
            let table = Table::new(columns, table.failed);
            let rows: Vec<usize> = (0..table.failed.len()).collect();
            let of = [rows.len(), table.failed.iter().filter(|failed| **failed).count()];
            let found = table.best_split(&Part::of(&table, &rows), Weights::balanced(of[0], of[1]), least);
            let gain = naive(&table, least);
            prop_assert!((found.as_ref().map_or(0.0, |split| split.gain) - gain).abs() < 1e-8, "{found:?} {gain}");
            if let Some(Split { gain, condition }) = found {
                let count = |side: bool| {
                    let rows = rows.iter().filter(|&&row| table.is_yes(&condition, row) == side);
                    [rows.clone().count(), rows.filter(|&&row| table.failed[row]).count()]
                };
                let (yes, no) = (count(true), count(false));
                prop_assert!((gini(of, of) - gini(yes, of) - gini(no, of) - gain).abs() < 1e-8);
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
