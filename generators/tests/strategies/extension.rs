//! Tests that complete others, and what greedy ones can be aimed at.

use super::*;

fn extended(space: &Space, existing: &[Point], n: usize) -> Vec<Point> {
    let more = tests(Strategy::GREEDY, &Request { existing, ..Request::new(space, n) });
    [existing, &more].concat()
}

#[test]
fn greedy_tests_fill_the_holes_that_existing_ones_leave() {
    let space = Space::unit_cube(2);
    let left: Vec<Point> = tests(Strategy::HALTON, &Request::new(&space, 200));
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
        let found = kwise_dispersion(3, &Rules::free(&space.levels()), None, tests, 2, Deadline::never())
            .expect("two of six parameters");
        found.volume.lower
    };
    let greedy = tests(Strategy::GREEDY, &Request::new(&space, 150));
    let discrete = greedy.iter().map(|test| &test.discrete[..]);
    assert_eq!(
        kwise_coverage(&Rules::free(&space.levels()), 2, discrete.clone().take(16)).expect("two of three").ratio(),
        1.0
    );
    let halton = tests(
        Strategy::HALTON,
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
        kwise_dispersion(20, &Rules::free(&[]), None, &tests, 2, Deadline::never()).expect("two of twenty").volume.lower
    };
    let greedy = kwise(Strategy::GREEDY, Some(Aim::KwiseDispersion));
    for strategy in [Strategy::RANDOM, Strategy::HALTON, Strategy::SOBOL_OWEN, Strategy::LHS] {
        assert!(greedy < 0.7 * kwise(strategy, None), "{strategy}");
    }
}

#[test]
fn existing_tests_count_as_rows_where_nothing_is_continuous() {
    let space = mixed(0, &[2, 3]);
    let all = tests(Strategy::RANDOM, &Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 9) });
    assert_eq!(all.len(), 6);
    let request = Request { discrete: DiscreteFamily::Cross, existing: &all[1..4], ..Request::new(&space, 9) };
    let more = tests(Strategy::RANDOM, &request);
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
            refused(Strategy::SOBOL, &test(0.5, 1), None, None),
            "`sobol` does not look at existing tests and cannot extend them; use greedy",
        ),
        (
            refused(Strategy::GREEDY, &test(1.5, 1), None, None),
            "existing test 0 does not belong to the space; give each parameter of the space a valid value",
        ),
        (
            refused(Strategy::GREEDY, &test(0.5, 2), None, None),
            "existing test 0 does not belong to the space; give each parameter of the space a valid value",
        ),
        (
            refused(Strategy::LHS, &[], Some(Aim::Dispersion), None),
            "`lhs` cannot aim at a measure; use greedy, or give no measure to aim at",
        ),
        (
            refused(Strategy::CMAES, &test(0.5, 1), None, None),
            "`cmaes` does not look at existing tests and cannot extend them; use greedy",
        ),
        (
            refusal(Strategy::BAYES, &Request { epsilon: Some(0.1), ..Request::new(&space, 5) }).to_string(),
            "`bayes` goes where tests fail and leaves holes elsewhere; epsilon forbids holes: use halton or greedy",
        ),
        (
            refused(Strategy::GREEDY, &[], None, Some(4)),
            "k is 4, but the space has 3 parameters; expected k from 1 to that number",
        ),
        (
            "k-wise".parse::<Aim>().expect_err("no aim").to_string(),
            "greedy cannot aim at `k-wise`; it can aim at dispersion and k-wise-dispersion",
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
}
