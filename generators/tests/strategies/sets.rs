//! The points of each strategy, and how rows share them.

use super::*;

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

/// The vector by which all points are moved, modulo 1; None if there is no such vector.
fn shift_between(from: &[Point], to: &[Vec<f64>]) -> Option<Vec<f64>> {
    let difference = |a: &Point, b: &[f64]| -> Vec<f64> {
        a.continuous.iter().zip(b).map(|(a, b)| (b - a).rem_euclid(1.0)).collect()
    };
    let shift = difference(&from[0], &to[0]);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12 || (a - b).abs() > 1.0 - 1e-12;
    let same = |(a, b): (&Point, &Vec<f64>)| difference(a, b).into_iter().zip(&shift).all(|(a, &b)| near(a, b));
    from.iter().zip(to).all(same).then_some(shift)
}

#[test]
fn skipping_starts_a_sequence_later_and_skip_0_at_the_corner() {
    let space = Space::unit_cube(3);
    for strategy in
        [Strategy::HALTON, Strategy::HALTON_SCRAMBLED, Strategy::SOBOL, Strategy::SOBOL_OWEN, Strategy::KRONECKER]
    {
        let from = |skip| tests(strategy, &Request { skip: Some(skip), ..Request::new(&space, 50) });
        assert_eq!(from(0)[7..], from(7)[..43]);
    }
    let from_0 = tests(Strategy::HALTON, &Request { skip: Some(0), ..Request::new(&space, 50) });
    assert_eq!(from_0[0].continuous, [0.0; 3]);
    assert_eq!(from_0[1..], tests(Strategy::HALTON, &Request::new(&space, 49))[..]);
}

#[test]
fn a_seed_shifts_all_points_by_the_same_vector() {
    let space = Space::unit_cube(2);
    for strategy in
        [Strategy::HALTON, Strategy::KRONECKER, Strategy::HAMMERSLEY, Strategy::FIBONACCI, Strategy::LATTICE]
    {
        let plain = tests(strategy, &Request::new(&space, 100));
        let shifted = |seed| {
            let tests = tests(strategy, &Request { seed: Some(seed), ..Request::new(&space, 100) });
            let points: Vec<_> = tests.into_iter().map(|test| test.continuous).collect();
            shift_between(&plain, &points).unwrap_or_else(|| panic!("{strategy} is not shifted"))
        };
        assert!(shifted(0).iter().all(|&shift| shift > 0.0), "{strategy}");
        assert_ne!(shifted(0), shifted(1), "{strategy}");
    }
}

#[test]
fn strategies_with_a_plain_set_give_another_one_with_a_seed_and_the_others_seed_0() {
    let space = Space::unit_cube(2);
    for strategy in Strategy::all() {
        let plain = tests(strategy, &Request::new(&space, 50));
        let seeded = tests(strategy, &Request { seed: Some(0), ..Request::new(&space, 50) });
        assert_eq!(plain != seeded, strategy.has_plain_set(), "{strategy}");
    }
}

#[test]
fn every_row_of_a_mixed_family_gets_a_contiguous_block_of_the_sequence() {
    let (space, cube) = (mixed(2, &[3, 2]), Space::unit_cube(2));
    for (strategy, seed) in [
        (Strategy::HALTON, None),
        (Strategy::SOBOL, None),
        (Strategy::SOBOL_OWEN, Some(5)),
        (Strategy::KRONECKER, Some(5)),
        (Strategy::RANDOM, Some(5)),
    ] {
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
    let dealt = tests(Strategy::HALTON, &request);
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
    let first: Vec<_> = tests(Strategy::HALTON, &request).into_iter().take(6).map(|test| test.discrete).collect();
    assert_eq!(first, [[0, 0], [0, 1], [1, 0], [1, 1], [2, 0], [2, 1]]);
}

#[test]
fn latin_hypercubes_have_one_point_per_cell_on_every_axis_and_centred_ones_in_its_middle() {
    for (dims, n) in [(1, 1), (1, 10), (3, 49), (20, 1000)] {
        let space = Space::unit_cube(dims);
        for strategy in [Strategy::LHS, Strategy::LHS_CENTRED, Strategy::LHS_MAXIMIN, Strategy::LHS_DISCREPANCY] {
            let points = tests(strategy, &Request::new(&space, n));
            assert_one_point_per_cell(&points.into_iter().map(|test| test.continuous).collect::<Vec<_>>());
        }
        let centred = tests(Strategy::LHS_CENTRED, &Request::new(&space, n));
        let places = centred.iter().flat_map(|test| &test.continuous).map(|u| u * n as f64);
        assert!(places.into_iter().all(|place| (place - place.floor() - 0.5).abs() < 1e-9));
    }
}

#[test]
fn every_row_gets_a_latin_hypercube_of_its_own_even_where_the_budget_does_not_divide() {
    let space = mixed(3, &[3, 2]);
    let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 500) };
    for strategy in [Strategy::LHS, Strategy::LHS_CENTRED, Strategy::LHS_MAXIMIN, Strategy::LHS_DISCREPANCY] {
        let dealt = tests(strategy, &request);
        let hypercubes: Vec<_> = (0..6).map(|row| of_row(&dealt, &[row / 2, row % 2])).collect();
        hypercubes.iter().for_each(|points| assert_one_point_per_cell(points));
        assert_ne!(hypercubes[0], hypercubes[1]);
    }
}

#[test]
fn every_row_gets_a_lattice_of_just_its_size_and_only_the_first_one_unshifted() {
    let (space, cube) = (mixed(2, &[3, 2]), Space::unit_cube(2));
    for strategy in [Strategy::HAMMERSLEY, Strategy::FIBONACCI, Strategy::LATTICE] {
        let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 500) };
        let dealt = tests(strategy, &request);
        let mut shifts = BTreeSet::new();
        for row in 0..6 {
            let points = of_row(&dealt, &[row / 2, row % 2]);
            let plain = tests(strategy, &Request::new(&cube, points.len()));
            let shift = shift_between(&plain, &points).expect("a shifted copy");
            assert_eq!(shift == [0.0; 2], row == 0, "{strategy}, row {row}");
            shifts.insert(format!("{shift:?}"));
        }
        assert_eq!(shifts.len(), 6, "{strategy}");
    }
}

#[test]
fn sets_end_with_their_budget_and_sequences_go_on() {
    let space = Space::unit_cube(2);
    for strategy in Strategy::all() {
        let mut generator = strategy.build(&Request::new(&space, 10)).expect("a generator");
        if strategy.is_adaptive() {
            // It goes on too, a batch at a time.
            continue;
        }
        let ends = [
            Strategy::HAMMERSLEY,
            Strategy::FIBONACCI,
            Strategy::LATTICE,
            Strategy::BEST,
            Strategy::GREEDY,
            Strategy::GREEDY_PERIODIC,
            Strategy::LHS,
            Strategy::LHS_CENTRED,
            Strategy::LHS_MAXIMIN,
            Strategy::LHS_DISCREPANCY,
        ]
        .contains(&strategy);
        assert_eq!(generator.ask(1000).len(), if ends { 10 } else { 1000 }, "{strategy}");
    }
}
