//! What constraints allow, against trying every test.

mod models;

use models::{all_tests, keeps, models};
use paracosm_coverage::rules::{Clause, Literal, Rules, TupleCount};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn projections(tests: &[Vec<usize>], set: &[usize]) -> BTreeSet<Vec<usize>> {
    tests.iter().map(|test| set.iter().map(|&parameter| test[parameter]).collect()).collect()
}

/// The choices of some parameters, as ascending positions.
fn choices(parameters: usize) -> impl Iterator<Item = Vec<usize>> {
    (0..1usize << parameters).map(move |bits| (0..parameters).filter(|p| bits >> p & 1 == 1).collect())
}

proptest! {
    #[test]
    fn a_combination_is_valid_if_some_test_that_keeps_all_constraints_contains_it((levels, constraints) in models()) {
        let every = all_tests(&levels);
        let kept: Vec<Vec<usize>> =
            every.iter().filter(|test| constraints.iter().all(|c| keeps(c, test))).cloned().collect();
        match Rules::new(&levels, &constraints) {
            Err(conflict) => {
                prop_assert!(kept.is_empty());
                let holds = |set: &[usize]| every.iter().any(|test| set.iter().all(|&c| keeps(&constraints[c], test)));
                prop_assert!(!holds(&conflict.constraints));
                for set in choices(constraints.len()).filter(|set| set.len() < conflict.constraints.len()) {
                    prop_assert!(holds(&set), "{set:?} is a smaller conflict than {conflict:?}");
                }
            }
            Ok(rules) => {
                prop_assert!(!kept.is_empty());
                for test in &every {
                    prop_assert_eq!(rules.allows(test), kept.contains(test));
                }
                prop_assert_eq!(rules.tests(), Some(kept.len() as f64));
                for set in choices(levels.len()) {
                    let valid = projections(&kept, &set);
                    for levels in projections(&every, &set) {
                        let tuple: Vec<(usize, usize)> = set.iter().copied().zip(levels.iter().copied()).collect();
                        prop_assert_eq!(rules.is_valid(&tuple), valid.contains(&levels));
                        let fixed = |parameter| tuple.iter().find(|pair| pair.0 == parameter).map(|pair| pair.1);
                        for parameter in 0..rules.levels().len() {
                            let with = |level| {
                                let fits = |test: &&Vec<usize>| tuple.iter().all(|&(p, level)| test[p] == level);
                                kept.iter().filter(fits).any(|test| test[parameter] == level)
                            };
                            let group = rules.group_of(parameter).map_or(vec![], |g| rules.members(g).to_vec());
                            if tuple.iter().all(|pair| pair.0 == parameter || group.contains(&pair.0)) {
                                let wanted: Vec<bool> = (0..rules.levels()[parameter]).map(with).collect();
                                prop_assert_eq!(rules.supported_at(parameter, fixed), wanted);
                            }
                        }
                        let mut partial = vec![None; rules.levels().len()];
                        tuple.iter().for_each(|&(parameter, level)| partial[parameter] = Some(level));
                        let completed = rules.completes(&partial);
                        prop_assert_eq!(completed.is_some(), valid.contains(&levels));
                        let fits = |test: &Vec<usize>| tuple.iter().all(|&(parameter, level)| test[parameter] == level);
                        prop_assert!(completed.is_none_or(|test| kept.contains(&test) && fits(&test)));
                    }
                }
            }
        }
    }

    #[test]
    fn valid_combinations_are_counted((levels, constraints) in models(), k in 1..=3usize, among in 0..32usize) {
        let kept: Vec<Vec<usize>> =
            all_tests(&levels).into_iter().filter(|test| constraints.iter().all(|c| keeps(c, test))).collect();
        if let Ok(rules) = Rules::new(&levels, &constraints) {
            let parameters: Vec<usize> = (0..levels.len()).filter(|p| among >> p & 1 == 1).collect();
            let sets = choices(levels.len())
                .filter(|set| set.len() == k && set.iter().all(|parameter| parameters.contains(parameter)));
            let sizes: Vec<u128> = sets.map(|set| projections(&kept, &set).len() as u128).collect();
            let (valid, largest) = (sizes.iter().sum(), sizes.iter().copied().max().unwrap_or(0));
            prop_assert_eq!(rules.count(&parameters, k), TupleCount { valid, largest });
        }
    }
}

fn literal(parameter: usize, levels: &[usize]) -> Literal {
    Literal { parameter, levels: levels.to_vec() }
}

/// A random clause of three of 100 switches for each of `clauses`, by a linear congruential generator.
fn three_of_a_hundred(clauses: usize) -> Vec<Vec<Clause>> {
    let mut state = 1u64;
    let mut draw = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let clause = |_| {
        let mut parameters = BTreeSet::new();
        while parameters.len() < 3 {
            parameters.insert(draw(100));
        }
        vec![Clause { literals: parameters.into_iter().map(|p| literal(p, &[draw(2)])).collect() }]
    };
    (0..clauses).map(clause).collect()
}

#[test]
fn a_hundred_entangled_parameters_are_decided() {
    let constraints = three_of_a_hundred(380);
    let levels = [2; 100];
    let rules = Rules::new(&levels, &constraints).unwrap();
    assert_eq!(rules.groups(), 1);
    let mut valid = 0;
    for pair in 0..50 {
        for (first, second) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let tuple = [(pair, first), (99 - pair, second)];
            let mut partial = [None; 100];
            tuple.iter().for_each(|&(parameter, level)| partial[parameter] = Some(level));
            let completed = rules.completes(&partial);
            assert_eq!(rules.is_valid(&tuple), completed.is_some());
            if let Some(test) = completed {
                assert!(constraints.iter().all(|constraint| keeps(constraint, &test)) && rules.allows(&test));
                assert!(tuple.iter().all(|&(parameter, level)| test[parameter] == level));
                valid += 1;
            }
        }
    }
    assert!((100..200).contains(&valid), "{valid}");
}

#[test]
fn what_goes_with_entangled_levels_is_told_for_one_parameter_as_for_all() {
    let rules = Rules::new(&[2; 100], &three_of_a_hundred(380)).unwrap();
    for parameter in (0..100).step_by(9) {
        let fixed = |other: usize| (other == 50).then_some(parameter % 2);
        let all = rules.supported(0, fixed);
        assert_eq!(rules.supported_at(parameter, fixed), all[rules.members(0).binary_search(&parameter).unwrap()]);
    }
}

#[test]
fn a_conflict_among_many_constraints_is_named() {
    let mut constraints = three_of_a_hundred(300);
    let only = |parameter: usize, level: usize| vec![Clause { literals: vec![literal(parameter, &[level])] }];
    constraints.insert(17, only(3, 0));
    constraints.insert(200, vec![Clause { literals: vec![literal(3, &[1]), literal(50, &[1])] }]);
    constraints.insert(250, only(50, 0));
    let conflict = Rules::new(&[2; 100], &constraints).unwrap_err();
    assert_eq!(conflict.constraints, [17, 200, 250]);
}

#[test]
fn levels_that_no_constraint_tells_apart_cost_nothing() {
    let above: Vec<usize> = (5000..10_000).collect();
    let constraint = vec![Clause { literals: vec![literal(0, &above), literal(1, &[7])] }];
    let rules = Rules::new(&[10_000, 10_000, 10_000], &[constraint]).unwrap();
    assert_eq!(rules.count(&[0, 1, 2], 2).valid, 300_000_000 - 5000 * 9999);
    assert_eq!(rules.tests(), Some(1e12 - 5000.0 * 9999.0 * 1e4));
}
