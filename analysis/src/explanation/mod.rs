//! Why tests fail, in words: a decision tree of at most five leaves, with how far it can be trusted.
//!
//! How many leaves it has is chosen by cross-validation, and so is its accuracy: each tenth of the tests is told by a tree
//! that was grown, and whose size was chosen, without it. Failing and passing tests weigh the same, so that rare failures
//! are explained too; how many tests of a leaf fail is said, as it may be less than half.

mod tree;
mod words;

use paracosm_campaign::{Error, JsonArtefact, Log, Trial};
use paracosm_oracles::Verdict;
use serde::Serialize;
use tree::{Column, Table, Tree};
use words::Names;

/// A tree has at most so many leaves.
const MOST_LEAVES: usize = 5;

/// A leaf has at least so many tests: fewer are no rule.
const LEAST_TESTS: usize = 3;

/// So many parts are left out in turn: when accuracy is measured, and when a size is chosen.
const FOLDS: usize = 10;
const SIZE_FOLDS: usize = 5;

/// By how many standard errors an explanation has to be better than chance.
const SURE: f64 = 2.0;

/// Which tests of a campaign fail, in words.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explanation {
    /// The explanation as a sentence without its end.
    pub words: String,
    /// How many tests passed or failed.
    pub tests: usize,
    /// How many of them failed.
    pub failures: usize,
    /// The rules: a test fails if one of them holds. None where they would find failing tests that they were not made from
    /// no better than chance does: not by two standard errors.
    pub rules: Vec<Rule>,
    /// How often the explanation is right of tests that it was not made from.
    pub cross_validated: Accuracy,
    /// How often it is right of those that it was made from.
    pub fitted: Accuracy,
    /// The accuracy of always saying the more frequent verdict.
    pub always: f64,
}

/// Conditions under which a larger share of the tests fails than of all.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rule {
    /// What has to hold, all of it.
    pub conditions: Vec<String>,
    /// How many tests there are like this.
    pub tests: usize,
    /// How many of them failed.
    pub failures: usize,
}

/// How often an explanation is right.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Accuracy {
    /// The share of the tests that it tells right.
    pub accuracy: f64,
    /// The mean of that share among the failing and among the passing tests.
    pub balanced: f64,
    /// The share of failing tests among those it says fail; `None` where it says so of none.
    pub precision: Option<f64>,
    /// The share of the failing tests that it says fail.
    pub recall: f64,
}

impl JsonArtefact for Explanation {
    const FILE: &'static str = "explanation.json";
}

impl Explanation {
    /// The explanation of a campaign; `None` where less than three tests passed, or less than three failed.
    ///
    /// # Errors
    /// A trial is none of the study's space.
    pub fn of(log: &Log) -> Result<Option<Self>, Error> {
        let (table, names) = table(log)?;
        let failures = table.failed.iter().filter(|failed| **failed).count();
        let tests = table.failed.len();
        if failures.min(tests - failures) < LEAST_TESTS {
            return Ok(None);
        }
        let rows: Vec<usize> = (0..tests).collect();
        let tree = chosen(&table, &rows);
        let rules = tree.failing().into_iter().map(|(path, leaf)| Rule {
            conditions: names.conditions(&path),
            tests: leaf.tests,
            failures: leaf.failures,
        });
        let mut rules: Vec<Rule> = rules.collect();
        let left_out = left_out(&table, &rows, FOLDS, |rows| vec![chosen(&table, rows)]);
        let fitted: Vec<bool> = rows.iter().map(|&row| tree.fails(&table, row)).collect();
        let cross_validated = Accuracy::of(&left_out[0], &table.failed);
        if !cross_validated.is_better_than_chance(failures, tests - failures) {
            rules.clear();
        }
        let mut explanation = Self {
            words: String::new(),
            tests,
            failures,
            rules,
            cross_validated,
            fitted: Accuracy::of(&fitted, &table.failed),
            always: failures.max(tests - failures) as f64 / tests as f64,
        };
        explanation.words = words::sentence(&explanation);
        Ok(Some(explanation))
    }
}

impl Explanation {
    /// When tests fail, a line for each rule.
    pub fn rules_in_words(&self) -> Vec<String> {
        words::rules(self)
    }

    /// How far the rules can be trusted, or that there are none.
    pub fn trust_in_words(&self) -> String {
        words::trust(self)
    }
}

impl Accuracy {
    /// The share of the passing tests that it says fail.
    fn false_alarms(&self) -> f64 {
        1.0 + self.recall - 2.0 * self.balanced
    }

    /// Whether it says fail more often of failing tests than of passing ones, and by more than chance would make it.
    fn is_better_than_chance(&self, failing: usize, passing: usize) -> bool {
        let found = self.recall;
        let alarms = self.false_alarms();
        let variance = found * (1.0 - found) / failing as f64 + alarms * (1.0 - alarms) / passing as f64;
        found - alarms > SURE * libm::sqrt(variance)
    }

    fn of(told: &[bool], failed: &[bool]) -> Self {
        let count = |says: bool, is: bool| told.iter().zip(failed).filter(|pair| pair == &(&says, &is)).count() as f64;
        let (hits, alarms, misses, rest) =
            (count(true, true), count(true, false), count(false, true), count(false, false));
        let recall = hits / (hits + misses);
        Self {
            accuracy: (hits + rest) / told.len() as f64,
            balanced: 0.5 * (recall + rest / (rest + alarms)),
            precision: (hits + alarms > 0.0).then(|| hits / (hits + alarms)),
            recall,
        }
    }
}

/// The tests that passed or failed, a column for each coordinate.
fn table(log: &Log) -> Result<(Table, Names<'_>), Error> {
    let (space, trials) = (log.study().space(), log.trials());
    let judged: Vec<&Trial> = trials.iter().filter(|t| matches!(t.verdict, Verdict::Fail | Verdict::Pass)).collect();
    let names = Names::of(space);
    let points = judged.iter().map(|trial| space.encode(&trial.test)).collect::<Result<Vec<_>, _>>()?;
    let mut columns = Vec::new();
    for (coordinate, levels) in names.columns() {
        let value = |trial: &&Trial| coordinate.value(trial.test.get(&coordinate.parameter.name)?)?.number();
        let numbers: Option<Vec<f64>> = judged.iter().map(value).collect();
        columns.push(match (numbers, levels) {
            (Some(numbers), _) => Column::Numbers(numbers),
            (None, Some((index, count))) => {
                Column::Levels(points.iter().map(|point| point.discrete[index]).collect(), count)
            }
            (None, None) => unreachable!("what has no levels is a number"),
        });
    }
    Ok((Table { columns, failed: judged.iter().map(|trial| trial.is_failure()).collect() }, names))
}

/// The tree of these rows, as large as tells left-out tests best, failing and passing ones weighing the same in all; of
/// equals the smallest. By plain accuracy rare failures would go unexplained: always saying "passes" is right too often.
fn chosen(table: &Table, rows: &[usize]) -> Tree {
    let all = |rows: &[usize]| {
        let tree = Tree::grow(table, rows, MOST_LEAVES, LEAST_TESTS);
        (1..=MOST_LEAVES).map(|leaves| tree.with_leaves(leaves)).collect::<Vec<_>>()
    };
    let told = left_out(table, rows, SIZE_FOLDS, all);
    let failed: Vec<bool> = rows.iter().map(|&row| table.failed[row]).collect();
    let right = |size: usize| Accuracy::of(&told[size], &failed).balanced;
    let best = (0..MOST_LEAVES).rev().max_by(|&a, &b| right(a).total_cmp(&right(b))).expect("there are sizes");
    all(rows).swap_remove(best).pruned()
}

/// What is said of each row by trees that were grown without it: for each of the trees that `grow` makes.
fn left_out(table: &Table, rows: &[usize], folds: usize, grow: impl Fn(&[usize]) -> Vec<Tree>) -> Vec<Vec<bool>> {
    // Each verdict is dealt out by itself, in an order that has nothing to do with that of the tests: every tenth point of a
    // sequence would be a corner of the space.
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by_key(|&i| (table.failed[rows[i]], mix(i as u64)));
    let mut fold_of = vec![0; rows.len()];
    order.iter().enumerate().for_each(|(rank, &i)| fold_of[i] = rank % folds);
    let mut told: Vec<Vec<bool>> = Vec::new();
    for fold in 0..folds {
        let others: Vec<usize> = (0..rows.len()).filter(|&i| fold_of[i] != fold).map(|i| rows[i]).collect();
        let trees = grow(&others);
        told.resize(trees.len(), vec![false; rows.len()]);
        for (tree, told) in trees.iter().zip(&mut told) {
            (0..rows.len()).filter(|&i| fold_of[i] == fold).for_each(|i| told[i] = tree.fails(table, rows[i]));
        }
    }
    told
}

/// One step of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): it shuffles.
fn mix(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A thousand tests in the plane that fail in a corner; every `wrong`-th verdict is turned around.
    fn corner(wrong: usize) -> Table {
        let at = |i: usize, by: u64| (mix(2 * i as u64 + by) >> 11) as f64 / (1_u64 << 53) as f64;
        let columns = [0, 1].map(|by| (0..1000).map(|i| at(i, by)).collect::<Vec<f64>>());
        let inside = |i: usize| columns[0][i] > 0.6 && columns[1][i] < 0.5;
        let failed = (0..1000).map(|i| inside(i) ^ (i % wrong == wrong - 1)).collect();
        Table { columns: columns.map(Column::Numbers).to_vec(), failed }
    }

    #[test]
    fn a_corner_is_found_with_no_more_leaves_than_it_takes() {
        let table = corner(2000);
        let rows: Vec<usize> = (0..1000).collect();
        let tree = chosen(&table, &rows);
        assert_eq!((tree.nodes.len(), tree.failing().len()), (5, 1));
        // A split may go past single tests beyond the corner's edge.
        let right = rows.iter().filter(|&&row| tree.fails(&table, row) == table.failed[row]).count();
        assert!(right >= 990, "{right}");
    }

    #[test]
    fn rare_failures_are_found_where_nowhere_most_tests_fail() {
        // In a half of the plane a quarter of the tests fails, in the other one hardly any.
        let mut table = corner(2000);
        let Column::Numbers(x) = &table.columns[0] else { unreachable!("they are numbers") };
        table.failed = (0..1000).map(|i| mix(i as u64 + 7000) % 100 < if x[i] > 0.5 { 25 } else { 2 }).collect();
        let rows: Vec<usize> = (0..1000).collect();
        let told = left_out(&table, &rows, FOLDS, |rows| vec![chosen(&table, rows)]);
        let found = Accuracy::of(&told[0], &table.failed);
        let failures = table.failed.iter().filter(|failed| **failed).count();
        assert!(found.recall > 0.8 && found.false_alarms() < 0.6, "{found:?}");
        assert!(found.is_better_than_chance(failures, 1000 - failures), "{found:?}");
        let tree = chosen(&table, &rows);
        let failing = tree.failing();
        assert!(failing.iter().any(|(_, leaf)| 2 * leaf.failures < leaf.tests), "{failing:?}");
    }

    #[test]
    fn what_cannot_be_known_is_not_in_the_accuracy_of_left_out_tests() {
        // Of a hundred coins that depend on nothing a tree learns some by heart, but not those that it was not shown.
        let column = |by: u64| Column::Numbers((0..100).map(|i| (mix(100 * by + i) % 997) as f64).collect());
        let columns = (0..8).map(column).collect();
        let table = Table { columns, failed: (0..100).map(|i| mix(i + 5000).is_multiple_of(2)).collect() };
        let rows: Vec<usize> = (0..100).collect();
        let told = left_out(&table, &rows, FOLDS, |rows| vec![Tree::grow(&table, rows, MOST_LEAVES, 1)]);
        let left_out = Accuracy::of(&told[0], &table.failed);
        let tree = Tree::grow(&table, &rows, MOST_LEAVES, 1);
        let fitted: Vec<bool> = rows.iter().map(|&row| tree.fails(&table, row)).collect();
        assert!(Accuracy::of(&fitted, &table.failed).accuracy > 0.6);
        assert!((0.3..0.6).contains(&left_out.accuracy), "{left_out:?}");
    }

    #[test]
    fn what_finds_hardly_any_failing_test_is_no_better_than_chance() {
        let accuracy = |recall: f64, alarms: f64| Accuracy {
            accuracy: 0.9,
            balanced: 0.5 * (recall + 1.0 - alarms),
            precision: None,
            recall,
        };
        assert!(accuracy(0.4, 0.06).is_better_than_chance(65, 435));
        assert!(!accuracy(0.03, 0.006).is_better_than_chance(68, 432));
        assert!(!accuracy(0.3, 0.3).is_better_than_chance(65, 435));
        assert!(accuracy(1.0, 0.0).is_better_than_chance(3, 3));
    }

    #[test]
    fn accuracies_are_counted() {
        let told = [true, true, true, false, false, false, false, false];
        let failed = [true, true, false, true, true, false, false, false];
        let found = Accuracy::of(&told, &failed);
        assert_eq!(found, Accuracy { accuracy: 0.625, balanced: 0.625, precision: Some(2.0 / 3.0), recall: 0.5 });
        assert_eq!(Accuracy::of(&[false; 2], &[false, true]).precision, None);
    }
}
