//! Covering arrays against trying every test.

#[path = "../../space/tests/models/mod.rs"]
mod models;

use models::{all_tests, keeps, models};
use paracosm_coverage::Deadline;
use paracosm_generators::covering::{CoveringArray, CoveringError, CoveringRequest, covering_array, optimise};
use paracosm_space::rules::{Clause, Literal, Rules};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// The combinations of levels that tests have for every choice of k of the parameters.
fn combinations(tests: &[Vec<usize>], parameters: &[usize], k: usize) -> BTreeSet<Vec<(usize, usize)>> {
    let subsets = (0..1usize << parameters.len()).filter(|bits| bits.count_ones() as usize == k);
    let chosen = |bits: usize| (0..parameters.len()).filter(move |i| bits >> i & 1 == 1).map(|i| parameters[i]);
    subsets.flat_map(|bits| tests.iter().map(move |test| chosen(bits).map(|p| (p, test[p])).collect())).collect()
}

fn kept(levels: &[usize], constraints: &[Vec<Clause>]) -> Vec<Vec<usize>> {
    all_tests(levels).into_iter().filter(|test| constraints.iter().all(|constraint| keeps(constraint, test))).collect()
}

fn is_sound(
    request: &CoveringRequest,
    array: &CoveringArray,
    constraints: &[Vec<Clause>],
) -> Result<(), TestCaseError> {
    let valid = kept(request.rules.levels(), constraints);
    let all: Vec<usize> = (0..request.rules.levels().len()).collect();
    for row in &array.rows {
        prop_assert!(valid.contains(row), "{row:?} violates a constraint");
    }
    let families = std::iter::once((&all, request.k)).chain(request.groups.iter().map(|(p, strength)| (p, *strength)));
    for (parameters, strength) in families {
        let wanted = combinations(&valid, parameters, strength);
        let covered = combinations(&array.rows, parameters, strength);
        prop_assert!(wanted == covered, "not covered: {:?}", wanted.difference(&covered).next());
    }
    prop_assert!(array.rows.len() as u64 >= array.lower_bound);
    Ok(())
}

/// Models that can be kept, of parameters enough for a strength, and that strength.
fn solvable(k: usize) -> impl Strategy<Value = (Vec<usize>, Vec<Vec<Clause>>)> {
    models().prop_filter("enough parameters and a test", move |(levels, constraints)| {
        levels.len() >= k && !kept(levels, constraints).is_empty()
    })
}

fn covers_any_model(k: usize, levels: &[usize], constraints: &[Vec<Clause>], seed: u64) -> Result<(), TestCaseError> {
    let rules = Rules::new(levels, constraints).unwrap();
    let request = CoveringRequest { seed, ..CoveringRequest::new(&rules, k) };
    let array = covering_array(&request).unwrap();
    is_sound(&request, &array, constraints)?;
    let valid = kept(levels, constraints);
    let sizes = (0..1usize << levels.len()).filter(|bits| bits.count_ones() as usize == k).map(|bits| {
        let chosen: Vec<usize> = (0..levels.len()).filter(|i| bits >> i & 1 == 1).collect();
        combinations(&valid, &chosen, k).len() as u64
    });
    prop_assert!(array.lower_bound >= sizes.max().unwrap());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn every_level_is_covered_and_no_constraint_violated((levels, constraints) in solvable(1), seed in any::<u64>()) {
        covers_any_model(1, &levels, &constraints, seed)?;
    }

    #[test]
    fn every_pair_is_covered_and_no_constraint_violated((levels, constraints) in solvable(2), seed in any::<u64>()) {
        covers_any_model(2, &levels, &constraints, seed)?;
    }

    #[test]
    fn every_triple_is_covered_and_no_constraint_violated((levels, constraints) in solvable(3), seed in any::<u64>()) {
        covers_any_model(3, &levels, &constraints, seed)?;
    }

    #[test]
    fn every_quadruple_is_covered_and_no_constraint_violated(
        (levels, constraints) in solvable(4), seed in any::<u64>()
    ) {
        covers_any_model(4, &levels, &constraints, seed)?;
    }

    #[test]
    fn groups_are_covered_at_their_own_strength(
        (levels, constraints) in solvable(3), members in Just([0, 1, 2, 3, 4]).prop_shuffle(), strength in 1..=3usize
    ) {
        let rules = Rules::new(&levels, &constraints).unwrap();
        let members: Vec<usize> = members.into_iter().filter(|&member| member < levels.len()).collect();
        let groups = [(members[..3].to_vec(), strength), (members[..2].to_vec(), 1)];
        for k in 1..=2 {
            let request = CoveringRequest { groups: &groups, ..CoveringRequest::new(&rules, k) };
            let array = covering_array(&request).unwrap();
            is_sound(&request, &array, &constraints)?;
            let smaller = optimise(&request, array, Deadline::after(Duration::from_millis(1)), &|_| ());
            is_sound(&request, &smaller, &constraints)?;
        }
    }

    #[test]
    fn existing_tests_come_first_and_are_completed_unless_they_violate_a_constraint(
        (levels, constraints) in solvable(2),
        drawn in prop::collection::vec(prop::collection::vec(prop::option::of(0..4usize), 5), 0..8),
    ) {
        let rules = Rules::new(&levels, &constraints).unwrap();
        let level = |(level, levels): (&Option<usize>, &usize)| level.map(|level| level % levels);
        let existing: Vec<Vec<Option<usize>>> =
            drawn.iter().map(|test| test.iter().zip(&levels).map(level).collect()).collect();
        let request = CoveringRequest { existing: &existing, ..CoveringRequest::new(&rules, 2) };
        let array = covering_array(&request).unwrap();
        is_sound(&request, &array, &constraints)?;
        let fits = |test: &[Option<usize>], row: &[usize]| {
            test.iter().zip(row).all(|(level, chosen)| level.is_none_or(|level| level == *chosen))
        };
        let valid = kept(&levels, &constraints);
        let (good, bad): (Vec<usize>, Vec<usize>) =
            (0..existing.len()).partition(|&i| valid.iter().any(|test| fits(&existing[i], test)));
        prop_assert_eq!((array.kept, &array.invalid), (good.len(), &bad));
        prop_assert!(good.iter().zip(&array.rows).all(|(&i, row)| fits(&existing[i], row)));
        let first = array.rows[..array.kept].to_vec();
        let smaller = optimise(&request, array, Deadline::after(Duration::from_millis(1)), &|_| ());
        is_sound(&request, &smaller, &constraints)?;
        prop_assert_eq!(&smaller.rows[..smaller.kept], &first);
    }

    #[test]
    fn optimised_arrays_are_no_larger_and_still_cover((levels, constraints) in solvable(3), k in 1..=3usize) {
        let rules = Rules::new(&levels, &constraints).unwrap();
        let request = CoveringRequest::new(&rules, k);
        let array = covering_array(&request).unwrap();
        let size = array.rows.len();
        let smaller = optimise(&request, array, Deadline::after(Duration::from_millis(2)), &|_| ());
        prop_assert!(smaller.rows.len() <= size);
        is_sound(&request, &smaller, &constraints)?;
    }
}

#[test]
fn the_array_does_not_depend_on_the_number_of_threads() {
    let constraint = vec![Clause {
        literals: vec![Literal { parameter: 0, levels: vec![0, 1] }, Literal { parameter: 9, levels: vec![2] }],
    }];
    for (levels, k) in [(vec![3; 10], 3), (vec![10; 12], 2), (vec![2; 40], 3)] {
        let mut levels = levels;
        levels[0] = 3;
        levels[9] = 3;
        let rules = Rules::new(&levels, std::slice::from_ref(&constraint)).unwrap();
        let request = CoveringRequest { seed: 7, ..CoveringRequest::new(&rules, k) };
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| covering_array(&request).unwrap())
        };
        assert_eq!(with(1), with(4));
    }
    let rules = Rules::free(&[20, 19, 18, 17, 6]);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| covering_array(&CoveringRequest::new(&rules, 3)).unwrap())
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn uniform_models_of_few_parameters_have_orthogonal_arrays() {
    for (levels, k, rows) in [(vec![3; 4], 2, 9), (vec![4; 6], 3, 64), (vec![5; 6], 2, 25), (vec![8; 10], 3, 512)] {
        let rules = Rules::free(&levels);
        let request = CoveringRequest::new(&rules, k);
        let array = covering_array(&request).unwrap();
        assert_eq!((array.rows.len(), array.lower_bound), (rows, rows as u64));
    }
}

#[test]
fn the_fewest_rows_are_no_fewer_than_the_bound() {
    let cases: [(&[usize], usize, usize); 9] = [
        (&[2; 3], 2, 4),
        (&[2; 4], 2, 5),
        (&[2; 5], 2, 6),
        (&[3, 2, 2, 2], 2, 6),
        (&[3, 3, 2, 2], 2, 9),
        (&[2; 4], 3, 8),
        (&[3, 2, 2], 1, 3),
        (&[3, 2, 2, 2], 3, 12),
        (&[4, 2, 2, 2], 2, 8),
    ];
    for (levels, k, rows) in cases {
        let found = fewest(levels, k);
        assert_eq!(found, rows, "{levels:?} at {k}");
        let rules = Rules::free(levels);
        let bound = CoveringRequest::new(&rules, k).lower_bound().unwrap();
        assert!(bound <= found as u128, "{levels:?} at {k}: {bound} > {found}");
    }
}

/// The size of the smallest covering array, by trying all.
fn fewest(levels: &[usize], k: usize) -> usize {
    fn complete(rows: &mut Vec<Vec<usize>>, more: usize, all: &[Vec<usize>], parameters: &[usize], k: usize) -> bool {
        let wanted = combinations(all, parameters, k);
        let covered = combinations(rows, parameters, k);
        let Some(open) = wanted.difference(&covered).next() else { return true };
        // Each row covers one combination of each choice of parameters.
        let of_choice = |choice: &[(usize, usize)]| choice.iter().map(|pair| pair.0).collect::<Vec<_>>();
        let mut left: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
        wanted.difference(&covered).for_each(|open| *left.entry(of_choice(open)).or_default() += 1);
        if left.values().any(|&left| left > more) {
            return false;
        }
        all.iter().filter(|test| open.iter().all(|&(p, level)| test[p] == level)).any(|test| {
            rows.push(test.clone());
            let done = complete(rows, more - 1, all, parameters, k);
            rows.pop();
            done
        })
    }
    let (all, parameters) = (all_tests(levels), (0..levels.len()).collect::<Vec<_>>());
    (1..).find(|&rows| complete(&mut Vec::new(), rows, &all, &parameters, k)).expect("all tests cover")
}

#[test]
fn what_constraints_leave_free_is_bounded_by_theory_and_nothing_else_is() {
    let clause = |parameters: [usize; 2]| {
        vec![Clause { literals: parameters.map(|parameter| Literal { parameter, levels: vec![0] }).to_vec() }]
    };
    let bound = |constraints: &[Vec<Clause>], k| {
        let rules = Rules::new(&[2; 13], constraints).unwrap();
        let request = CoveringRequest::new(&rules, k);
        let array = covering_array(&request).unwrap();
        assert!(array.rows.len() as u64 >= array.lower_bound, "{} rows", array.rows.len());
        array.lower_bound
    };
    assert_eq!((bound(&[], 2), bound(&[clause([0, 12])], 2), bound(&[clause([0, 1]), clause([2, 3])], 2)), (7, 7, 6));
    // No two of the parameters are ever both 1, and all are in some constraint.
    let never_both: Vec<_> = (0..13).flat_map(|i| (0..i).map(move |j| [i, j])).map(clause).collect();
    assert_eq!(bound(&never_both, 2), 3);
}

#[test]
fn the_next_row_never_adds_more_than_the_one_before() {
    let levels = [4, 4, 3, 3, 3, 2, 2, 2, 2];
    let rules = Rules::free(&levels);
    let array = covering_array(&CoveringRequest::new(&rules, 2)).unwrap();
    let all: Vec<usize> = (0..levels.len()).collect();
    let covered: Vec<usize> = (0..=array.rows.len()).map(|n| combinations(&array.rows[..n], &all, 2).len()).collect();
    let added: Vec<usize> = covered.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(added.is_sorted_by(|a, b| a >= b), "{added:?}");
}

#[test]
fn parameters_of_thousands_of_levels_are_covered() {
    let rules = Rules::free(&[3000, 3, 2, 1000]);
    let array = covering_array(&CoveringRequest::new(&rules, 1)).unwrap();
    assert_eq!(array.rows.len(), 3000);
    let rules = Rules::free(&[3000, 30, 2, 5]);
    let array = covering_array(&CoveringRequest::new(&rules, 2)).unwrap();
    assert_eq!(combinations(&array.rows, &[0, 1, 2, 3], 2).len(), 90_000 + 6_000 + 15_000 + 60 + 150 + 10);
    assert!(array.rows.len() < 91_000, "{}", array.rows.len());
}

#[test]
fn what_cannot_be_covered_is_refused() {
    let rules = Rules::free(&[2, 3, 2]);
    let request = CoveringRequest::new(&rules, 2);
    let refused = |request: &CoveringRequest| covering_array(request).unwrap_err();
    assert_eq!(refused(&CoveringRequest { k: 4, ..request.clone() }), CoveringError::Strength { k: 4, parameters: 3 });
    assert_eq!(refused(&CoveringRequest { k: 0, ..request.clone() }), CoveringError::Strength { k: 0, parameters: 3 });
    let groups = [(vec![0, 1], 3)];
    let error = CoveringError::GroupStrength { group: 0, strength: 3, parameters: 2 };
    assert_eq!(refused(&CoveringRequest { groups: &groups, ..request.clone() }), error);
    for (members, found) in [(vec![0, 3], 3), (vec![1, 1], 1)] {
        let groups = [(vec![0], 1), (members, 2)];
        let error = CoveringError::GroupMember { group: 1, found, parameters: 3 };
        assert_eq!(refused(&CoveringRequest { groups: &groups, ..request.clone() }), error);
    }
    let existing = [vec![None; 3], vec![None; 2]];
    let error = CoveringError::Ragged { index: 1, found: 2, expected: 3 };
    assert_eq!(refused(&CoveringRequest { existing: &existing, ..request.clone() }), error);
    let existing = [vec![None, Some(3), None]];
    let error = CoveringError::Level { index: 0, parameter: 1, found: 3, levels: 3 };
    assert_eq!(refused(&CoveringRequest { existing: &existing, ..request }), error);
    assert_eq!(refused(&CoveringRequest::new(&Rules::free(&[2, 0]), 1)), CoveringError::NoLevel(1));
    let rules = Rules::free(&[100_000; 2]);
    assert_eq!(refused(&CoveringRequest::new(&rules, 2)), CoveringError::TooLarge { rows: 10_000_000_000 });
}

#[test]
fn an_array_that_takes_longer_than_there_is_time_is_given_up() {
    let rules = Rules::free(&[10; 16]);
    for (k, limit) in [(2, 0), (5, 50)] {
        let deadline = Deadline::after(Duration::from_millis(limit));
        let request = CoveringRequest { deadline, ..CoveringRequest::new(&rules, k) };
        assert_eq!(covering_array(&request).unwrap_err(), CoveringError::OutOfTime);
    }
}
