//! Strategies whose tests draw their discrete values each for itself.

use paracosm_generators::{Request, Strategy};
use paracosm_space::{Point, Space};
use std::collections::BTreeMap;

const WORDS: &str = "{ name = \"a\", choice = [\"x\", \"y\", \"z\"] }, { name = \"b\", choice = [1, 2, 3] },
    { name = \"c\", choice = [\"no\", \"yes\"] }";

fn space(numbers: &str) -> Space {
    let text = format!("constraints = [\"a == 'x' implies b != 3\"]\nparameter = [{numbers}{WORDS}]");
    Space::from_toml(&text).unwrap()
}

fn mixed() -> Space {
    space("{ name = \"u\", interval = [0, 1] }, { name = \"v\", interval = [0, 1] }, ")
}

fn tests(strategy: Strategy, space: &Space, budget: usize, portions: &[usize]) -> Vec<Point> {
    let request = Request { seed: Some(3), ..Request::new(space, budget) };
    let mut generator = strategy.build_independent(&request).unwrap();
    portions.iter().flat_map(|&n| generator.ask(n)).collect()
}

#[test]
fn every_valid_combination_is_as_probable_as_any_other() {
    let space = mixed();
    let mut seen: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
    for test in tests(Strategy::RANDOM, &space, 16_000, &[16_000]) {
        *seen.entry(test.discrete).or_default() += 1;
    }
    // 18 less two; 1,000 of each are expected, with a deviation of 31.
    assert_eq!(seen.len(), 16);
    assert!(seen.values().all(|count| (850..=1150).contains(count)), "{seen:?}");
}

#[test]
fn the_points_are_those_of_one_set_however_many_rows_there_are() {
    let continuous = Space::unit_cube(2);
    for strategy in [Strategy::RANDOM, Strategy::HALTON, Strategy::LHS, Strategy::HAMMERSLEY, Strategy::SOBOL_OWEN] {
        let alone = strategy.build(&Request { seed: Some(3), ..Request::new(&continuous, 40) }).unwrap().ask(40);
        let joined = tests(strategy, &mixed(), 40, &[40]);
        assert!(alone.iter().zip(&joined).all(|(alone, joined)| alone.continuous == joined.continuous), "{strategy}");
    }
}

#[test]
fn portions_do_not_matter() {
    for space in [mixed(), space("")] {
        for strategy in [Strategy::RANDOM, Strategy::HALTON, Strategy::RANDOM_CORNERS] {
            assert_eq!(tests(strategy, &space, 14, &[14]), tests(strategy, &space, 14, &[1, 6, 4, 3]), "{strategy}");
        }
    }
}

#[test]
fn without_continuous_parameters_every_valid_test_comes_once_and_then_no_more() {
    let tests = tests(Strategy::HALTON, &space(""), 500, &[10, 10, 10]);
    let mut rows: Vec<_> = tests.iter().map(|test| test.discrete.clone()).collect();
    rows.sort();
    rows.dedup();
    assert_eq!((tests.len(), rows.len()), (16, 16));
}

#[test]
fn what_looks_at_both_kinds_together_or_has_one_kind_only_is_as_it_was() {
    let space = mixed();
    let request = Request { seed: Some(3), ..Request::new(&space, 30) };
    for strategy in [Strategy::GREEDY, Strategy::CMAES] {
        let usual = strategy.build(&request).unwrap().ask(8);
        assert_eq!(strategy.build_independent(&request).unwrap().ask(8), usual);
    }
    let cube = Space::unit_cube(2);
    let request = Request::new(&cube, 30);
    assert_eq!(
        Strategy::HALTON.build_independent(&request).unwrap().ask(8),
        Strategy::HALTON.build(&request).unwrap().ask(8)
    );
}
