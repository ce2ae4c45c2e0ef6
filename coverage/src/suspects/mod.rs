//! Finds the combinations of discrete values that may cause the failures.
//!
//! A combination is *suspect* if some failing test contains it, no passing test contains it, and no smaller part of
//! it is suspect. [`suspects`] finds the suspects in the tests that there are. Further tests decide which suspect is
//! guilty ([`Locator`]).

mod located;
mod locator;
mod partial;
mod search;

pub use located::{Located, Standing};
pub use locator::{LocateError, Locator};

use crate::kwise::{KwiseError, check};
use paracosm_space::rules::Rules;
use search::{SuspectSearch, Visitor};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// The number of suspects that are kept. If there are more, they are searched again when they are needed.
const KEPT: usize = 1 << 14;

/// A test of discrete parameters with its result, failed or passed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JudgedTest {
    /// The level of each discrete parameter in the test.
    pub levels: Vec<usize>,
    /// `true` if the test failed.
    pub failed: bool,
}

impl JudgedTest {
    /// Returns `true` if the test has all given (parameter, level) pairs.
    pub fn contains(&self, values: &[(usize, usize)]) -> bool {
        values.iter().all(|&(parameter, level)| self.levels[parameter] == level)
    }
}

/// A minimal combination of values that failing tests contain and passing tests do not contain. No part of the
/// combination has this property.
#[derive(Debug, Clone, PartialEq)]
pub struct Suspect {
    /// The (parameter, level) pairs of the combination, in ascending order of parameters.
    pub values: Vec<(usize, usize)>,
    /// The number of failing tests that contain the suspect combination. No passing test contains the combination.
    pub failures: usize,
    /// The average over the combination's values of the share of failed tests among the tests with the value, between 0
    /// and 1. The share is estimated by Laplace's rule (failed + 1) / (all + 2). Values that are together by chance
    /// have about the share of all tests. The values of a guilty combination have a higher share.
    pub suspicion: f64,
}

impl Suspect {
    /// Compares two suspects by their ranks: first by size, the smaller before the larger; then by the failures that
    /// they explain, more before fewer; then by suspicion, higher before lower; then by the lexicographic order of
    /// their values.
    fn order(&self, other: &Self) -> Ordering {
        let by_size = self.values.len().cmp(&other.values.len()).then(other.failures.cmp(&self.failures));
        by_size.then(other.suspicion.total_cmp(&self.suspicion)).then_with(|| self.values.cmp(&other.values))
    }
}

/// The suspects of a set of tests, which are combinations of values that may cause the failures.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Suspects {
    /// The listed suspects in the order of their ranks. They are ordered by size, the smallest first; then by explained
    /// failures, the most first; then by suspicion, the highest first.
    pub ranked: Vec<Suspect>,
    /// The number of all suspects, listed or not.
    pub found: u64,
    /// A few suspects that together explain all failures that any suspect explains. Each is the suspect that explains
    /// most of the failures that are left (Chvátal's greedy set cover, at most ln n + 1 times as many as needed for n
    /// failures).
    pub explanation: Vec<Suspect>,
    /// The positions of the failing tests that contain no suspect of at most the given size.
    pub unexplained: Vec<usize>,
    /// The positions of the tests that violate a constraint and are therefore ignored.
    pub invalid: Vec<usize>,
}

/// Finds the combinations of at most `size` values that may cause the failures of tests. Lists the first `most`
/// suspects.
///
/// If no test failed or no test passed, combinations cannot be told apart and there are no suspects. The search takes
/// memory only for the tests and the listed suspects.
///
/// ```
/// use paracosm_space::rules::Rules;
/// use paracosm_coverage::suspects::{JudgedTest, suspects};
/// // Tests fail where the first two parameters are both at level 1.
/// let rows = [[0, 0, 0], [0, 1, 1], [1, 0, 1], [1, 1, 0], [1, 1, 1]];
/// let tests = rows.map(|row| JudgedTest { levels: row.to_vec(), failed: row[0] == 1 && row[1] == 1 });
/// let found = suspects(&Rules::free(&[2, 2, 2]), &tests, 2, 10)?;
/// assert_eq!(found.ranked[0].values, [(0, 1), (1, 1)]);
/// assert_eq!(found.explanation, found.ranked[..1]);
/// # Ok::<(), paracosm_coverage::kwise::KwiseError>(())
/// ```
///
/// # Errors
/// `size` is 0 or more than the number of parameters, or a test does not belong to this space.
pub fn suspects(rules: &Rules, tests: &[JudgedTest], size: usize, most: usize) -> Result<Suspects, KwiseError> {
    let levels = rules.levels();
    if size == 0 || size > levels.len() {
        return Err(KwiseError::Strength { k: size, parameters: levels.len() });
    }
    for (index, test) in tests.iter().enumerate() {
        check(levels, index, &test.levels)?;
    }
    let (valid, invalid): (Vec<usize>, Vec<usize>) =
        (0..tests.len()).partition(|&index| rules.allows(&tests[index].levels));
    let failing: Vec<usize> = valid.iter().copied().filter(|&index| tests[index].failed).collect();
    if failing.is_empty() || failing.len() == valid.len() {
        return Ok(Suspects { unexplained: failing, invalid, ..Suspects::default() });
    }
    let search = SuspectSearch::new(levels.len(), size, valid.iter().map(|&index| &tests[index]));

    let mut ranking = Ranking { most: most.max(KEPT), best: BinaryHeap::new(), found: 0 };
    search.visit(&search.failing(), &mut ranking);
    let Ranking { best, found, .. } = ranking;
    let mut ranked: Vec<Suspect> = best.into_sorted_vec().into_iter().map(|ranked| ranked.0).collect();

    let all = (found == ranked.len() as u64).then_some(&ranked[..]);
    let (explanation, left) = explain(&search, all);
    ranked.truncate(most);
    let unexplained = search::ones(&left).map(|failure| failing[failure]).collect();
    Ok(Suspects { ranked, found, explanation, unexplained, invalid })
}

/// A few suspects that explain the failures that can be explained, and the failures that are left. If not all
/// suspects are given, they are searched each time.
fn explain(search: &SuspectSearch, all: Option<&[Suspect]>) -> (Vec<Suspect>, Vec<u64>) {
    let mut left = search.failing();
    let mut explanation: Vec<Suspect> = Vec::new();
    loop {
        let mut greatest = Greatest(None);
        match all {
            None => search.visit(&left, &mut greatest),
            Some(all) => {
                for suspect in all {
                    let explained = search::count(&search.containing(&left, &suspect.values));
                    if explained > 0 && greatest.wants(suspect.values.len(), explained) {
                        greatest.see(suspect.clone(), explained);
                    }
                }
            }
        }
        let Some((_, next)) = greatest.0 else { return (explanation, left) };
        let explained = search.containing(&left, &next.values);
        left.iter_mut().zip(&explained).for_each(|(word, explained)| *word &= !explained);
        explanation.push(next);
    }
}

/// Keeps the first suspects in order and counts all.
struct Ranking {
    most: usize,
    best: BinaryHeap<Ranked>,
    found: u64,
}

impl Visitor for Ranking {
    fn wants(&self, _: usize, _: usize) -> bool {
        true
    }

    fn see(&mut self, suspect: Suspect, _: usize) {
        self.found += 1;
        self.best.push(Ranked(suspect));
        if self.best.len() > self.most {
            self.best.pop();
        }
    }
}

/// Keeps the suspect that explains most of the given failures; among equals, the first in the order of ranks.
struct Greatest(Option<(usize, Suspect)>);

impl Visitor for Greatest {
    fn wants(&self, size: usize, explained: usize) -> bool {
        let key = (explained, Reverse(size));
        self.0.as_ref().is_none_or(|(most, suspect)| key >= (*most, Reverse(suspect.values.len())))
    }

    fn see(&mut self, suspect: Suspect, explained: usize) {
        let better = |(most, before): &(usize, Suspect)| {
            explained.cmp(most).then_with(|| before.order(&suspect)) == Ordering::Greater
        };
        if self.0.as_ref().is_none_or(better) {
            self.0 = Some((explained, suspect));
        }
    }
}

/// A suspect in the order of the ranks.
struct Ranked(Suspect);

impl Ord for Ranked {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.order(&other.0)
    }
}

impl PartialOrd for Ranked {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Ranked {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ranked {}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_explanation_is_the_same_whether_suspects_are_kept_or_looked_for_anew(
            tests in prop::collection::vec((prop::collection::vec(0..3usize, 6), any::<bool>()), 2..=150),
            size in 1..=4usize,
        ) {
            let tests: Vec<JudgedTest> =
                tests.into_iter().map(|(levels, failed)| JudgedTest { levels, failed }).collect();
            let search = SuspectSearch::new(6, size, tests.iter());
            let mut ranking = Ranking { most: usize::MAX, best: BinaryHeap::new(), found: 0 };
            search.visit(&search.failing(), &mut ranking);
            let all: Vec<Suspect> = ranking.best.into_iter().map(|ranked| ranked.0).collect();
            prop_assert_eq!(explain(&search, Some(&all)), explain(&search, None));
        }
    }
}
