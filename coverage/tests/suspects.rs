//! Suspect combinations, against looking at every combination of every size.

#[path = "../../space/tests/models/mod.rs"]
mod models;

use models::{all_tests, keeps, models};
use paracosm_coverage::suspects::{JudgedTest, Suspects, suspects};
use paracosm_space::rules::Rules;
use proptest::prelude::*;

type Values = Vec<(usize, usize)>;

fn contains(test: &JudgedTest, values: &[(usize, usize)]) -> bool {
    values.iter().all(|&(parameter, level)| test.levels[parameter] == level)
}

/// All combinations of so many values.
fn combinations(levels: &[usize], size: usize, from: usize) -> Vec<Values> {
    if size == 0 {
        return vec![vec![]];
    }
    let heads = (from..levels.len()).flat_map(|parameter| (0..levels[parameter]).map(move |level| (parameter, level)));
    heads
        .flat_map(|head| {
            combinations(levels, size - 1, head.0 + 1).into_iter().map(move |tail| [vec![head], tail].concat())
        })
        .collect()
}

fn failures(tests: &[JudgedTest], values: &[(usize, usize)]) -> Vec<usize> {
    (0..tests.len()).filter(|&test| tests[test].failed && contains(&tests[test], values)).collect()
}

fn is_suspect(tests: &[JudgedTest], values: &[(usize, usize)]) -> bool {
    !failures(tests, values).is_empty() && !tests.iter().any(|test| !test.failed && contains(test, values))
}

/// The suspects in order with their failures: all those none of whose proper parts is one.
fn brute_force(levels: &[usize], tests: &[JudgedTest], size: usize) -> Vec<Values> {
    let mut found: Vec<(usize, usize, f64, Values)> = Vec::new();
    for size in 1..=size {
        for values in combinations(levels, size, 0) {
            let part =
                |bits: usize| -> Values { (0..size).filter(|i| bits >> i & 1 == 1).map(|i| values[i]).collect() };
            if is_suspect(tests, &values) && !(0..(1 << size) - 1).any(|bits| is_suspect(tests, &part(bits))) {
                let share = |&value: &(usize, usize)| {
                    let with: Vec<_> = tests.iter().filter(|test| contains(test, &[value])).collect();
                    let failed = with.iter().filter(|test| test.failed).count();
                    (failed + 1) as f64 / (with.len() + 2) as f64
                };
                let suspicion = values.iter().map(share).sum::<f64>() / size as f64;
                found.push((size, failures(tests, &values).len(), suspicion, values));
            }
        }
    }
    found.sort_by(|a, b| (a.0, b.1).cmp(&(b.0, a.1)).then(b.2.total_cmp(&a.2)).then(a.3.cmp(&b.3)));
    found.into_iter().map(|(.., values)| values).collect()
}

/// The failures left over, and the suspects that explain the others: most of what is left first.
fn cover(tests: &[JudgedTest], ranked: &[Values]) -> (Vec<Values>, Vec<usize>) {
    let mut left = failures(tests, &[]);
    let mut chosen = Vec::new();
    loop {
        let explains = |values: &Values| left.iter().filter(|&&test| contains(&tests[test], values)).count();
        let Some(most) = ranked.iter().map(explains).max().filter(|&most| most > 0) else { return (chosen, left) };
        let next = ranked.iter().find(|values| explains(values) == most).unwrap().clone();
        left.retain(|&test| !contains(&tests[test], &next));
        chosen.push(next);
    }
}

proptest! {
    #[test]
    fn suspects_are_those_that_looking_at_every_combination_finds_in_the_same_order(
        (levels, constraints) in models(),
        drawn in prop::collection::vec((any::<prop::sample::Index>(), prop::bool::weighted(0.3)), 1..=90),
        size in 1..=5usize,
        most in 0..=40usize,
    ) {
        let every = all_tests(&levels);
        let judge = |(index, failed): (prop::sample::Index, bool)| {
            JudgedTest { levels: index.get(&every).clone(), failed }
        };
        let tests: Vec<JudgedTest> = drawn.into_iter().map(judge).collect();
        let size = size.min(levels.len());
        if let Ok(rules) = Rules::new(&levels, &constraints) {
            let found = suspects(&rules, &tests, size, most).unwrap();
            let (valid, invalid): (Vec<usize>, Vec<usize>) = (0..tests.len())
                .partition(|&test| constraints.iter().all(|constraint| keeps(constraint, &tests[test].levels)));
            prop_assert_eq!(&found.invalid, &invalid);
            let kept: Vec<JudgedTest> = valid.iter().map(|&test| tests[test].clone()).collect();
            let expected = if kept.iter().all(|t| t.failed) { vec![] } else { brute_force(&levels, &kept, size) };
            prop_assert_eq!(found.found, expected.len() as u64);
            let ranked: Vec<Values> = found.ranked.iter().map(|suspect| suspect.values.clone()).collect();
            prop_assert_eq!(&ranked, &expected[..most.min(expected.len())]);
            for suspect in found.ranked.iter().chain(&found.explanation) {
                prop_assert_eq!(suspect.failures, failures(&kept, &suspect.values).len());
            }
            let (explanation, left) = cover(&kept, &expected);
            prop_assert_eq!(found.explanation.into_iter().map(|s| s.values).collect::<Vec<_>>(), explanation);
            prop_assert_eq!(found.unexplained, left.into_iter().map(|test| valid[test]).collect::<Vec<_>>());
        }
    }
}

/// Pseudo-random tests by a linear congruential generator.
fn random_tests(levels: &[usize], count: usize, fails: impl Fn(&[usize]) -> bool) -> Vec<JudgedTest> {
    let mut state = 7u64;
    let mut draw = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let test = |_| {
        let levels: Vec<usize> = levels.iter().map(|&v| draw(v)).collect();
        JudgedTest { failed: fails(&levels), levels }
    };
    (0..count).map(test).collect()
}

fn of_fifty(fails: impl Fn(&[usize]) -> bool) -> Suspects {
    let levels = [4; 50];
    suspects(&Rules::free(&levels), &random_tests(&levels, 400, fails), 3, 100).unwrap()
}

#[test]
fn guilty_combinations_among_fifty_parameters_stand_first_and_explain_all() {
    let found = of_fifty(|test| test[3] == 1 || (test[17] == 2 && test[40] == 0));
    assert_eq!(found.ranked[0].values, [(3, 1)]);
    assert_eq!(found.ranked[1].values, [(17, 2), (40, 0)]);
    assert_eq!(found.explanation, found.ranked[..2]);
    assert!(found.unexplained.is_empty() && found.ranked.len() == 100 && found.found > 100);
}

#[test]
fn failures_without_a_pattern_take_many_suspects_to_explain() {
    // The sum of all levels depends on every one of them.
    let found = of_fifty(|test| test.iter().sum::<usize>() % 2 == 0);
    assert!(found.ranked.iter().all(|suspect| suspect.values.len() == 3));
    assert!(found.explanation.len() > 15, "{}", found.explanation.len());
}

#[test]
fn a_failing_test_that_also_passed_is_left_unexplained() {
    let test = |levels: [usize; 2], failed| JudgedTest { levels: levels.to_vec(), failed };
    let tests = [test([0, 0], true), test([0, 0], false), test([1, 1], true)];
    let found = suspects(&Rules::free(&[2, 2]), &tests, 2, 10).unwrap();
    assert_eq!(found.unexplained, [0]);
    assert_eq!(found.ranked.iter().map(|s| s.values.as_slice()).collect::<Vec<_>>(), [[(0, 1)], [(1, 1)]]);
}

#[test]
fn without_failures_or_without_passes_nobody_is_suspect() {
    for failed in [false, true] {
        let tests = [[0, 0], [1, 1]].map(|levels| JudgedTest { levels: levels.to_vec(), failed });
        let found = suspects(&Rules::free(&[2, 2]), &tests, 2, 10).unwrap();
        assert_eq!((found.found, found.unexplained.len()), (0, if failed { 2 } else { 0 }));
    }
}

#[test]
fn a_test_of_another_space_is_refused_by_its_position() {
    let tests = [JudgedTest { levels: vec![0, 2], failed: true }];
    let message = suspects(&Rules::free(&[2, 2]), &tests, 1, 10).unwrap_err().to_string();
    assert!(message.starts_with("test 0, parameter 1: found level 2"), "{message}");
    let message = suspects(&Rules::free(&[2, 2]), &[], 3, 10).unwrap_err().to_string();
    assert_eq!(message, "k is 3, expected a number from 1 to 2, the number of parameters");
}
