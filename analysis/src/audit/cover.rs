//! Set cover: the fewest tests that kill all mutants of a set.
//!
//! The greedy choice takes the test that kills most of the mutants that are left. It needs at most `1 + ln n` times the least number of
//! tests for `n` mutants (Chvátal, A greedy heuristic for the set-covering problem, Math. Oper. Res. 4, 1979). Mutants of which no two are
//! noticed in the same test give a lower bound: each of them needs a test of its own. If the two differ, a search by branch and bound looks
//! for fewer tests: some test has to kill the mutant with the fewest tests, so the search branches on these tests. It ends after a fixed
//! number of steps, so that the result is always the same.

/// The greatest number of steps of the search for fewer tests.
const STEPS: usize = 20_000;

/// Tests that kill all mutants, as positions, and how few such tests there can be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cover {
    /// The positions of the tests.
    pub tests: Vec<usize>,
    /// A lower bound on the number of tests.
    pub at_least: usize,
}

impl Cover {
    /// Chooses tests. `mutants` has the positions of the tests that notice each mutant, and there are `tests` tests in all.
    pub fn of(mutants: &[&[usize]], tests: usize) -> Self {
        let mutants = &hardest(mutants)[..];
        let mut best = greedy(mutants, tests);
        let at_least = apart(mutants);
        if best.len() == at_least {
            return Self { tests: best, at_least };
        }
        let mut steps = STEPS;
        let is_done = fewer(mutants, &mut Vec::new(), &mut best, &mut steps);
        let at_least = if is_done { best.len() } else { at_least };
        Self { tests: best, at_least }
    }
}

/// Returns the mutants that decide a cover. A test that kills a mutant kills all mutants that the same tests and more notice, so these
/// are left out.
fn hardest<'a>(mutants: &[&'a [usize]]) -> Vec<&'a [usize]> {
    let mut order = mutants.to_vec();
    order.sort_by_key(|of| of.len());
    let mut kept: Vec<&[usize]> = Vec::new();
    for of in order {
        if !kept.iter().any(|known| known.iter().all(|test| of.contains(test))) {
            kept.push(of);
        }
    }
    kept
}

/// Looks for a cover with fewer tests than `best`, which begins with the tests in `taken`. `left` has the mutants that these do not
/// kill. Returns `false` if the steps did not suffice.
fn fewer(left: &[&[usize]], taken: &mut Vec<usize>, best: &mut Vec<usize>, steps: &mut usize) -> bool {
    let Some(hardest) = left.iter().min_by_key(|of| of.len()) else {
        if taken.len() < best.len() {
            best.clone_from(taken);
        }
        return true;
    };
    if taken.len() + apart(left) >= best.len() {
        return true;
    }
    for test in *hardest {
        let Some(fewer_steps) = steps.checked_sub(1) else { return false };
        *steps = fewer_steps;
        let rest: Vec<&[usize]> = left.iter().copied().filter(|of| !of.contains(test)).collect();
        taken.push(*test);
        let is_done = fewer(&rest, taken, best, steps);
        taken.pop();
        if !is_done {
            return false;
        }
    }
    true
}

/// Returns tests of which each mutant has one. `mutants` has the tests of each mutant, and there are `tests` tests in all.
fn greedy(mutants: &[&[usize]], tests: usize) -> Vec<usize> {
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
        assert_eq!(Cover::of(&mutants, 4), Cover { tests: vec![2, 3], at_least: 2 });
        assert!(Cover::of(&[], 4).tests.is_empty());
    }

    #[test]
    fn the_search_finds_fewer_tests_than_the_greedy_choice() {
        // Test 0 kills four mutants, but tests 1 and 2 kill all six.
        let mutants: [&[usize]; 6] = [&[0, 1], &[0, 1], &[1], &[0, 2], &[0, 2], &[2]];
        assert_eq!(greedy(&mutants, 3).len(), 3);
        let Cover { mut tests, at_least } = Cover::of(&mutants, 3);
        tests.sort_unstable();
        assert_eq!((tests, at_least), (vec![1, 2], 2));
    }

    /// The least number of tests, by trying all sets.
    fn least(mutants: &[Vec<usize>], tests: usize) -> usize {
        let kills_all = |set: u32| mutants.iter().all(|of| of.iter().any(|test| set >> test & 1 == 1));
        (0..1_u32 << tests).filter(|set| kills_all(*set)).map(u32::count_ones).min().unwrap() as usize
    }

    proptest! {
        #[test]
        fn all_mutants_are_killed_by_the_least_number_of_tests(
            mutants in proptest::collection::vec(proptest::collection::btree_set(0..8_usize, 1..5), 0..12)
        ) {
            let mutants: Vec<Vec<usize>> = mutants.into_iter().map(|of| of.into_iter().collect()).collect();
            let slices: Vec<&[usize]> = mutants.iter().map(Vec::as_slice).collect();
            let Cover { tests, at_least } = Cover::of(&slices, 8);
            prop_assert!(mutants.iter().all(|of| of.iter().any(|test| tests.contains(test))));
            let least = least(&mutants, 8);
            prop_assert!(apart(&slices) <= least && least <= greedy(&slices, 8).len());
            // So small a search ends.
            prop_assert_eq!((tests.len(), at_least), (least, least));
        }
    }
}
