//! What each strategy and family promises beyond the conformance suite, and what is refused.

use paracosm_coverage::{
    Deadline, Domain, Parameter, Point, PointSet, Space, Value, dispersion::dispersion, kwise::kwise_coverage,
    kwise_dispersion::kwise_dispersion, rules::Rules, theory::rows::RandomRows,
};
use paracosm_generators::{Aim, DiscreteFamily, GeneratorError, Request, Strategy};
use std::collections::BTreeSet;

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
    use Strategy::{Halton, HaltonScrambled, HaltonShifted, Kronecker, Sobol, SobolOwen};
    for strategy in [Halton, HaltonShifted, HaltonScrambled, Sobol, SobolOwen, Kronecker] {
        let from = |skip| tests(strategy, &Request { skip: Some(skip), ..Request::new(&space, 50) });
        assert_eq!(from(0)[7..], from(7)[..43]);
    }
    let from_0 = tests(Halton, &Request { skip: Some(0), ..Request::new(&space, 50) });
    assert_eq!(from_0[0].continuous, [0.0; 3]);
    assert_eq!(from_0[1..], tests(Halton, &Request::new(&space, 49))[..]);
}

#[test]
fn a_seed_shifts_all_points_by_the_same_vector() {
    let space = Space::unit_cube(2);
    for strategy in [Strategy::Halton, Strategy::Kronecker, Strategy::Hammersley, Strategy::Fibonacci] {
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
    for strategy in Strategy::ALL {
        let plain = tests(strategy, &Request::new(&space, 50));
        let seeded = tests(strategy, &Request { seed: Some(0), ..Request::new(&space, 50) });
        assert_eq!(plain != seeded, strategy.has_plain_set(), "{strategy}");
    }
}

#[test]
fn halton_shifted_is_halton_with_a_seed_and_without_one_seed_0() {
    let space = Space::unit_cube(4);
    let request = Request::new(&space, 100);
    for seed in [0, 7] {
        let seeded = Request { seed: Some(seed), ..request };
        assert_eq!(tests(Strategy::HaltonShifted, &seeded), tests(Strategy::Halton, &seeded));
    }
    let seeded = Request { seed: Some(0), ..request };
    assert_eq!(tests(Strategy::HaltonShifted, &request), tests(Strategy::Halton, &seeded));
}

#[test]
fn every_row_of_a_mixed_family_gets_a_contiguous_block_of_the_sequence() {
    let (space, cube) = (mixed(2, &[3, 2]), Space::unit_cube(2));
    use Strategy::{Halton, Kronecker, Random, Sobol, SobolOwen};
    for (strategy, seed) in
        [(Halton, None), (Sobol, None), (SobolOwen, Some(5)), (Kronecker, Some(5)), (Random, Some(5))]
    {
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
fn latin_hypercubes_have_one_point_per_cell_on_every_axis_and_centred_ones_in_its_middle() {
    for (dims, n) in [(1, 1), (1, 10), (3, 49), (20, 1000)] {
        let space = Space::unit_cube(dims);
        for strategy in [Strategy::Lhs, Strategy::LhsCentred] {
            let points = tests(strategy, &Request::new(&space, n));
            assert_one_point_per_cell(&points.into_iter().map(|test| test.continuous).collect::<Vec<_>>());
        }
        let centred = tests(Strategy::LhsCentred, &Request::new(&space, n));
        let places = centred.iter().flat_map(|test| &test.continuous).map(|u| u * n as f64);
        assert!(places.into_iter().all(|place| (place - place.floor() - 0.5).abs() < 1e-9));
    }
}

#[test]
fn every_row_gets_a_latin_hypercube_of_its_own_even_where_the_budget_does_not_divide() {
    let space = mixed(3, &[3, 2]);
    let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 500) };
    for strategy in [Strategy::Lhs, Strategy::LhsCentred] {
        let dealt = tests(strategy, &request);
        let hypercubes: Vec<_> = (0..6).map(|row| of_row(&dealt, &[row / 2, row % 2])).collect();
        hypercubes.iter().for_each(|points| assert_one_point_per_cell(points));
        assert_ne!(hypercubes[0], hypercubes[1]);
    }
}

#[test]
fn every_row_gets_a_lattice_of_just_its_size_and_only_the_first_one_unshifted() {
    let (space, cube) = (mixed(2, &[3, 2]), Space::unit_cube(2));
    for strategy in [Strategy::Hammersley, Strategy::Fibonacci] {
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
    use Strategy::{Fibonacci, Greedy, Hammersley, Lhs, LhsCentred};
    let space = Space::unit_cube(2);
    for strategy in Strategy::ALL {
        let mut generator = strategy.build(&Request::new(&space, 10)).expect("a generator");
        if strategy.is_adaptive() {
            // It goes on too, a batch at a time.
            continue;
        }
        let ends = [Hammersley, Fibonacci, Greedy, Lhs, LhsCentred].contains(&strategy);
        assert_eq!(generator.ask(1000).len(), if ends { 10 } else { 1000 }, "{strategy}");
    }
}

fn family_size(levels: &[usize], delta: f64) -> u64 {
    RandomRows::new(&Rules::free(levels), 2).expect("nothing is entangled").family_size(delta)
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
            assert!(rows.len() as u64 <= family_size(&levels, delta));
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
fn under_constraints_a_random_family_keeps_them_and_its_promise() {
    let text = "constraints = [\"a == 0 implies b == 0\", \"b == 2 implies c == 1\"]
        parameter = [{ name = \"a\", choice = [0, 1, 2] }, { name = \"b\", choice = [0, 1, 2] },
        { name = \"c\", choice = [0, 1] }, { name = \"d\", choice = [0, 1, 2] }]";
    let space = Space::from_toml(text).expect("a valid space");
    let rules = space.rules().expect("constraints that can be kept");
    let delta = 0.2;
    let is_complete = |seed: u64| {
        let request =
            Request { seed: Some(seed), discrete: DiscreteFamily::Random { delta }, ..Request::new(&space, 1) };
        let rows = rows(&request);
        assert!(rows.iter().all(|row| (row[0] != 0 || row[1] == 0) && (row[1] != 2 || row[2] == 1)));
        let found = kwise_coverage(&rules, 2, rows.iter().map(Vec::as_slice)).expect("rows of the space");
        found.covered == found.valid
    };
    let seeds = 1000;
    let complete = (0..seeds).filter(|&seed| is_complete(seed)).count();
    assert!(complete as f64 >= (1.0 - delta) * seeds as f64, "{complete} of {seeds} families are complete");
}

#[test]
fn the_search_for_epsilon_ends_with_its_time() {
    let space = mixed(1, &[2, 2]);
    let deadline = Deadline::after(std::time::Duration::ZERO);
    let request = Request { epsilon: Some(0.1), deadline, ..Request::new(&space, 500) };
    assert!(tests(Strategy::Halton, &request).is_empty());
}

#[test]
fn the_random_family_has_as_many_rows_as_the_proposition_asks_for() {
    let (levels, delta) = ([2; 8], 0.2);
    let size = family_size(&levels, delta) as usize;
    let space = mixed(1, &levels);
    let request = Request { discrete: DiscreteFamily::Random { delta }, ..Request::new(&space, 3 * size) };
    let tests = Strategy::Halton.build(&request).expect("a generator").ask(3 * size);
    // Tests are dealt to the rows in turn.
    assert!((0..2 * size).all(|i| tests[i].discrete == tests[i + size].discrete));
    assert!((1..size).any(|i| tests[0].discrete != tests[i].discrete));
}

#[test]
fn of_fewer_discrete_parameters_than_k_all_combinations_are_covered() {
    let space = mixed(1, &[2, 3]);
    for k in [2, 3] {
        let all = tests(Strategy::Halton, &Request { k: Some(k), ..Request::new(&space, 6) });
        let rows: BTreeSet<_> = all.into_iter().map(|test| test.discrete).collect();
        assert_eq!(rows.len(), 6, "{k}");
    }
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
    for strategy in Strategy::ALL.into_iter().filter(|strategy| !strategy.is_adaptive()) {
        let aim = (strategy == Strategy::Greedy).then_some(Aim::Dispersion);
        let discrete: Vec<_> =
            tests(strategy, &Request { aim, ..request }).into_iter().map(|test| test.discrete).collect();
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
    use Strategy::{Fibonacci, Halton, HaltonScrambled, Hammersley, Kronecker, Lhs, Random, Sobol};
    check(Halton, Request::new(&empty, 5), "the space has no parameters; a generator needs at least one");
    check(Halton, Request::new(&cube, 0), "the budget is 0 tests; a budget must be at least 1");
    let sequences = "halton, halton-shifted, halton-scrambled, sobol, sobol-owen, kronecker";
    for strategy in [Random, Lhs, Fibonacci, Hammersley] {
        let message = format!("`{strategy}` is no sequence and cannot skip; the sequences are {sequences}");
        check(strategy, Request { skip: Some(3), ..Request::new(&cube, 5) }, &message);
    }
    let none = "k is 0, but the space has 2 discrete parameters; k must be from 1 to their number";
    check(Halton, Request { k: Some(0), ..Request::new(&rows, 5) }, none);
    let all = "k is 4, but the space has 3 parameters; k must be from 1 to their number";
    check(Halton, Request { k: Some(4), ..Request::new(&rows, 5) }, all);
    for delta in [0.0, 1.0, f64::NAN, -0.5] {
        let message = format!("delta is {delta}; a probability of failure must be above 0 and below 1");
        check(Halton, Request { discrete: random(delta), ..Request::new(&rows, 5) }, &message);
    }
    check(
        Halton,
        Request { discrete: DiscreteFamily::Cross, ..Request::new(&huge, 5) },
        "the discrete family has 19487171 rows, more than 10,000,000; use the family ipog",
    );
    check(
        Halton,
        Request { discrete: DiscreteFamily::Cross, ..Request::new(&beyond, 5) },
        "the discrete family has over 10^19 rows, more than 10,000,000; use the family ipog",
    );
    let refused = refusal(Halton, &Request { k: Some(7), discrete: random(0.05), ..Request::new(&huge, 5) });
    assert!(refused.to_string().ends_with("more than 10,000,000; use a smaller k, or the family ipog"), "{refused}");
    check(
        Halton,
        Request { k: Some(7), ..Request::new(&huge, 5) },
        "at least 19487171 tests are needed, more than 10000000; lower the strength",
    );
    check(
        Lhs,
        Request::new(&cube, usize::MAX),
        "a Latin hypercube is kept in memory, at most 10,000,000 coordinates; asked for 18446744073709551615 points in \
         2 dimensions; use halton",
    );
    check(
        Halton,
        Request { skip: Some(1 << 53), ..Request::new(&cube, 5) },
        "`halton` has indices below 9007199254740992; asked for index 9007199254740996; ask for fewer or skip fewer",
    );
    for strategy in [Sobol, Kronecker] {
        let message = format!(
            "`{strategy}` has indices below 9007199254740992; asked for index 18446744073709551614; ask for fewer or \
             skip fewer"
        );
        check(strategy, Request { skip: Some(u64::MAX), ..Request::new(&cube, 5) }, &message);
    }
    check(
        Hammersley,
        Request::new(&cube, usize::MAX),
        "`hammersley` has indices below 9007199254740992; asked for index 18446744073709551614; ask for fewer or \
         skip fewer",
    );
    let cubes = [1, 3, 1001, 21_202].map(Space::unit_cube);
    check(
        Fibonacci,
        Request::new(&cubes[1], 5),
        "`fibonacci` is made for exactly 2 continuous coordinates; the space has 3; use kronecker",
    );
    assert!(Fibonacci.build(&Request::new(&cubes[0], 5)).is_err());
    check(
        HaltonScrambled,
        Request::new(&cubes[2], 5),
        "`halton-scrambled` is made for at most 1000 continuous coordinates; the space has 1001; use sobol-owen",
    );
    check(
        Sobol,
        Request::new(&cubes[3], 5),
        "`sobol` is made for at most 21201 continuous coordinates; the space has 21202; use halton",
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
    assert_eq!("random".parse(), Ok(DiscreteFamily::Random { delta: 0.05 }));
    assert_eq!("ipog".parse(), Ok(DiscreteFamily::default()));
    let error = |name: &str| name.parse::<Strategy>().expect_err("an unknown name").to_string();
    assert_eq!(error("haltom"), "no strategy is called `haltom` (did you mean `halton`?)");
    assert_eq!(error("zzz"), "no strategy is called `zzz`");
    let family = "crss".parse::<DiscreteFamily>().expect_err("an unknown name").to_string();
    assert_eq!(family, "no discrete family is called `crss` (did you mean `cross`?); there are ipog, random and cross");
}

fn extended(space: &Space, existing: &[Point], n: usize) -> Vec<Point> {
    let more = tests(Strategy::Greedy, &Request { existing, ..Request::new(space, n) });
    [existing, &more].concat()
}

#[test]
fn greedy_tests_fill_the_holes_that_existing_ones_leave() {
    let space = Space::unit_cube(2);
    let left: Vec<Point> = tests(Strategy::Halton, &Request::new(&space, 200));
    let left: Vec<Point> = left.into_iter().filter(|test| test.continuous[0] < 0.5).collect();
    let volume = |tests: &[Point]| {
        let points = PointSet::new(2, tests.iter().map(|test| &test.continuous)).expect("points of the cube");
        dispersion(&points, Deadline::never()).volume.lower
    };
    assert!(volume(&left) > 0.5);
    assert!(volume(&extended(&space, &left, 100)) < 0.025);
}

#[test]
fn greedy_tests_of_a_mixed_space_first_cover_its_values_and_then_leave_no_hole_behind_any_two() {
    let space = mixed(3, &[3, 4, 2]);
    let kwise = |tests: &[Point]| {
        let found = kwise_dispersion(3, &Rules::free(&space.levels()), tests, 2, Deadline::never())
            .expect("two of six parameters");
        found.volume.lower
    };
    let greedy = tests(Strategy::Greedy, &Request::new(&space, 150));
    let discrete = greedy.iter().map(|test| &test.discrete[..]);
    assert_eq!(
        kwise_coverage(&Rules::free(&space.levels()), 2, discrete.clone().take(16)).expect("two of three").ratio(),
        1.0
    );
    let halton = tests(
        Strategy::Halton,
        &Request { discrete: DiscreteFamily::Cross, seed: Some(1), ..Request::new(&space, 150) },
    );
    assert!(kwise(&greedy) < 0.5 * kwise(&halton), "{} against {}", kwise(&greedy), kwise(&halton));
    // What is there counts, whoever made it.
    let gap: Vec<Point> = greedy.into_iter().filter(|test| test.discrete[0] != 1).collect();
    assert_eq!(kwise(&gap), 1.0);
    assert!(kwise(&extended(&space, &gap, 60)) < 0.15);
}

#[test]
fn greedy_can_aim_at_what_any_two_of_twenty_parameters_show() {
    let space = Space::unit_cube(20);
    let kwise = |strategy, aim| {
        let tests = tests(strategy, &Request { seed: Some(1), aim, ..Request::new(&space, 60) });
        kwise_dispersion(20, &Rules::free(&[]), &tests, 2, Deadline::never()).expect("two of twenty").volume.lower
    };
    let greedy = kwise(Strategy::Greedy, Some(Aim::KwiseDispersion));
    for strategy in [Strategy::Random, Strategy::HaltonShifted, Strategy::SobolOwen, Strategy::Lhs] {
        assert!(greedy < 0.7 * kwise(strategy, None), "{strategy}");
    }
}

#[test]
fn existing_tests_count_as_rows_where_nothing_is_continuous() {
    let space = mixed(0, &[2, 3]);
    let all = tests(Strategy::Random, &Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 9) });
    assert_eq!(all.len(), 6);
    let request = Request { discrete: DiscreteFamily::Cross, existing: &all[1..4], ..Request::new(&space, 9) };
    let more = tests(Strategy::Random, &request);
    assert_eq!(more, [all[0].clone(), all[4].clone(), all[5].clone()]);
}

#[test]
fn what_cannot_be_extended_or_aimed_is_refused_by_name() {
    let space = mixed(2, &[2]);
    let test = |x: f64, level| [Point { continuous: vec![x, 0.5], discrete: vec![level] }];
    let refused = |strategy, existing: &[Point], aim, k| {
        refusal(strategy, &Request { existing, aim, k, ..Request::new(&space, 5) }).to_string()
    };
    let cases = [
        (
            refused(Strategy::Sobol, &test(0.5, 1), None, None),
            "`sobol` does not look at existing tests and cannot extend them; use greedy",
        ),
        (refused(Strategy::Greedy, &test(1.5, 1), None, None), "existing test 0 is none of the space"),
        (refused(Strategy::Greedy, &test(0.5, 2), None, None), "existing test 0 is none of the space"),
        (refused(Strategy::Lhs, &[], Some(Aim::Dispersion), None), "`lhs` aims at no measure; greedy does"),
        (
            refused(Strategy::Cmaes, &test(0.5, 1), None, None),
            "`cmaes` does not look at existing tests and cannot extend them; use greedy",
        ),
        (
            refusal(Strategy::Bayes, &Request { epsilon: Some(0.1), ..Request::new(&space, 5) }).to_string(),
            "`bayes` goes where tests fail and leaves holes elsewhere; epsilon asks for none: use halton or greedy",
        ),
        (
            refused(Strategy::Greedy, &[], None, Some(4)),
            "k is 4, but the space has 3 parameters; k must be from 1 to their number",
        ),
        (
            "k-wise".parse::<Aim>().expect_err("no aim").to_string(),
            "greedy cannot aim at `k-wise`; it can at dispersion and k-wise-dispersion",
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
}
