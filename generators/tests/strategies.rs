//! What each strategy and family promises beyond the conformance suite, and what is refused.

use paracosm_coverage::{Deadline, Domain, Parameter, Point, PointSet, Space, Value, dispersion::dispersion, theory};
use paracosm_generators::{DiscreteFamily, GeneratorError, Request, Strategy};
use std::{collections::BTreeSet, fs};

fn mixed(dims: usize, levels: &[usize]) -> Space {
    let choice = |(i, &levels): (usize, &usize)| {
        Parameter::new(format!("c{i}"), Domain::Choice((0..levels).map(|v| Value::Number(v as f64)).collect()))
    };
    let mut parameters = Space::unit_cube(dims).parameters().to_vec();
    parameters.extend(levels.iter().enumerate().map(choice));
    Space::new(parameters).expect("a valid space")
}

fn tests(strategy: Strategy, request: &Request) -> Vec<Point> {
    strategy.build(request).unwrap_or_else(|error| panic!("{strategy}: {error}")).ask(request.budget)
}

fn refusal(strategy: Strategy, request: &Request) -> GeneratorError {
    strategy.build(request).err().expect("a refusal")
}

/// The rows of the family: what is asked for where nothing is continuous.
fn rows(request: &Request) -> Vec<Vec<usize>> {
    let mut generator = Strategy::Random.build(request).expect("a family");
    generator.ask(100_000).into_iter().map(|test| test.discrete).collect()
}

/// The tests of one row in the order of the tests.
fn of_row(tests: &[Point], row: &[usize]) -> Vec<Vec<f64>> {
    tests.iter().filter(|test| test.discrete == row).map(|test| test.continuous.clone()).collect()
}

fn assert_one_point_per_cell(points: &[Vec<f64>]) {
    let n = points.len();
    for axis in 0..points[0].len() {
        let cells: BTreeSet<usize> = points.iter().map(|point| (point[axis] * n as f64) as usize).collect();
        assert_eq!(cells, (0..n).collect(), "axis {axis}");
    }
}

#[test]
fn halton_equals_the_reference_points() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/point_sets.json");
    let text = fs::read_to_string(path).expect("the reference data");
    let reference: serde_json::Value = serde_json::from_str(&text).expect("valid JSON");
    let sets = reference["sets"].as_array().expect("a list of sets");
    let mut compared = 0;
    for set in sets.iter().filter(|set| set["name"].as_str().is_some_and(|name| name.starts_with("halton_"))) {
        let points: Vec<Vec<f64>> = serde_json::from_value(set["points"].clone()).expect("a list of points");
        let space = Space::unit_cube(points[0].len());
        let ours = tests(Strategy::Halton, &Request::new(&space, points.len()));
        for (ours, theirs) in ours.iter().zip(&points) {
            for (ours, theirs) in ours.continuous.iter().zip(theirs) {
                assert!((ours - theirs).abs() <= 1e-15, "{}: {ours} is not {theirs}", set["name"]);
            }
            compared += 1;
        }
    }
    assert!(compared > 100, "only {compared} points compared");
}

#[test]
fn skipping_starts_a_sequence_later_and_skip_0_at_the_corner() {
    let space = Space::unit_cube(3);
    for strategy in [Strategy::Halton, Strategy::Sobol] {
        let from = |skip| tests(strategy, &Request { skip: Some(skip), ..Request::new(&space, 50) });
        assert_eq!(from(0)[7..], from(7)[..43]);
    }
    let from_0 = tests(Strategy::Halton, &Request { skip: Some(0), ..Request::new(&space, 50) });
    assert_eq!(from_0[0].continuous, [0.0; 3]);
    assert_eq!(from_0[1..], tests(Strategy::Halton, &Request::new(&space, 49))[..]);
}

#[test]
fn a_seed_shifts_all_halton_points_by_the_same_vector() {
    let space = Space::unit_cube(4);
    let plain = tests(Strategy::Halton, &Request::new(&space, 100));
    let shifted = tests(Strategy::Halton, &Request { seed: Some(0), ..Request::new(&space, 100) });
    let shift = |i: usize, axis: usize| (shifted[i].continuous[axis] - plain[i].continuous[axis]).rem_euclid(1.0);
    for axis in 0..4 {
        assert!(shift(0, axis) > 0.0);
        assert!((1..100).all(|i| (shift(i, axis) - shift(0, axis)).abs() < 1e-12));
    }
}

#[test]
fn every_row_of_a_mixed_family_gets_a_contiguous_block_of_the_sequence() {
    let (space, cube) = (mixed(2, &[3, 2]), Space::unit_cube(2));
    for (strategy, seed) in [(Strategy::Halton, None), (Strategy::Sobol, Some(5)), (Strategy::Random, Some(5))] {
        let request = Request { seed, discrete: DiscreteFamily::Cross, ..Request::new(&space, 500) };
        let dealt = tests(strategy, &request);
        // 500 tests over 6 rows: blocks of 84, of which the last four rows use 83.
        let sequence = tests(strategy, &Request { seed, ..Request::new(&cube, 6 * 84) });
        for row in 0..6 {
            let block = of_row(&dealt, &[row / 2, row % 2]);
            let expected = sequence[row * 84..][..block.len()].iter().map(|test| test.continuous.clone());
            assert_eq!(block.len(), if row < 2 { 84 } else { 83 });
            assert_eq!(block, expected.collect::<Vec<_>>(), "{strategy}, row {row}");
        }
    }
}

#[test]
fn no_row_of_a_mixed_family_has_a_large_hole() {
    let space = mixed(2, &[3, 2]);
    let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 500) };
    let dealt = tests(Strategy::Halton, &request);
    let hole = |row: usize| {
        let points = PointSet::new(2, of_row(&dealt, &[row / 2, row % 2])).expect("points of the cube");
        dispersion(&points, Deadline::never()).volume.upper
    };
    let worst = (0..6).map(hole).fold(0.0, f64::max);
    // Computed independently, by a sweep over the plane. Dealt round-robin, the worst row's would be 0.67.
    assert!((worst - 0.0597).abs() < 5e-5, "{worst}");
}

#[test]
fn the_first_tests_go_round_all_rows() {
    let space = mixed(1, &[3, 2]);
    let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 500) };
    let first: Vec<_> = tests(Strategy::Halton, &request).into_iter().take(6).map(|test| test.discrete).collect();
    assert_eq!(first, [[0, 0], [0, 1], [1, 0], [1, 1], [2, 0], [2, 1]]);
}

#[test]
fn lhs_has_one_point_per_cell_on_every_axis() {
    for (dims, n) in [(1, 1), (1, 10), (3, 49), (20, 1000)] {
        let space = Space::unit_cube(dims);
        let points = tests(Strategy::Lhs, &Request::new(&space, n));
        assert_one_point_per_cell(&points.into_iter().map(|test| test.continuous).collect::<Vec<_>>());
    }
}

#[test]
fn every_row_gets_a_latin_hypercube_of_its_own_even_where_the_budget_does_not_divide() {
    let space = mixed(3, &[3, 2]);
    let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 500) };
    let dealt = tests(Strategy::Lhs, &request);
    let hypercubes: Vec<_> = (0..6).map(|row| of_row(&dealt, &[row / 2, row % 2])).collect();
    hypercubes.iter().for_each(|points| assert_one_point_per_cell(points));
    assert_ne!(hypercubes[0], hypercubes[1]);
}

#[test]
fn lhs_ends_with_its_budget_and_sequences_go_on() {
    let space = Space::unit_cube(2);
    for strategy in Strategy::ALL {
        let mut generator = strategy.build(&Request::new(&space, 10)).expect("a generator");
        assert_eq!(generator.ask(1000).len(), if strategy == Strategy::Lhs { 10 } else { 1000 }, "{strategy}");
    }
}

#[test]
fn a_power_of_two_of_sobol_points_is_stratified_on_every_axis_in_all_256_dimensions() {
    let space = Space::unit_cube(256);
    let points = tests(Strategy::Sobol, &Request { seed: Some(9), ..Request::new(&space, 1024) });
    assert_one_point_per_cell(&points.into_iter().map(|test| test.continuous).collect::<Vec<_>>());
}

#[test]
fn sobol_refuses_what_it_cannot_give() {
    let (cube, wide, rows) = (Space::unit_cube(2), Space::unit_cube(257), mixed(2, &[2, 3]));
    let limit = |points, dims| GeneratorError::SobolLimit { points, dims };
    let request = Request::new(&cube, 65_536);
    assert!(Strategy::Sobol.build(&request).is_ok());
    assert_eq!(refusal(Strategy::Sobol, &Request { skip: Some(1), ..request }), limit(65_537, 2));
    assert_eq!(refusal(Strategy::Sobol, &Request { skip: Some(u64::MAX), ..request }), limit(u64::MAX, 2));
    assert_eq!(refusal(Strategy::Sobol, &Request::new(&wide, 10)), limit(10, 257));
    // 6 rows with blocks of 10,923.
    let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&rows, 65_536) };
    assert_eq!(refusal(Strategy::Sobol, &request), limit(65_538, 2));
    assert!(limit(65_537, 2).to_string().contains("at most 65,536 points"));
}

#[test]
fn sobol_ends_where_its_points_end() {
    let space = Space::unit_cube(1);
    let mut generator = Strategy::Sobol.build(&Request::new(&space, 10)).expect("a generator");
    assert_eq!(generator.ask(100_000).len(), 65_536);
    assert!(generator.ask(1).is_empty());
}

#[test]
fn a_random_family_covers_all_pairs_at_least_as_often_as_promised() {
    for levels in [vec![2; 8], vec![3, 2, 4, 2, 3]] {
        let space = mixed(0, &levels);
        let delta = 0.2;
        let covers_all_pairs = |seed: u64| {
            let discrete = DiscreteFamily::Random { delta };
            let rows = rows(&Request { seed: Some(seed), discrete, k: Some(2), ..Request::new(&space, 1) });
            // Rows that repeat one are left out: they would be the same test again.
            assert!(rows.len() as u64 <= theory::random_family_size(&levels, 2, delta));
            assert_eq!(rows.iter().collect::<BTreeSet<_>>().len(), rows.len());
            (0..levels.len()).all(|i| {
                (0..i).all(|j| {
                    let pairs: BTreeSet<_> = rows.iter().map(|row| (row[i], row[j])).collect();
                    pairs.len() == levels[i] * levels[j]
                })
            })
        };
        let seeds = 1000;
        let complete = (0..seeds).filter(|&seed| covers_all_pairs(seed)).count();
        assert!(complete as f64 >= (1.0 - delta) * seeds as f64, "{complete} of {seeds} families are complete");
    }
}

#[test]
fn the_random_family_has_as_many_rows_as_the_proposition_asks_for() {
    let (levels, delta) = ([2; 8], 0.2);
    let size = theory::random_family_size(&levels, 2, delta) as usize;
    let space = mixed(1, &levels);
    let request = Request { discrete: DiscreteFamily::Random { delta }, ..Request::new(&space, 3 * size) };
    let tests = Strategy::Halton.build(&request).expect("a generator").ask(3 * size);
    // Tests are dealt to the rows in turn.
    assert!((0..2 * size).all(|i| tests[i].discrete == tests[i + size].discrete));
    assert!((1..size).any(|i| tests[0].discrete != tests[i].discrete));
}

#[test]
fn the_cross_family_is_all_combinations_the_first_parameter_slowest() {
    let space = mixed(0, &[2, 3, 2]);
    let rows = rows(&Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 1) });
    assert_eq!(rows.len(), 12);
    assert!(rows.is_sorted());
    assert_eq!(rows.iter().collect::<BTreeSet<_>>().len(), 12);
    assert_eq!((&rows[0][..], &rows[11][..]), (&[0, 0, 0][..], &[1, 2, 1][..]));
}

#[test]
fn a_budget_below_the_number_of_rows_gives_its_first_rows_one_test_each() {
    let space = mixed(2, &[10, 10]);
    let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 7) };
    for strategy in Strategy::ALL {
        let discrete: Vec<_> = tests(strategy, &request).into_iter().map(|test| test.discrete).collect();
        assert_eq!(discrete, (0..7).map(|level| vec![0, level]).collect::<Vec<_>>(), "{strategy}");
    }
}

#[test]
fn what_cannot_be_built_is_refused_with_the_numbers() {
    let (empty, cube, rows) = (Space::unit_cube(0), Space::unit_cube(2), mixed(1, &[2, 3]));
    let huge = mixed(1, &[11; 7]);
    let beyond = mixed(1, &[1000; 7]);
    let random = |delta| DiscreteFamily::Random { delta };
    let check = |strategy, request: Request, message: &str| {
        assert_eq!(refusal(strategy, &request).to_string(), message);
    };
    use Strategy::{Halton, Lhs, Random};
    check(Halton, Request::new(&empty, 5), "the space has no parameters; a generator needs at least one");
    check(Halton, Request::new(&cube, 0), "the budget is 0 tests; a budget must be at least 1");
    for strategy in [Random, Lhs] {
        let message = format!("`{strategy}` is no sequence and cannot skip; the sequences are halton, sobol");
        check(strategy, Request { skip: Some(3), ..Request::new(&cube, 5) }, &message);
    }
    for k in [0, 3] {
        let message = format!("k is {k}, but the space has 2 discrete parameters; k must be from 1 to their number");
        check(Halton, Request { k: Some(k), ..Request::new(&rows, 5) }, &message);
    }
    for delta in [0.0, 1.0, f64::NAN, -0.5] {
        let message = format!("delta is {delta}; a probability of failure must be above 0 and below 1");
        check(Halton, Request { discrete: random(delta), ..Request::new(&rows, 5) }, &message);
    }
    check(
        Halton,
        Request { discrete: DiscreteFamily::Cross, ..Request::new(&huge, 5) },
        "the discrete family has 19487171 rows, more than 10,000,000; use the random family",
    );
    check(
        Halton,
        Request { discrete: DiscreteFamily::Cross, ..Request::new(&beyond, 5) },
        "the discrete family has over 10^19 rows, more than 10,000,000; use the random family",
    );
    let refused = refusal(Halton, &Request { k: Some(7), ..Request::new(&huge, 5) });
    assert!(refused.to_string().ends_with("more than 10,000,000; use a smaller k"), "{refused}");
    check(
        Lhs,
        Request::new(&cube, usize::MAX),
        "lhs keeps its points in memory, at most 10,000,000 coordinates; asked for 18446744073709551615 points in \
         2 dimensions; use halton",
    );
    check(
        Halton,
        Request { skip: Some(1 << 53), ..Request::new(&cube, 5) },
        "halton has indices below 2^53; asked for index 9007199254740996; skip fewer",
    );
}

#[test]
fn names_are_read_back_and_unknown_ones_meet_a_suggestion() {
    for strategy in Strategy::ALL {
        assert_eq!(strategy.name().parse(), Ok(strategy));
        assert_eq!(strategy.to_string(), strategy.name());
        assert!(!strategy.about().contains('\n'));
    }
    assert_eq!("cross".parse(), Ok(DiscreteFamily::Cross));
    assert_eq!("random".parse(), Ok(DiscreteFamily::default()));
    let error = |name: &str| name.parse::<Strategy>().expect_err("an unknown name").to_string();
    assert_eq!(error("haltom"), "no strategy is called `haltom` (did you mean `halton`?)");
    assert_eq!(error("zzz"), "no strategy is called `zzz`");
    let family = "crss".parse::<DiscreteFamily>().expect_err("an unknown name").to_string();
    assert_eq!(family, "no discrete family is called `crss` (did you mean `cross`?); there are random and cross");
}
