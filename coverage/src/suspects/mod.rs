//! Which combinations of discrete values are behind the failures.
//!
//! A combination is *suspect* if some failing test contains it and no passing test does, and it is named only if
//! nothing smaller within it is suspect already. Suspects follow from the tests there are ([`suspects`]); which of
//! them is guilty, further tests decide ([`Locator`]).

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

/// So many suspects are kept, and looked for anew where there are more.
const KEPT: usize = 1 << 14;

/// A test that failed or passed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JudgedTest {
    /// A level for each parameter.
    pub levels: Vec<usize>,
    /// Whether it failed.
    pub failed: bool,
}

impl JudgedTest {
    /// Whether it has all of these (parameter, level) pairs.
    pub fn contains(&self, values: &[(usize, usize)]) -> bool {
        values.iter().all(|&(parameter, level)| self.levels[parameter] == level)
    }
}

/// A combination that failing tests contain and passing ones do not, and of which no part is such a combination.
#[derive(Debug, Clone, PartialEq)]
pub struct Suspect {
    /// Its (parameter, level) pairs, parameters in ascending order.
    pub values: Vec<(usize, usize)>,
    /// How many failing tests contain it; all that contain it failed.
    pub failures: usize,
    /// How suspect its values are on their own: of the tests with one value the share that failed, by Laplace's rule
    /// (failed + 1) / (all + 2), on average over the values. Values that are together by chance have the share that
    /// all tests have; those of a guilty combination have more.
    pub suspicion: f64,
}

impl Suspect {
    /// Smaller ones come first, then those that explain more failures, then those of the higher suspicion, then the
    /// lexicographic order of their values decides.
    fn order(&self, other: &Self) -> Ordering {
        let by_size = self.values.len().cmp(&other.values.len()).then(other.failures.cmp(&self.failures));
        by_size.then(other.suspicion.total_cmp(&self.suspicion)).then_with(|| self.values.cmp(&other.values))
    }
}

/// What tests say about the combinations behind the failures.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Suspects {
    /// The first of them: the smallest, among these those that explain most failures, among these those of the
    /// highest suspicion.
    pub ranked: Vec<Suspect>,
    /// How many there are in all.
    pub found: u64,
    /// Few suspects that together explain all failures that can be explained: the one that explains most of what is
    /// left, again and again (Chvátal's greedy set cover, at most ln n + 1 times as many as needed for n failures).
    pub explanation: Vec<Suspect>,
    /// The positions of the failing tests that contain no suspect of that size.
    pub unexplained: Vec<usize>,
    /// The positions of the tests that violate a constraint and so say nothing.
    pub invalid: Vec<usize>,
}

/// Finds the suspects of at most `size` values; the first `most` of them are listed.
///
/// Where no test failed or none passed, nothing tells combinations apart and there are no suspects. It takes memory
/// for the tests and for what is listed only.
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
/// `size` is 0 or more than there are parameters, or a test is none of this space.
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

/// Few suspects that explain what can be explained, and the failures that are left. Where not all suspects are given,
/// they are looked for each time.
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

/// Keeps the suspect that explains most of the failures in question, the first in order among equals.
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
