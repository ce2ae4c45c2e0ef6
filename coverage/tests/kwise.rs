//! k-wise coverage against counting in sets, and the sizes of random families against exact probabilities.

#[path = "../../space/tests/models/mod.rs"]
mod models;

use models::{all_tests, keeps, models};
use paracosm_coverage::kwise::{KwiseCounter, KwiseError, MISSING_LISTED, coverage_of_kinds, kwise_coverage};
use paracosm_coverage::theory::rows::{RandomRows, proposition_3_2};
use paracosm_space::demand::TestKind;
use paracosm_space::rules::{Clause, Rules};
use proptest::prelude::*;
use std::collections::BTreeSet;

type Tuple = Vec<(usize, usize)>;

/// The levels of a space, constraints, a k for it, and tests.
type Study = (Vec<usize>, Vec<Vec<Clause>>, usize, Vec<Vec<usize>>);

/// A space of few levels with constraints, a k for it, and tests.
fn study() -> impl Strategy<Value = Study> {
    models().prop_flat_map(|(levels, constraints)| {
        let test: Vec<_> = levels.iter().map(|&v| 0..v).collect();
        let k = 1..=levels.len();
        (Just(levels), Just(constraints), k, prop::collection::vec(test, 0..12))
    })
}

/// Every choice of k of the entries, in lexicographic order.
fn subsets(entries: &[(usize, usize)], k: usize) -> Vec<Tuple> {
    match (k, entries) {
        (0, _) => vec![vec![]],
        (_, []) => vec![],
        (_, [first, rest @ ..]) => {
            let with = subsets(rest, k - 1).into_iter().map(|tail| [&[*first], tail.as_slice()].concat());
            with.chain(subsets(rest, k)).collect()
        }
    }
}

fn tuples_of<'a>(tests: impl IntoIterator<Item = &'a Vec<usize>>, k: usize) -> BTreeSet<Tuple> {
    let entries = |test: &Vec<usize>| test.iter().copied().enumerate().collect::<Tuple>();
    tests.into_iter().flat_map(|test| subsets(&entries(test), k)).collect()
}

proptest! {
    #[test]
    fn coverage_is_what_sets_of_tuples_count((levels, constraints, k, tests) in study()) {
        let Ok(rules) = Rules::new(&levels, &constraints) else { return Ok(()) };
        let coverage = kwise_coverage(&rules, k, tests.iter().map(Vec::as_slice)).unwrap();
        let kept = |test: &&Vec<usize>| constraints.iter().all(|constraint| keeps(constraint, test));
        let every = all_tests(&levels);
        let every: Vec<&Vec<usize>> = every.iter().filter(kept).collect();
        let (valid, covered) = (tuples_of(every.iter().copied(), k), tuples_of(tests.iter().filter(kept), k));
        prop_assert_eq!(coverage.valid, valid.len() as u64);
        prop_assert_eq!(coverage.covered, covered.len() as u64);
        prop_assert_eq!(coverage.ratio(), covered.len() as f64 / valid.len() as f64);
        let parameters = |tuple: &Tuple| tuple.iter().map(|(parameter, _)| *parameter).collect::<Vec<_>>();
        let mut missing: Vec<Tuple> = valid.difference(&covered).cloned().collect();
        missing.sort_by_key(|tuple| (parameters(tuple), tuple.clone()));
        missing.truncate(MISSING_LISTED);
        prop_assert_eq!(coverage.missing, missing);
        let distinct: BTreeSet<_> = tests.iter().filter(kept).collect();
        prop_assert_eq!(coverage.combinations, Some(distinct.len() as f64 / every.len() as f64));
        let invalid: Vec<usize> = (0..tests.len()).filter(|&i| !kept(&&tests[i])).collect();
        prop_assert_eq!(coverage.invalid, invalid);
    }

    #[test]
    fn a_counter_knows_the_coverage_after_every_test((levels, constraints, k, tests) in study()) {
        let Ok(rules) = Rules::new(&levels, &constraints) else { return Ok(()) };
        let mut counter = KwiseCounter::new(&rules, k).unwrap();
        for (i, test) in tests.iter().enumerate() {
            let before = counter.covered();
            let gain = counter.gain(test).unwrap();
            prop_assert_eq!(counter.add(test).unwrap(), gain);
            prop_assert_eq!(counter.covered(), before + gain);
            let coverage = kwise_coverage(&rules, k, tests[..=i].iter().map(Vec::as_slice)).unwrap();
            prop_assert_eq!((counter.valid(), counter.covered()), (coverage.valid, coverage.covered));
        }
    }
}

/// A space with constraints, some of its values negative, groups with a strength each, and tests.
type Demanding = (Vec<usize>, Vec<Vec<Clause>>, Vec<(usize, usize)>, Vec<usize>, usize, Vec<Vec<usize>>);

fn demanding() -> impl Strategy<Value = Demanding> {
    models().prop_flat_map(|(levels, constraints)| {
        let test: Vec<_> = levels.iter().map(|&v| 0..v).collect();
        let pairs: Vec<(usize, usize)> = (0..levels.len()).flat_map(|p| (0..levels[p]).map(move |l| (p, l))).collect();
        let negatives = prop::sample::subsequence(pairs.clone(), 0..=pairs.len().min(4));
        let all: Vec<usize> = (0..levels.len()).collect();
        let group = prop::sample::subsequence(all, 1..=levels.len());
        let group = group.prop_flat_map(|group| (Just(group.clone()), 1..=group.len()));
        (Just(levels), Just(constraints), negatives, group, prop::collection::vec(test, 0..12)).prop_map(
            |(levels, constraints, negatives, (group, k), tests)| (levels, constraints, negatives, group, k, tests),
        )
    })
}

/// What tests show of a group: of a test with a negative value only combinations with that value, of one with several
/// nothing.
fn shown<'a>(
    tests: impl IntoIterator<Item = &'a Vec<usize>>,
    negatives: &[(usize, usize)],
    group: &[usize],
    k: usize,
) -> BTreeSet<Tuple> {
    let mut shown = BTreeSet::new();
    for test in tests {
        let own = (0..test.len()).filter(|&p| negatives.contains(&(p, test[p]))).collect::<Vec<_>>();
        let entries: Tuple = group.iter().map(|&p| (p, test[p])).collect();
        let tuples = subsets(&entries, k).into_iter();
        shown.extend(tuples.filter(|tuple| match own[..] {
            [] => true,
            [only] => tuple.iter().any(|(parameter, _)| *parameter == only),
            _ => false,
        }));
    }
    shown
}

proptest! {
    #[test]
    fn groups_and_negative_values_count_as_test_by_test(
        (levels, constraints, negatives, group, k, tests) in demanding()
    ) {
        let kept = |test: &&Vec<usize>| constraints.iter().all(|constraint| keeps(constraint, test));
        let few = |test: &&Vec<usize>| negatives.iter().filter(|(p, l)| test[*p] == *l).count() <= 1;
        let every = all_tests(&levels);
        let every: Vec<&Vec<usize>> = every.iter().filter(kept).filter(few).collect();
        let Ok(kinds) = TestKind::all(&levels, &constraints, &negatives) else {
            prop_assert!(every.is_empty());
            return Ok(());
        };
        let coverage = coverage_of_kinds(&kinds, &group, k, tests.iter().map(Vec::as_slice)).unwrap();
        let valid = shown(every.iter().copied(), &negatives, &group, k);
        let covered = shown(tests.iter().filter(kept), &negatives, &group, k);
        prop_assert_eq!((coverage.valid, coverage.covered), (valid.len() as u64, covered.len() as u64));
        let parameters = |tuple: &Tuple| tuple.iter().map(|(parameter, _)| *parameter).collect::<Vec<_>>();
        let mut missing: Vec<Tuple> = valid.difference(&covered).cloned().collect();
        missing.sort_by_key(|tuple| (parameters(tuple), tuple.clone()));
        missing.truncate(MISSING_LISTED);
        prop_assert_eq!(coverage.missing, missing);
        let sound = |test: &&Vec<usize>| kept(test) && few(test);
        let distinct: BTreeSet<_> = tests.iter().filter(sound).collect();
        prop_assert_eq!(coverage.combinations, Some(distinct.len() as f64 / every.len() as f64));
        let invalid: Vec<usize> = (0..tests.len()).filter(|&i| !sound(&&tests[i])).collect();
        prop_assert_eq!(coverage.invalid, invalid);
    }

    #[test]
    fn a_counter_of_a_group_knows_its_coverage((levels, constraints, _, group, k, tests) in demanding()) {
        let Ok(rules) = Rules::new(&levels, &constraints) else { return Ok(()) };
        let mut counter = KwiseCounter::among(&rules, &group, k).unwrap();
        for (i, test) in tests.iter().enumerate() {
            let gain = counter.gain(test).unwrap();
            prop_assert_eq!(counter.add(test).unwrap(), gain);
            let kept = tests[..=i].iter().filter(|test| constraints.iter().all(|constraint| keeps(constraint, test)));
            prop_assert_eq!(counter.covered(), shown(kept, &[], &group, k).len() as u64);
        }
    }
}

#[test]
fn more_than_64_mebibytes_are_not_kept() {
    let kept = |levels: usize, k| KwiseCounter::new(&Rules::free(&[levels; 2]), k).map(|counter| counter.valid());
    assert_eq!(kept(23_000, 2), Ok(529_000_000));
    // A row of 33,000 bits lies in 517 words.
    assert_eq!(kept(33_000, 2), Err(KwiseError::Memory { k: 2, mebibytes: (33_000u128 * 517).div_ceil(1 << 17) }));
    assert_eq!(kept(33_000, 1), Ok(66_000));
    assert!(kwise_coverage(&Rules::free(&[33_000; 2]), 2, std::iter::empty()).is_ok());
}

#[test]
fn many_levels_and_long_sets_of_tests_are_counted_across_words() {
    let levels = [70, 1, 130, 3];
    let rules = Rules::free(&levels);
    let tests: Vec<Vec<usize>> = (0..500).map(|i| vec![i * 7 % 70, 0, i * 11 % 130, i % 3]).collect();
    let mut counter = KwiseCounter::new(&rules, 3).unwrap();
    tests.iter().for_each(|test| {
        counter.add(test).unwrap();
    });
    let coverage = kwise_coverage(&rules, 3, tests.iter().map(Vec::as_slice)).unwrap();
    let covered = tuples_of(&tests, 3).len() as u64;
    assert_eq!(
        (coverage.covered, counter.covered(), coverage.valid),
        (covered, covered, 70 * 133 + 130 * 3 + 70 * 130 * 3)
    );
}

#[test]
fn what_cannot_be_counted_is_refused() {
    let of = |levels: &[usize], k, test: &'static [usize]| {
        kwise_coverage(&Rules::free(levels), k, std::iter::once(test)).unwrap_err()
    };
    assert_eq!(of(&[2, 2], 0, &[0, 0]), KwiseError::Strength { k: 0, parameters: 2 });
    assert_eq!(of(&[2, 2], 3, &[0, 0]), KwiseError::Strength { k: 3, parameters: 2 });
    assert_eq!(of(&[], 1, &[]), KwiseError::Strength { k: 1, parameters: 0 });
    assert_eq!(of(&[2, 0], 1, &[0, 0]), KwiseError::NoLevel(1));
    assert_eq!(of(&[2, 2], 1, &[0]), KwiseError::Ragged { index: 0, found: 1, expected: 2 });
    assert_eq!(of(&[2, 2], 1, &[0, 2]), KwiseError::Level { index: 0, parameter: 1, found: 2, levels: 2 });
    assert_eq!(of(&[1 << 17; 2], 2, &[0, 0]), KwiseError::TooMany { k: 2, found: 1 << 34 });
    assert!(matches!(of(&[usize::MAX; 9], 9, &[0; 9]), KwiseError::TooMany { found: u128::MAX, .. }));
}

fn random_rows(levels: &[usize], k: usize) -> RandomRows {
    RandomRows::new(&Rules::free(levels), k).expect("nothing is entangled")
}

/// The probability that `n` uniform draws out of `values` show each of them, by inclusion and exclusion.
fn all_shown(values: u32, n: u64) -> f64 {
    let mut sum = 0.0;
    let mut binomial = 1.0;
    for absent in 0..=values {
        let sign = if absent % 2 == 0 { 1.0 } else { -1.0 };
        sum += sign * binomial * libm::pow(1.0 - f64::from(absent) / f64::from(values), n as f64);
        binomial = binomial * f64::from(values - absent) / f64::from(absent + 1);
    }
    sum
}

#[test]
fn a_random_family_of_the_promised_size_covers_with_the_promised_probability() {
    for delta in [0.9, 0.5, 0.1, 0.01, 1e-6] {
        // One set of parameters: the rows draw out of all its combinations.
        for levels in [&[2][..], &[3], &[2, 2], &[2, 3], &[2, 2, 2], &[3, 4]] {
            let values = levels.iter().product::<usize>() as u32;
            let n = random_rows(levels, levels.len()).family_size(delta);
            assert!(all_shown(values, n) >= 1.0 - delta, "{levels:?} {delta}: {n}");
        }
        // k = 1: each parameter on its own.
        for levels in [&[2, 2, 2][..], &[2, 3, 4], &[1, 5]] {
            let n = random_rows(levels, 1).family_size(delta);
            let shown: f64 = levels.iter().map(|&v| all_shown(v as u32, n)).product();
            assert!(shown >= 1.0 - delta, "{levels:?} {delta}: {n}");
        }
    }
}

/// The sum that the union bound keeps below delta, set by set.
fn missed(levels: &[usize], k: usize, n: u64) -> f64 {
    let entries: Tuple = levels.iter().copied().enumerate().collect();
    let products = subsets(&entries, k).into_iter().map(|set| set.iter().map(|(_, v)| *v as f64).product::<f64>());
    products.map(|p| p * libm::pow(1.0 - 1.0 / p, n as f64)).sum()
}

#[test]
fn with_too_many_different_products_the_union_bound_still_is_one() {
    let levels: Vec<usize> = (2..=90).collect();
    let n = random_rows(&levels, 3).union_bound(0.05);
    assert!(missed(&levels, 3, n) <= 0.05);
    assert!(missed(&levels, 3, (n as f64 / 1.025) as u64) > 0.05);
}

#[test]
fn the_union_bound_is_the_least_number_that_meets_its_sum() {
    for levels in [&[2, 2, 2, 2][..], &[3, 2, 5, 2], &[1, 4, 4], &[1, 1]] {
        for k in 1..=levels.len() {
            for delta in [0.7, 0.05, 1e-9] {
                let n = random_rows(levels, k).union_bound(delta);
                assert!(
                    missed(levels, k, n) <= delta && missed(levels, k, n - 1) > delta,
                    "{levels:?} {k} {delta}: {n}"
                );
            }
        }
    }
}

#[test]
fn the_papers_formula_is_4_percent_above_the_union_bound_at_k_3_and_36_at_k_6() {
    let mut above = Vec::new();
    for k in 3..=6 {
        for parameters in [10, 20, 50, 100] {
            let levels = vec![2; parameters];
            let paper = proposition_3_2(parameters, k, 0.05);
            assert_eq!(random_rows(&levels, k).family_size(0.05), paper.ceil() as u64);
            above.push(paper / random_rows(&levels, k).union_bound(0.05) as f64);
        }
    }
    let (least, most) = (above.iter().copied().fold(f64::MAX, f64::min), above.iter().copied().fold(0.0, f64::max));
    assert!((least - 1.04).abs() < 0.01 && (most - 1.36).abs() < 0.02, "{least} {most}");
}

#[test]
fn where_the_papers_formula_falls_short_the_union_bound_is_taken() {
    assert_eq!(proposition_3_2(1, 1, 0.9).ceil(), 1.0);
    assert_eq!(random_rows(&[2], 1).union_bound(0.9), 2);
    assert_eq!(random_rows(&[2], 1).family_size(0.9), 2);
}

#[test]
fn numbers_of_rows_beyond_counting_saturate() {
    assert_eq!(random_rows(&[1_000_000; 40], 40).union_bound(0.1), u64::MAX);
    assert!(random_rows(&[2; 2000], 8).union_bound(0.1) > 10_000);
}
