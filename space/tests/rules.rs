//! What constraints allow, against trying every test.

mod models;

use models::{all_tests, keeps, models};
use paracosm_space::rules::{Clause, Conflict, Literal, Rules, RulesError, TupleCount};
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
            Err(error) => {
                let RulesError::Conflict(conflict) = error else { panic!("{error}") };
                prop_assert!(kept.is_empty() && conflict.smallest);
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
    let conflict = Conflict { constraints: vec![17, 200, 250], smallest: true };
    assert_eq!(Rules::new(&[2; 100], &constraints).unwrap_err(), RulesError::Conflict(conflict));
}

#[test]
fn levels_that_no_constraint_tells_apart_cost_nothing() {
    let above: Vec<usize> = (5000..10_000).collect();
    let constraint = vec![Clause { literals: vec![literal(0, &above), literal(1, &[7])] }];
    let rules = Rules::new(&[10_000, 10_000, 10_000], &[constraint]).unwrap();
    assert_eq!(rules.count(&[0, 1, 2], 2).valid, 300_000_000 - 5000 * 9999);
    assert_eq!(rules.tests(), Some(1e12 - 5000.0 * 9999.0 * 1e4));
}

/// A clause for each level of `a`: with which levels of `b` it goes.
fn related(a: usize, b: usize, levels: &[usize], holds: impl Fn(usize, usize) -> bool) -> Vec<Clause> {
    let clause = |level: usize| {
        let others: Vec<usize> = (0..levels[a]).filter(|&other| other != level).collect();
        let partners: Vec<usize> = (0..levels[b]).filter(|&partner| holds(level, partner)).collect();
        Clause { literals: vec![literal(a, &others), literal(b, &partners)] }
    };
    (0..levels[a]).map(clause).collect()
}

/// Relations by which two levels can be compared, some of them with a distance.
const RELATIONS: [fn(usize, usize) -> bool; 8] = [
    |a, b| a < b,
    |a, b| a <= b,
    |a, b| a == b,
    |a, b| a != b,
    |a, b| a + 7 < b,
    |a, b| a.abs_diff(b) <= 3,
    |a, b| a.abs_diff(b) > 5,
    |a, b| a + b < 30,
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn comparisons_of_many_levels_are_decided_as_by_trying_every_test(
        levels in prop::collection::vec(1..=32usize, 3..=3),
        compared in prop::collection::vec((0..3usize, 1..3usize, 0..RELATIONS.len()), 1..=4),
        condition in prop::option::of((0..3usize, 1..3usize, 0..32usize, any::<u32>())),
        fixed in prop::option::of((0..3usize, any::<usize>())),
    ) {
        // Each constraint as clauses and as what it says of a test.
        type Says = Box<dyn Fn(&[usize]) -> bool>;
        let mut constraints: Vec<(Vec<Clause>, Says)> = Vec::new();
        for (a, step, relation) in compared {
            let (b, relation) = ((a + step) % 3, RELATIONS[relation]);
            let says = move |test: &[usize]| relation(test[a], test[b]);
            constraints.push((related(a, b, &levels, relation), Box::new(says)));
        }
        if let Some((a, step, above, bits)) = condition {
            let b = (a + step) % 3;
            let low: Vec<usize> = (0..levels[a].min(above + 1)).collect();
            let among: Vec<usize> = (0..levels[b]).filter(|level| bits >> level & 1 == 1).collect();
            let clause = Clause { literals: vec![literal(a, &low), literal(b, &among)] };
            let says = move |test: &[usize]| test[a] <= above || bits >> test[b] & 1 == 1;
            constraints.push((vec![clause], Box::new(says)));
        }
        let every = all_tests(&levels);
        let kept: Vec<&Vec<usize>> =
            every.iter().filter(|test| constraints.iter().all(|(_, says)| says(test))).collect();
        let clauses: Vec<Vec<Clause>> = constraints.iter().map(|(clauses, _)| clauses.clone()).collect();
        let rules = match Rules::new(&levels, &clauses) {
            Ok(rules) => rules,
            Err(error) => {
                let RulesError::Conflict(conflict) = error else { panic!("{error}") };
                prop_assert!(kept.is_empty() && conflict.smallest);
                let holds = |set: &[usize]| every.iter().any(|test| set.iter().all(|&c| constraints[c].1(test)));
                prop_assert!(!holds(&conflict.constraints));
                for set in choices(constraints.len()).filter(|set| set.len() < conflict.constraints.len()) {
                    prop_assert!(holds(&set));
                }
                return Ok(());
            }
        };
        prop_assert_eq!(rules.tests(), Some(kept.len() as f64));
        for test in &every {
            prop_assert_eq!(rules.allows(test), kept.binary_search(&test).is_ok());
        }
        let pairs = [[0, 1], [0, 2], [1, 2]].map(|set| {
            (set, kept.iter().map(|test| set.map(|parameter| test[parameter])).collect::<BTreeSet<_>>())
        });
        for (set, valid) in &pairs {
            for a in 0..levels[set[0]] {
                for b in 0..levels[set[1]] {
                    prop_assert_eq!(rules.is_valid(&[(set[0], a), (set[1], b)]), valid.contains(&[a, b]));
                }
            }
        }
        let sizes = pairs.each_ref().map(|(_, valid)| valid.len() as u128);
        let (valid, largest) = (sizes.iter().sum(), *sizes.iter().max().unwrap());
        prop_assert_eq!(rules.count(&[0, 1, 2], 2), TupleCount { valid, largest });
        let fixed = fixed.map(|(parameter, level)| (parameter, level % levels[parameter]));
        let fits = |test: &&&Vec<usize>| fixed.is_none_or(|(parameter, level)| test[parameter] == level);
        for group in 0..rules.groups() {
            if fixed.is_none_or(|(parameter, _)| rules.group_of(parameter) == Some(group)) {
                let with = |other| fixed.filter(|pair| pair.0 == other).map(|pair| pair.1);
                for (&member, supported) in rules.members(group).iter().zip(rules.supported(group, with)) {
                    for (level, supported) in supported.into_iter().enumerate() {
                        prop_assert_eq!(supported, kept.iter().filter(fits).any(|test| test[member] == level));
                    }
                }
            }
        }
    }
}

#[test]
fn three_parameters_of_a_thousand_levels_each_can_be_compared() {
    let levels = [1000; 3];
    let ascending = [related(0, 1, &levels, |a, b| a < b), related(1, 2, &levels, |b, c| b < c)];
    let rules = Rules::new(&levels, &ascending).unwrap();
    let pairs = 999 * 998 / 2;
    assert_eq!(rules.count(&[0, 1, 2], 2), TupleCount { valid: 3 * pairs, largest: pairs });
    assert_eq!(rules.tests(), Some(1000.0 * 999.0 * 998.0 / 6.0));
    assert!(rules.is_valid(&[(0, 0), (2, 2)]) && !rules.is_valid(&[(0, 0), (2, 1)]));
    // What others imply makes it no harder.
    let implied = [ascending.as_slice(), &[related(0, 2, &levels, |a, c| a < c)]].concat();
    assert_eq!(Rules::new(&levels, &implied).unwrap().tests(), rules.tests());
}

/// That any two of so many parameters differ.
fn all_different(parameters: usize, levels: usize) -> Vec<Vec<Clause>> {
    let pairs = (1..parameters).flat_map(|b| (0..b).map(move |a| (a, b)));
    pairs.map(|(a, b)| related(a, b, &vec![levels; parameters], |a, b| a != b)).collect()
}

#[test]
fn three_different_ones_of_many_levels_are_told_apart_with_a_diagram_and_without() {
    for levels in [100, 1000] {
        let rules = Rules::new(&[levels; 3], &all_different(3, levels)).unwrap();
        let pairs = (levels * (levels - 1)) as u128;
        assert_eq!(rules.count(&[0, 1, 2], 2), TupleCount { valid: 3 * pairs, largest: pairs });
        let tests = (levels * (levels - 1) * (levels - 2)) as f64;
        assert_eq!(rules.tests(), (levels == 100).then_some(tests));
        assert!(rules.allows(&[5, 7, 6]) && !rules.allows(&[5, 7, 5]));
    }
}

#[test]
fn nine_parameters_cannot_have_eight_levels_and_all_differ() {
    let mut constraints = all_different(9, 8);
    let all: Vec<usize> = (0..constraints.len()).collect();
    let conflict = |constraints: &[usize]| Conflict { constraints: constraints.to_vec(), smallest: true };
    assert_eq!(Rules::new(&[8; 9], &constraints).unwrap_err(), RulesError::Conflict(conflict(&all)));
    constraints.push(vec![Clause { literals: vec![literal(0, &[1, 2, 3])] }]);
    assert_eq!(Rules::new(&[8; 9], &constraints).unwrap_err(), RulesError::Conflict(conflict(&all)));
}

#[test]
fn a_conflict_that_may_not_be_the_smallest_says_so() {
    let mut constraints = all_different(13, 12);
    constraints.push(vec![Clause { literals: vec![literal(0, &[1, 2, 3])] }]);
    let RulesError::Conflict(conflict) = Rules::new(&[12; 13], &constraints).unwrap_err() else { panic!("decided") };
    assert!(!conflict.smallest);
    // All have to differ, or there is a test.
    assert!((0..constraints.len() - 1).all(|constraint| conflict.constraints.contains(&constraint)));
    assert!(conflict.to_string().ends_with("(a smaller set of constraints may be in conflict, too)"), "{conflict}");
}

#[test]
fn what_takes_too_long_to_decide_is_refused() {
    let error = Rules::new(&[24; 25], &all_different(25, 24)).unwrap_err();
    assert_eq!(error, RulesError::Undecided((0..25).collect()));
}
