//! What adaptive strategies are for: failures found with far fewer tests than at random, on functions whose failures
//! are known. The margins are wide; the figures are in BENCHMARKS.md.

use paracosm_generators::{Generator, Request, Strategy};
use paracosm_space::{Domain, Parameter, Point, Space, Value};

const SEEDS: u64 = 10;
const BUDGET: usize = 300;

fn adaptive() -> impl Iterator<Item = Strategy> {
    Strategy::all().filter(|strategy| strategy.is_adaptive())
}

fn generator(strategy: Strategy, space: &Space, seed: u64) -> Box<dyn Generator> {
    strategy.build(&Request { seed: Some(seed), ..Request::new(space, BUDGET) }).expect("a generator")
}

/// The tests of a campaign with batches of 8, and how they went.
fn run(
    strategy: Strategy,
    space: &Space,
    seed: u64,
    n: usize,
    robustness: impl Fn(&Point) -> Option<f64>,
) -> Vec<(Point, Option<f64>)> {
    let mut generator = generator(strategy, space, seed);
    let mut done = Vec::new();
    while done.len() < n {
        let tests = generator.ask(8.min(n - done.len()));
        let told: Vec<Option<f64>> = tests.iter().map(&robustness).collect();
        generator.tell(&tests, &told);
        done.extend(tests.into_iter().zip(told));
    }
    done
}

/// After how many tests each of ten campaigns fails for the first time, in ascending order; the budget where none does.
fn first_failures(strategy: Strategy, space: &Space, robustness: impl Fn(&Point) -> f64) -> Vec<usize> {
    let of = |seed| {
        let mut generator = generator(strategy, space, seed);
        let mut done = 0;
        while done < BUDGET {
            let tests = generator.ask(8.min(BUDGET - done));
            let told: Vec<Option<f64>> = tests.iter().map(|test| Some(robustness(test))).collect();
            if let Some(index) = told.iter().position(|told| told.is_some_and(|r| r < 0.0)) {
                return done + index + 1;
            }
            generator.tell(&tests, &told);
            done += tests.len();
        }
        BUDGET
    };
    let mut all: Vec<usize> = (0..SEEDS).map(of).collect();
    all.sort_unstable();
    all
}

fn distance(test: &Point, centre: &[f64]) -> f64 {
    test.continuous.iter().zip(centre).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

fn with_words(dims: usize, levels: &[usize]) -> Space {
    let word = |(i, &levels): (usize, &usize)| {
        let levels = (0..levels).map(|level| Value::Word(format!("w{level}"))).collect();
        Parameter::new(format!("word{i}"), Domain::Choice(levels))
    };
    let continuous = Space::unit_cube(dims).parameters().to_vec();
    Space::new(continuous.into_iter().chain(levels.iter().enumerate().map(word)).collect()).expect("a valid space")
}

#[test]
fn a_failing_corner_of_up_to_three_parameters_is_among_the_first_eight_tests() {
    for dims in 1..=3 {
        let space = Space::unit_cube(dims);
        for (strategy, corner) in adaptive().zip([0, 1, 5, 2, 7, 3, 6]) {
            let corner: Vec<f64> = (0..dims).map(|axis| f64::from(corner >> axis & 1)).collect();
            let mut generator = generator(strategy, &space, 3);
            let tests = generator.ask(8);
            assert!(tests.iter().any(|test| distance(test, &corner) < 1e-9), "{strategy}: {corner:?}");
        }
    }
}

#[test]
fn a_ball_of_a_thousandth_in_five_dimensions_is_found_in_a_fifth_of_the_tests_that_chance_takes() {
    let space = Space::unit_cube(5);
    let centre = [0.3, 0.62, 0.41, 0.7, 0.55];
    for strategy in adaptive() {
        let tests = first_failures(strategy, &space, |test| distance(test, &centre) - 0.1801);
        // At random one in a thousand tests fails.
        assert!(tests[5] <= 150 && tests[8] <= 200, "{strategy}: {tests:?}");
    }
}

#[test]
fn a_narrow_valley_is_followed_to_its_end() {
    let space = Space::unit_cube(2);
    let valley = |test: &Point| {
        let (a, b) = (4.0 * test.continuous[0] - 2.0, 4.0 * test.continuous[1] - 1.0);
        100.0 * (b - a * a) * (b - a * a) + (1.0 - a) * (1.0 - a) - 0.04
    };
    for strategy in [Strategy::NELDER_MEAD, Strategy::GP_CMAES, Strategy::BAYES, Strategy::BOUNDARY, Strategy::AUTO] {
        let tests = first_failures(strategy, &space, valley);
        assert!(tests[6] < BUDGET, "{strategy}: {tests:?}");
    }
}

#[test]
fn a_thin_ring_is_hit() {
    let space = Space::unit_cube(2);
    for strategy in adaptive() {
        let tests = first_failures(strategy, &space, |test| (distance(test, &[0.4, 0.55]) - 0.2).abs() - 0.0008);
        assert!(tests[6] < BUDGET, "{strategy}: {tests:?}");
    }
}

#[test]
fn one_combination_of_words_in_sixty_four_with_a_disc_is_found() {
    let space = with_words(2, &[4, 4, 4]);
    let robustness = |test: &Point| {
        let wrong = test.discrete.iter().zip([2, 0, 3]).filter(|(a, b)| **a != *b).count();
        0.2 * wrong as f64 + distance(test, &[0.35, 0.6]) - 0.15
    };
    let random = first_failures(Strategy::RANDOM, &space, robustness);
    for strategy in adaptive() {
        let tests = first_failures(strategy, &space, robustness);
        assert!(tests[4] < BUDGET, "{strategy}: {tests:?}");
        assert!(tests.iter().sum::<usize>() < random.iter().sum(), "{strategy}: {tests:?}, at random {random:?}");
    }
}

#[test]
fn where_nothing_is_continuous_the_one_failing_row_in_a_thousand_is_found_by_its_neighbours() {
    let space = with_words(0, &[4, 4, 4, 4, 4]);
    let robustness =
        |test: &Point| test.discrete.iter().zip([1, 3, 0, 2, 2]).filter(|(a, b)| **a != *b).count() as f64 - 0.5;
    let strategies =
        [Strategy::ANNEAL, Strategy::CMAES, Strategy::GP_CMAES, Strategy::BAYES, Strategy::BOUNDARY, Strategy::AUTO];
    for strategy in strategies {
        let tests = first_failures(strategy, &space, robustness);
        assert!(tests[5] < 200, "{strategy}: {tests:?}");
    }
}

#[test]
fn models_learn_where_tests_end_in_errors_and_keep_away() {
    let space = Space::unit_cube(3);
    let robustness = |test: &Point| (test.continuous[0] < 0.6).then(|| distance(test, &[0.55, 0.5, 0.5]));
    for strategy in [Strategy::BAYES, Strategy::GP_CMAES] {
        let tests = run(strategy, &space, 1, 150, robustness);
        let errors = tests[50..].iter().filter(|test| test.1.is_none()).count();
        assert!(errors <= 30, "{strategy}: {errors} of 100 tests ended in an error");
        let best = tests.iter().filter_map(|test| test.1).fold(f64::INFINITY, f64::min);
        assert!(best < 0.02, "{strategy}: {best}");
    }
}

#[test]
fn samples_that_a_model_chooses_find_a_failure_in_half_the_tests_of_all_samples() {
    let space = Space::unit_cube(5);
    let robustness = |test: &Point| distance(test, &[0.35, 0.6, 0.45, 0.7, 0.3]) - 0.18;
    let tests = |strategy| first_failures(strategy, &space, robustness).iter().sum::<usize>();
    let (all, chosen) = (tests(Strategy::CMAES), tests(Strategy::GP_CMAES));
    assert!(2 * chosen < all, "{chosen}, of all samples {all}");
}

#[test]
fn a_space_in_which_every_test_is_an_error_is_searched_on() {
    let space = with_words(2, &[3]);
    for strategy in adaptive() {
        assert_eq!(run(strategy, &space, 1, 80, |_| None).len(), 80, "{strategy}");
    }
}

#[test]
fn boundary_tests_both_sides_of_the_boundary_close_to_it() {
    let space = Space::unit_cube(2);
    let robustness = |test: &Point| Some(distance(test, &[0.45, 0.5]) - 0.3);
    let median = |strategy| {
        let tests = run(strategy, &space, 2, 120, robustness);
        let mut away: Vec<f64> = tests[40..].iter().filter_map(|test| test.1).map(f64::abs).collect();
        let failed = tests[40..].iter().filter(|test| test.1 < Some(0.0)).count();
        assert!((15..=65).contains(&failed), "{strategy}: {failed}");
        away.sort_by(f64::total_cmp);
        away[40]
    };
    let (boundary, halton) = (median(Strategy::BOUNDARY), median(Strategy::HALTON));
    assert!(3.0 * boundary < halton, "{boundary} {halton}");
}

#[test]
fn adaptive_tests_cluster_where_they_fail() {
    let space = Space::unit_cube(3);
    let robustness = |test: &Point| Some(distance(test, &[0.7, 0.3, 0.4]) - 0.15);
    let failed = |strategy| {
        let tests = run(strategy, &space, 4, 150, robustness);
        tests.iter().filter(|test| test.1 < Some(0.0)).count()
    };
    let random = failed(Strategy::RANDOM);
    for strategy in adaptive().filter(|strategy| *strategy != Strategy::BOUNDARY) {
        assert!(failed(strategy) > 5 * random.max(2), "{strategy}: {}, at random {random}", failed(strategy));
    }
}
