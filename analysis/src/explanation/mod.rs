//! Explains the failures of tests in words, by a decision tree of at most five leaves, with a measure of its accuracy.
//!
//! Cross-validation chooses the number of leaves and measures the accuracy: the outcome of each tenth of the tests is
//! predicted by a tree that was grown, and whose size was chosen, without these tests. Failing and passing tests have
//! the same total weight, so that rare failures are explained too. The explanation states the number of tests of a leaf
//! that fail, which may be less than half.

mod inconclusive;
mod table;
mod tree;
mod words;

pub use inconclusive::{Inconclusive, Place};
use paracosm_campaign::{Error, JsonArtefact, Log, Trial};
use paracosm_oracles::Verdict;
use serde::Serialize;
use table::{Column, Table};
use tree::Tree;
use words::Names;

/// The greatest number of leaves of a tree.
const MOST_LEAVES: usize = 5;

/// The least number of tests of a leaf: fewer tests do not justify a rule.
const LEAST_TESTS: usize = 3;

/// The number of parts that are left out in turn: `FOLDS` to measure the accuracy, `SIZE_FOLDS` to choose a size.
const FOLDS: usize = 10;
const SIZE_FOLDS: usize = 5;

/// The number of standard errors by which an explanation has to be better than chance.
const SURE: f64 = 2.0;

/// An explanation of the failures of a campaign.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explanation {
    /// The explanation as a sentence without a full stop.
    pub words: String,
    /// The number of tests of the campaign that passed or failed.
    pub tests: usize,
    /// The number of tests of the campaign that failed.
    pub failures: usize,
    /// The rules by which the explanation predicts failures. A test is predicted to fail if a rule holds. There are no
    /// rules if the tree does not find failing tests outside its own data better than chance by at least two standard
    /// errors.
    pub rules: Vec<Rule>,
    /// The accuracy of the predictions for tests that were left out when the decision tree was made.
    pub cross_validated: Accuracy,
    /// The accuracy of the predictions for the tests from which the decision tree was made.
    pub fitted: Accuracy,
    /// The accuracy of a prediction that always names the more frequent verdict.
    pub always: f64,
}

/// A rule, which is a set of conditions under which a larger share of tests fails than among all tests.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rule {
    /// The conditions of the rule in words, all of which have to hold.
    pub conditions: Vec<String>,
    /// The number of tests that satisfy all conditions of the rule.
    pub tests: usize,
    /// The number of tests that satisfy all conditions of the rule and failed.
    pub failures: usize,
}

/// The accuracy with which an explanation predicts the verdicts of tests.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Accuracy {
    /// The share of the tests whose verdict the explanation predicts correctly.
    pub accuracy: f64,
    /// The mean of the shares of correct predictions among the failing tests and among the passing tests.
    pub balanced: f64,
    /// The share of failing tests among the tests that are predicted to fail; `None` if no test is predicted to fail.
    pub precision: Option<f64>,
    /// The share of the failing tests that are predicted to fail.
    pub recall: f64,
}

impl JsonArtefact for Explanation {
    const FILE: &'static str = "explanation.json";
}

impl Explanation {
    /// Explains the failures of a campaign; `None` if fewer than three tests passed or fewer than three failed.
    ///
    /// # Errors
    /// A trial does not fit into the study's space.
    pub fn of(log: &Log) -> Result<Option<Self>, Error> {
        Self::without(log, &[])
    }

    /// Explains the failures of a campaign as [`Explanation::of`], by other parameters than those that are known to have no effect.
    ///
    /// # Errors
    /// A trial does not fit into the study's space.
    pub fn without(log: &Log, no_effect: &[&str]) -> Result<Option<Self>, Error> {
        let (mut table, names) = table(log, Question::Failures)?;
        for (column, (coordinate, _)) in names.columns().enumerate() {
            if no_effect.contains(&coordinate.parameter.name.as_str()) {
                table.flatten(column);
            }
        }
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

/// Returns the names of two continuous coordinates as the axes of a map. The coordinates that separate failing tests from passing tests
/// best take the place of names that are not given, in the order of the space. If fewer than three tests passed or fewer than three
/// failed, these are the first ones. `None` if the space has too few continuous coordinates.
///
/// # Errors
/// A trial does not fit into the study's space.
pub fn axes(log: &Log, given: [Option<&str>; 2]) -> Result<Option<[String; 2]>, Error> {
    let (table, names) = table(log, Question::Failures)?;
    let columns: Vec<_> = names.columns().collect();
    let rows: Vec<usize> = (0..table.failed.len()).collect();
    let failures = table.failed.iter().filter(|failed| **failed).count();
    let is_explained = failures.min(rows.len() - failures) >= LEAST_TESTS;
    let tree = if is_explained { Tree::grow(&table, &rows, MOST_LEAVES, LEAST_TESTS) } else { Tree::default() };
    let coordinates =
        columns.iter().map(|(coordinate, levels)| (coordinate.name(), levels)).zip(tree.gains(columns.len()));
    let mut free: Vec<(usize, f64, String)> = coordinates
        .enumerate()
        .filter(|(_, ((name, levels), _))| levels.is_none() && !given.contains(&Some(name.as_str())))
        .map(|(place, ((name, _), gain))| (place, gain, name))
        .collect();
    // A stable sort: coordinates that separate nothing keep the order of the space.
    free.sort_by(|a, b| b.1.total_cmp(&a.1));
    free.truncate(given.iter().filter(|name| name.is_none()).count());
    free.sort_by_key(|(place, ..)| *place);
    let mut free = free.into_iter().map(|(_, _, name)| name);
    let [x, y] = given.map(|name| name.map(str::to_owned).or_else(|| free.next()));
    Ok(x.zip(y).map(|(x, y)| [x, y]))
}

impl Explanation {
    /// Returns the rules of the explanation in words, one line for each rule.
    pub fn rules_in_words(&self) -> Vec<String> {
        words::rules(self)
    }

    /// Returns a sentence about the reliability of the rules, or about the absence of rules.
    pub fn trust_in_words(&self) -> String {
        words::trust(self)
    }
}

impl Accuracy {
    /// Returns the share of the passing tests that are predicted to fail.
    fn false_alarms(&self) -> f64 {
        1.0 + self.recall - 2.0 * self.balanced
    }

    /// Returns `true` if the failing tests are predicted to fail more often than the passing tests, by more than
    /// chance.
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

/// The question that a tree answers about a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Question {
    /// The question whether a test fails, of all that passed or failed.
    Failures,
    /// The question whether a test is inconclusive, of all that ran.
    Inconclusive,
}

impl Question {
    /// Returns the answer for a trial; `None` if the question does not concern it.
    fn answer(self, trial: &Trial) -> Option<bool> {
        match (self, trial.verdict) {
            (_, Verdict::Error | Verdict::Invalid) => None,
            (Self::Failures, Verdict::Fail | Verdict::Pass) => Some(trial.is_failure()),
            (Self::Failures, Verdict::Inconclusive | Verdict::Unpreventable) => None,
            (Self::Inconclusive, verdict) => Some(verdict == Verdict::Inconclusive),
        }
    }
}

/// Returns the tests that a question concerns as a table with a column for each coordinate. The answer `yes` stands for a failing test.
fn table(log: &Log, question: Question) -> Result<(Table, Names<'_>), Error> {
    let (space, trials) = (log.study().space(), log.trials());
    let (judged, answers): (Vec<&Trial>, Vec<bool>) =
        trials.iter().filter_map(|trial| Some((trial, question.answer(trial)?))).unzip();
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
            (None, None) => unreachable!("a coordinate without levels is a number"),
        });
    }
    Ok((Table::new(columns, answers), names))
}

/// Grows a tree for these rows and chooses the size that predicts left-out tests best, with equal weights of failing
/// and passing tests; of equal sizes the smallest. By plain accuracy rare failures would go unexplained, because the
/// prediction "passes" is right for most tests.
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

/// Predicts each row by trees that were grown without it, once for each of the trees that `grow` returns.
fn left_out(table: &Table, rows: &[usize], folds: usize, grow: impl Fn(&[usize]) -> Vec<Tree>) -> Vec<Vec<bool>> {
    // The tests of each verdict are distributed separately, in an order that is independent of the order of the
    // tests: every tenth point of a sequence would be a corner of the space.
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

/// Computes one step of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014), which shuffles.
fn mix(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

#[cfg(test)]
mod tests {
    use super::table::Condition;
    use super::*;

    /// A thousand tests in the plane that fail in a corner; every `wrong`-th verdict is turned around.
    fn corner(wrong: usize) -> Table {
        let at = |i: usize, by: u64| (mix(2 * i as u64 + by) >> 11) as f64 / (1_u64 << 53) as f64;
        let columns = [0, 1].map(|by| (0..1000).map(|i| at(i, by)).collect::<Vec<f64>>());
        let inside = |i: usize| columns[0][i] > 0.6 && columns[1][i] < 0.5;
        let failed = (0..1000).map(|i| inside(i) ^ (i % wrong == wrong - 1)).collect();
        Table::new(columns.map(Column::Numbers).to_vec(), failed)
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
        let rare = |row: usize| table.is_yes(&Condition::Below(0, 0.5), row);
        table.failed = (0..1000).map(|row| mix(row as u64 + 7000) % 100 < if rare(row) { 2 } else { 25 }).collect();
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
        // The verdicts are a hundred coin tosses. A tree learns some tosses by heart, but cannot predict other tosses.
        let column = |by: u64| Column::Numbers((0..100).map(|i| (mix(100 * by + i) % 997) as f64).collect());
        let columns = (0..8).map(column).collect();
        let table = Table::new(columns, (0..100).map(|i| mix(i + 5000).is_multiple_of(2)).collect());
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
