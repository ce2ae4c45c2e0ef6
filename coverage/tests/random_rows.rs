//! Random tests under constraints and what is promised of them, against listing every test and against drawing.

#[path = "../../space/tests/models/mod.rs"]
mod models;

use models::{all_tests, keeps, models};
use paracosm_coverage::kwise::kwise_coverage;
use paracosm_coverage::theory::rows::RandomRows;
use paracosm_space::rules::{Clause, Literal, Rules, UniformTests};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Random numbers from a seed: xorshift64* (Vigna, 2016).
fn numbers(seed: u64) -> impl FnMut(usize) -> usize {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move |n| {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        ((u128::from(state.wrapping_mul(0x2545_f491_4f6c_dd1d)) * n as u128) >> 64) as usize
    }
}

/// Every combination of levels of `k` parameters with the number of tests that have it.
fn combinations(tests: &[Vec<usize>], k: usize) -> BTreeMap<Vec<(usize, usize)>, usize> {
    let parameters = tests[0].len();
    let sets = (0..1usize << parameters).filter(|set| set.count_ones() as usize == k);
    let mut count = BTreeMap::new();
    for set in sets {
        for test in tests {
            let members = (0..parameters).filter(|parameter| set >> parameter & 1 == 1);
            *count.entry(members.map(|parameter| (parameter, test[parameter])).collect()).or_insert(0) += 1;
        }
    }
    count
}

/// What the union bound sums, combination by combination.
fn missed(tests: &[Vec<usize>], k: usize, rows: u64) -> f64 {
    let all = tests.len() as f64;
    let missed = |with: &usize| libm::pow(1.0 - *with as f64 / all, rows as f64);
    combinations(tests, k).values().map(missed).sum()
}

proptest! {
    #[test]
    fn the_union_bound_takes_every_combination_with_the_share_of_the_tests_that_have_it(
        (levels, constraints) in models(),
        rows in 1..60u64,
    ) {
        let kept: Vec<Vec<usize>> =
            all_tests(&levels).into_iter().filter(|test| constraints.iter().all(|c| keeps(c, test))).collect();
        let Ok(rules) = Rules::new(&levels, &constraints) else { return Ok(()) };
        for k in 1..=levels.len() {
            let random = RandomRows::new(&rules, k).expect("small groups can be counted");
            let expected = missed(&kept, k, rows).min(1.0);
            prop_assert!((random.missed(rows) - expected).abs() <= 1e-9, "{} {expected}", random.missed(rows));
            let enough = random.union_bound(0.1);
            prop_assert!(missed(&kept, k, enough) <= 0.1 + 1e-9);
            prop_assert!(enough == 1 || missed(&kept, k, enough - 1) > 0.1 - 1e-9);
        }
    }
}

/// Two groups of parameters that constraints join, and one parameter that is free.
fn constrained() -> (Vec<usize>, Vec<Vec<Clause>>) {
    let literal = |parameter, levels: &[usize]| Literal { parameter, levels: levels.to_vec() };
    let clause = |literals: Vec<Literal>| vec![Clause { literals }];
    let constraints = vec![
        clause(vec![literal(0, &[1, 2]), literal(1, &[0])]),
        clause(vec![literal(1, &[0, 1]), literal(2, &[1])]),
        clause(vec![literal(4, &[0]), literal(5, &[1, 2])]),
    ];
    (vec![3, 3, 2, 2, 2, 3], constraints)
}

/// Three parameters of which each is at most the next, the last of them joined with a fourth, of which levels are
/// alike.
fn ascending() -> (Vec<usize>, Vec<Vec<Clause>>) {
    let literal = |parameter, levels: Vec<usize>| Literal { parameter, levels };
    let at_most = |first: usize, v: usize| Clause {
        literals: vec![literal(first, (0..v).collect()), literal(first + 1, (v..7).collect())],
    };
    let ordered = (0..2).map(|first| (1..7).map(|v| at_most(first, v)).collect());
    let last = Clause { literals: vec![literal(3, vec![0, 2, 3]), literal(2, vec![6])] };
    (vec![7, 7, 7, 5], ordered.chain([vec![last]]).collect())
}

/// The last level of the first parameter goes with one level of the second only: of 13 tests one has it.
fn rare_level() -> Vec<Clause> {
    let literals = [Literal { parameter: 0, levels: vec![0, 1, 2] }, Literal { parameter: 1, levels: vec![0] }];
    vec![Clause { literals: literals.to_vec() }]
}

fn drawn(tests: &UniformTests, rows: u64, seed: u64) -> Vec<Vec<usize>> {
    let mut numbers = numbers(seed);
    (0..rows).map(|_| tests.draw(&mut numbers)).collect()
}

#[test]
fn every_test_that_keeps_the_constraints_is_drawn_as_often_as_any_other() {
    for (levels, constraints) in [constrained(), ascending()] {
        let kept: BTreeSet<Vec<usize>> =
            all_tests(&levels).into_iter().filter(|test| constraints.iter().all(|c| keeps(c, test))).collect();
        let tests = Rules::new(&levels, &constraints).unwrap().uniform().unwrap();
        let draws = 400 * kept.len() as u64;
        let mut often: BTreeMap<Vec<usize>, f64> = kept.iter().map(|test| (test.clone(), 0.0)).collect();
        for test in drawn(&tests, draws, 1) {
            *often.get_mut(&test).expect("it keeps the constraints") += 1.0;
        }
        // Pearson's statistic has as mean the number of tests less one, and twice that as variance.
        let statistic: f64 = often.values().map(|often| (often - 400.0) * (often - 400.0) / 400.0).sum();
        let freedom = kept.len() as f64 - 1.0;
        assert!((statistic - freedom).abs() < 4.0 * (2.0 * freedom).sqrt(), "{statistic} of {freedom}");
    }
}

#[test]
fn families_are_complete_at_least_as_often_as_guaranteed() {
    let (levels, constraints) = constrained();
    let models = [
        Rules::free(&[2; 6]),
        Rules::free(&[3, 2, 4, 2]),
        Rules::new(&levels, &constraints).unwrap(),
        Rules::new(&[4, 4], &[rare_level()]).unwrap(),
    ];
    let families = 2000;
    for (number, rules) in models.iter().enumerate() {
        for k in 1..=2 {
            let random = RandomRows::new(rules, k).unwrap();
            let tests = rules.uniform().unwrap();
            for delta in [0.5, 0.2, 0.05] {
                // Also with fewer rows than that takes.
                let enough = random.union_bound(delta);
                for rows in [enough, enough * 4 / 5] {
                    let complete = |seed: &u64| {
                        let drawn = drawn(&tests, rows, *seed);
                        let found = kwise_coverage(rules, k, drawn.iter().map(Vec::as_slice)).unwrap();
                        found.covered == found.valid
                    };
                    let complete = (0..families).filter(complete).count() as f64 / families as f64;
                    let guaranteed = 1.0 - random.missed(rows);
                    // Three standard deviations of a share of 2000 families.
                    let slack = 3.0 * (guaranteed * (1.0 - guaranteed) / families as f64).sqrt();
                    assert!(
                        complete >= guaranteed - slack,
                        "model {number}, k {k}, {rows} rows: {complete} {guaranteed}"
                    );
                }
            }
        }
    }
}

#[test]
fn where_one_combination_decides_the_guarantee_is_what_happens() {
    // One parameter with two levels: a family misses the first or the second, never both.
    let random = RandomRows::new(&Rules::free(&[2]), 1).unwrap();
    for rows in 1..20 {
        let happens = libm::pow(0.5, rows as f64 - 1.0);
        assert!((random.missed(rows) - happens).abs() < 1e-12);
    }
    assert_eq!(random.missed(0), 1.0);
}

/// Any two neighbours of many parameters are not both at level 0: more tests than a float can count.
fn no_zeros_side_by_side(parameters: usize) -> Rules {
    let other = |parameter| Literal { parameter, levels: (1..10).collect() };
    let constraint = |first: usize| vec![Clause { literals: vec![other(first), other(first + 1)] }];
    let constraints: Vec<_> = (0..parameters - 1).map(constraint).collect();
    Rules::new(&vec![10; parameters], &constraints).unwrap()
}

#[test]
fn more_tests_than_can_be_counted_still_have_probabilities() {
    let parameters = 500;
    let rules = no_zeros_side_by_side(parameters);
    assert_eq!(rules.tests(), Some(f64::INFINITY));
    // The share of zeros at the end of a row of n parameters: of a zero follow nine levels, of any other ten.
    let mut zeros = vec![0.1];
    for n in 1..parameters {
        zeros.push((1.0 - zeros[n - 1]) / (10.0 - zeros[n - 1]));
    }
    let missed = |i: usize| {
        // Zero at i, with those before and after it ending in no zero.
        let (before, after) = (zeros[i], zeros[parameters - 1 - i]);
        let odds = before * after / 0.1;
        let zero = odds / (odds + (1.0 - before) * (1.0 - after) / 0.9);
        libm::pow(1.0 - zero, 300.0) + 9.0 * libm::pow(1.0 - (1.0 - zero) / 9.0, 300.0)
    };
    let expected: f64 = (0..parameters).map(missed).sum();
    let found = RandomRows::new(&rules, 1).unwrap().missed(300);
    assert!(expected < 0.1 && (found - expected).abs() < 1e-9, "{found} {expected}");
    let row = rules.uniform().unwrap().draw(numbers(1));
    assert!(rules.allows(&row));
}

#[test]
fn tests_that_are_too_small_a_share_for_a_float_still_have_probabilities() {
    // All parameters have the same level: 10 tests of 10^400.
    let same = |first: usize| {
        let clause = |level: usize| {
            let others = (0..10).filter(|&other| other != level).collect();
            let literals = [(first, others), (first + 1, vec![level])];
            Clause { literals: literals.map(|(parameter, levels)| Literal { parameter, levels }).to_vec() }
        };
        (0..10).map(clause).collect()
    };
    let rules = Rules::new(&[10; 400], &(0..399).map(same).collect::<Vec<_>>()).unwrap();
    let expected = 4000.0 * libm::pow(0.9, 120.0);
    let found = RandomRows::new(&rules, 1).unwrap().missed(120);
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    let tests: BTreeSet<Vec<usize>> = drawn(&rules.uniform().unwrap(), 200, 1).into_iter().collect();
    assert_eq!(tests, (0..10).map(|level| vec![level; 400]).collect());
}

#[test]
fn where_parameters_are_too_entangled_to_be_counted_nothing_is_promised() {
    let mut numbers = numbers(7);
    let clause = |_: usize| {
        let mut parameters = BTreeSet::new();
        while parameters.len() < 3 {
            parameters.insert(numbers(100));
        }
        vec![Clause { literals: parameters.into_iter().map(|p| Literal { parameter: p, levels: vec![1] }).collect() }]
    };
    let constraints: Vec<_> = (0..380).map(clause).collect();
    let rules = Rules::new(&[2; 100], &constraints).unwrap();
    assert!(rules.uniform().is_none());
    assert_eq!(RandomRows::new(&rules, 2), None);
}

#[test]
fn a_delta_that_is_the_very_sum_takes_no_row_more_and_one_below_it_does() {
    // n rows miss a value of one parameter with two levels with 2 (1/2)^n, one with four levels with 4 (3/4)^n, and a
    // pair of these with 8 (7/8)^n: all of them exact.
    let cases: [(&[usize], usize, u32); 4] = [(&[2], 1, 60), (&[4], 1, 30), (&[2, 4], 2, 17), (&[2, 2], 2, 30)];
    for (levels, k, most) in cases {
        let random = RandomRows::new(&Rules::free(levels), k).unwrap();
        let odds: u64 = levels.iter().product::<usize>() as u64;
        let missed = |n: u32| odds as f64 * (0..n).fold(1.0, |power, _| power * (odds - 1) as f64 / odds as f64);
        for n in (1..=most).filter(|&n| missed(n) < 1.0) {
            assert_eq!(random.missed(n.into()), missed(n));
            assert_eq!(random.union_bound(missed(n)), n.into(), "{levels:?}, {n} rows");
            assert_eq!(random.union_bound(missed(n).next_down()), u64::from(n) + 1, "{levels:?}, {n} rows");
        }
    }
}

#[test]
fn what_is_rounded_is_rounded_up() {
    // 3 (2/3)^n in whole numbers: 2^n / 3^(n-1), against the float times the denominator.
    let random = RandomRows::new(&Rules::free(&[3]), 1).unwrap();
    for n in 4..40u32 {
        let missed = random.missed(n.into());
        // missed = mantissa / 2^scale, exactly.
        let scale = 52 - (((missed.to_bits() >> 52) as i32) - 1023);
        let mantissa = u128::from(missed.to_bits() & ((1 << 52) - 1) | 1 << 52);
        let above = mantissa * 3u128.pow(n - 1);
        assert!(above >= 1u128 << (scale as u32 + n), "{n} rows");
        let few = mantissa - 1000;
        assert!(few * 3u128.pow(n - 1) < 1u128 << (scale as u32 + n), "{n} rows: and hardly");
    }
}
