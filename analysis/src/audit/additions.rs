//! Additions to a suite: few tests that kill the mutants which the suite misses.
//!
//! The tests come from the screen, where each mutant is noticed by some test. To choose the fewest of them is a set cover. The greedy
//! choice takes the test that kills most of the mutants that are left; it needs at most `1 + ln n` times the least number of tests for
//! `n` mutants (Chvátal, A greedy heuristic for the set-covering problem, Math. Oper. Res. 4, 1979). Mutants of which no two are noticed
//! in the same test give a lower bound: each of them needs a test of its own.

use super::Screen;
use super::bout::Tried;
use paracosm_space::Values;
use serde::Serialize;

/// Tests that kill all mutants which a suite misses.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Additions {
    /// The number of mutants that the suite misses.
    pub missed: usize,
    /// The tests, from the test that kills most of them on.
    pub tests: Vec<Values>,
    /// A lower bound on the number of tests of the screen that kill all of them.
    pub at_least: usize,
}

impl Additions {
    /// Chooses tests of a screen for a suite, which is named by its position.
    pub(super) fn of(screen: &Screen, tried: &[Tried], suite: usize) -> Self {
        let missed = screen.mutants.iter().zip(tried).filter(|(_, tried)| tried.kills[suite].is_none());
        let missed: Vec<&[usize]> = missed.map(|(noticed, _)| &noticed.tests[..]).collect();
        let tests = chosen(&missed, screen.values.len()).into_iter().map(|test| screen.values[test].clone()).collect();
        Self { missed: missed.len(), tests, at_least: apart(&missed) }
    }
}

/// Returns tests of which each mutant has one. `mutants` has the tests of each mutant, and there are `tests` tests in all.
fn chosen(mutants: &[&[usize]], tests: usize) -> Vec<usize> {
    let mut left: Vec<&[usize]> = mutants.to_vec();
    let mut chosen = Vec::new();
    while !left.is_empty() {
        let mut kills = vec![0_usize; tests];
        left.iter().flat_map(|of| of.iter()).for_each(|test| kills[*test] += 1);
        // The first of the best, so that the result is always the same.
        let Some(best) = (0..tests).rev().max_by_key(|test| kills[*test]).filter(|best| kills[*best] > 0) else {
            break;
        };
        left.retain(|of| !of.contains(&best));
        chosen.push(best);
    }
    chosen
}

/// Returns a number of mutants of which no two have a test in common. Mutants with few tests come first.
fn apart(mutants: &[&[usize]]) -> usize {
    let mut order = mutants.to_vec();
    order.sort_by_key(|of| of.len());
    let mut used: Vec<usize> = Vec::new();
    let mut count = 0;
    for of in order {
        if !of.iter().any(|test| used.contains(test)) {
            used.extend(of);
            count += 1;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_test_that_kills_most_comes_first() {
        let mutants: [&[usize]; 4] = [&[0, 2], &[1, 2], &[2], &[3]];
        assert_eq!(chosen(&mutants, 4), [2, 3]);
        assert_eq!(apart(&mutants), 2);
        assert!(chosen(&[], 4).is_empty());
    }

    /// The least number of tests, by trying all sets.
    fn least(mutants: &[Vec<usize>], tests: usize) -> usize {
        let kills_all = |set: u32| mutants.iter().all(|of| of.iter().any(|test| set >> test & 1 == 1));
        (0..1_u32 << tests).filter(|set| kills_all(*set)).map(u32::count_ones).min().unwrap() as usize
    }

    proptest! {
        #[test]
        fn all_mutants_are_killed_and_the_least_number_lies_between_the_bounds(
            mutants in proptest::collection::vec(proptest::collection::btree_set(0..8_usize, 1..5), 0..12)
        ) {
            let mutants: Vec<Vec<usize>> = mutants.into_iter().map(|of| of.into_iter().collect()).collect();
            let slices: Vec<&[usize]> = mutants.iter().map(Vec::as_slice).collect();
            let found = chosen(&slices, 8);
            prop_assert!(mutants.iter().all(|of| of.iter().any(|test| found.contains(test))));
            let least = least(&mutants, 8);
            prop_assert!(apart(&slices) <= least && least <= found.len());
        }
    }
}
