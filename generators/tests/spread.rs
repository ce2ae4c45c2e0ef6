//! Tests that are spread over the rows where holes are largest, against equal shares of contiguous blocks.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::{Deadline, PointSet};
use paracosm_generators::{Aim, DiscreteFamily, Request, Strategy};
use paracosm_space::{Point, Space};
use proptest::prelude::*;
use std::collections::BTreeSet;

const STRATEGIES: [Strategy; 7] = [
    Strategy::HALTON,
    Strategy::HALTON_SCRAMBLED,
    Strategy::SOBOL,
    Strategy::KRONECKER,
    Strategy::RANDOM,
    Strategy::GREEDY,
    Strategy::GREEDY_PERIODIC,
];

/// A space of that many continuous parameters and discrete ones with these many levels.
fn mixed(dims: usize, levels: &[usize]) -> Space {
    let intervals = (0..dims).map(|i| format!("[[parameter]]\nname = \"x{i}\"\ninterval = [0, 1]\n"));
    let choices = levels.iter().enumerate().map(|(i, &levels)| {
        let levels: Vec<String> = (0..levels).map(|level| level.to_string()).collect();
        format!("[[parameter]]\nname = \"a{i}\"\nchoice = [{}]\n", levels.join(", "))
    });
    Space::from_toml(&intervals.chain(choices).collect::<String>()).expect("a valid space")
}

/// The largest dispersion of any row that has a test.
fn worst_row(dims: usize, tests: &[Point]) -> f64 {
    let rows: BTreeSet<&Vec<usize>> = tests.iter().map(|test| &test.discrete).collect();
    let of_row = |row: &&Vec<usize>| {
        let points = tests.iter().filter(|test| test.discrete == **row).map(|test| &test.continuous);
        dispersion(&PointSet::new(dims, points).expect("points of the cube"), Deadline::never()).volume.lower
    };
    rows.iter().map(of_row).fold(0.0, f64::max)
}

fn tests(strategy: Strategy, request: &Request) -> Vec<Point> {
    strategy.build(request).expect("a generator").ask(request.budget)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn no_row_is_left_worse_than_with_equal_shares(
        dims in 1..4usize,
        levels in prop::collection::vec(1..4usize, 1..4),
        strategy in prop::sample::select(&STRATEGIES[..]),
        discrete in prop::sample::select(&[DiscreteFamily::Ipog, DiscreteFamily::Cross][..]),
        budget in 1..100usize,
        seed in prop::option::of(0..100u64),
    ) {
        let space = mixed(dims, &levels);
        // Greedy has rows only where it is to make each of them good.
        let aim = strategy.fills_holes().then_some(Aim::Dispersion);
        let equal = Request { seed, discrete, aim, ..Request::new(&space, budget) };
        let spread = Request { epsilon: Some(1e-9), ..equal };
        let (dealt, spread) = (tests(strategy, &equal), tests(strategy, &spread));
        prop_assert_eq!(spread.len(), budget);
        let (spread, dealt) = (worst_row(dims, &spread), worst_row(dims, &dealt));
        prop_assert!(spread <= dealt, "{strategy}: {spread} against {dealt}");
    }

    #[test]
    fn in_whatever_portions_tests_are_asked_for_they_are_the_same(
        strategy in prop::sample::select(&STRATEGIES[..]),
        portions in prop::collection::vec(1..20usize, 1..6),
        epsilon in 0.05..0.5,
    ) {
        let space = mixed(2, &[2, 3]);
        let request = Request { epsilon: Some(epsilon), ..Request::new(&space, 60) };
        let mut generator = strategy.build(&request).expect("a generator");
        let asked: Vec<Point> = portions.iter().flat_map(|&portion| generator.ask(portion)).collect();
        let all = tests(strategy, &request);
        prop_assert_eq!(&asked[..], &all[..asked.len()]);
    }
}

#[test]
fn three_rows_that_were_once_worse_than_dealt_are_better() {
    let space = mixed(2, &[3]);
    for (budget, dealt) in [(3, 8.0 / 9.0), (45, 7.0 / 36.0)] {
        let tests = tests(Strategy::HALTON, &Request { epsilon: Some(1e-9), ..Request::new(&space, budget) });
        let worst = worst_row(2, &tests);
        assert!(worst < dealt, "{budget}: {worst}");
    }
}

#[test]
fn stopped_early_the_tests_have_looked_at_every_row_and_at_the_worst_first() {
    let space = mixed(2, &[3, 2]);
    let tests = tests(Strategy::HALTON, &Request { epsilon: Some(1e-9), ..Request::new(&space, 120) });
    let rows = |tests: &[Point]| tests.iter().map(|test| test.discrete.clone()).collect::<BTreeSet<_>>().len();
    assert_eq!(rows(&tests[..6]), 6);
    for stop in [12, 30, 60] {
        assert!(worst_row(2, &tests[..stop]) < worst_row(2, &tests[..stop / 2]));
    }
}

#[test]
fn a_budget_that_epsilon_does_not_need_is_left() {
    let space = mixed(2, &[3, 2]);
    let request = Request { epsilon: Some(0.2), ..Request::new(&space, usize::MAX) };
    let enough = tests(Strategy::HALTON, &request);
    assert!(worst_row(2, &enough) <= 0.2);
    let most = Request { budget: enough.len() + 100, ..request };
    let under_a_budget = tests(Strategy::HALTON, &most);
    assert!(under_a_budget.len() < most.budget, "{}", under_a_budget.len());
    assert!(worst_row(2, &under_a_budget) <= 0.2);
}

#[test]
fn every_row_gets_as_many_points_as_it_takes_and_no_more() {
    let space = mixed(2, &[3, 2, 2]);
    for strategy in STRATEGIES {
        let tests = tests(strategy, &Request { epsilon: Some(0.1), ..Request::new(&space, usize::MAX) });
        assert!(tests.len() < 1000, "{strategy}: {}", tests.len());
        assert!(worst_row(2, &tests) <= 0.1, "{strategy}");
        assert!(worst_row(2, &tests[..tests.len() - 1]) > 0.1, "{strategy}: the last test was needed");
    }
}

#[test]
fn points_that_are_there_count() {
    let space = mixed(2, &[3, 2, 2]);
    for strategy in [Strategy::GREEDY, Strategy::HALTON] {
        let request = Request { epsilon: Some(0.1), ..Request::new(&space, usize::MAX) };
        let all = tests(strategy, &request);
        let existing = &all[..all.len() - 5];
        let more = tests(strategy, &Request { existing, ..request });
        assert!((1..40).contains(&more.len()), "{strategy}: {}", more.len());
        assert!(worst_row(2, &[existing, &more].concat()) <= 0.1);
        let none = tests(strategy, &Request { existing: &all, ..request });
        assert!(none.is_empty(), "{strategy}: nothing is missing");
    }
}

#[test]
fn where_a_sequence_ends_the_tests_do() {
    let space = mixed(1, &[2]);
    let last = (1 << 53) - 1;
    let request = Request { epsilon: Some(0.1), skip: Some(last), ..Request::new(&space, usize::MAX) };
    assert!(tests(Strategy::SOBOL, &request).len() <= 2);
    let refused = Strategy::SOBOL.build(&Request { skip: Some(last + 1), ..request }).err();
    assert!(matches!(refused, Some(paracosm_generators::GeneratorError::IndexLimit { .. })), "{refused:?}");
}
