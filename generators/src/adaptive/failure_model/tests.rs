//! What the model tells of functions made up for the purpose, and how surely.

use super::*;
use crate::{Request, Strategy};

fn tests(space: &Space, n: usize) -> Vec<Point> {
    Strategy::HALTON.build(&Request::new(space, n)).unwrap().ask(n)
}

/// How much of 2,000 other tests the model tells right.
fn right(space: &Space, n: usize, robustness: impl Fn(&Point) -> f64) -> f64 {
    let known = tests(space, n);
    let told: Vec<f64> = known.iter().map(&robustness).collect();
    let model = FailureModel::fit(space, &known, &told).unwrap();
    let others = Strategy::RANDOM.build(&Request::new(space, 2000)).unwrap().ask(2000);
    let probabilities = model.probabilities(&others);
    let right = others.iter().zip(probabilities).filter(|(at, p)| (*p > 0.5) == (robustness(at) < 0.0)).count();
    right as f64 / 2000.0
}

fn ball(at: &Point) -> f64 {
    let square = |u: &f64| (u - 0.45) * (u - 0.45);
    at.continuous.iter().map(square).sum::<f64>().sqrt() - 0.3
}

#[test]
fn a_ball_is_known_after_few_tests_by_a_robustness_that_is_its_distance() {
    assert!(right(&Space::unit_cube(3), 60, ball) > 0.98);
}

#[test]
fn where_the_robustness_jumps_it_knows_more_than_the_nearest_test() {
    let jumping = |at: &Point| if ball(at) < 0.0 { -9.0 + 5.0 * at.continuous[0] } else { ball(at).min(0.1) };
    let space = Space::unit_cube(2);
    let known = tests(&space, 150);
    let square =
        |a: &Point, b: &Point| -> f64 { a.continuous.iter().zip(&b.continuous).map(|(a, b)| (a - b) * (a - b)).sum() };
    let others = Strategy::RANDOM.build(&Request::new(&space, 2000)).unwrap().ask(2000);
    let nearest = |at: &Point| known.iter().min_by(|a, b| square(a, at).total_cmp(&square(b, at))).unwrap();
    let told = others.iter().filter(|at| (jumping(nearest(at)) < 0.0) == (jumping(at) < 0.0)).count();
    let (nearest, model) = (told as f64 / 2000.0, right(&space, 150, jumping));
    assert!(model > nearest, "{model} {nearest}");
}

#[test]
fn of_many_tests_it_sees_those_that_tell_most() {
    assert!(right(&Space::unit_cube(2), 3000, |at| if ball(at) < 0.0 { -5.0 } else { 1.0 }) > 0.985);
}

#[test]
fn words_are_told_apart() {
    let text = "parameter = [{ name = \"x\", interval = [0, 1] }, { name = \"sky\", choice = [\"day\", \"dusk\", \"night\"] }]";
    let space = Space::from_toml(text).unwrap();
    assert!(right(&space, 90, |at| if at.discrete[0] == 2 { at.continuous[0] - 0.5 } else { 1.0 }) > 0.95);
}

#[test]
fn the_share_of_tests_that_fail_is_known_as_well_as_they_are() {
    let space = Space::unit_cube(2);
    let known = tests(&space, 100);
    let fails = |at: &Point| 0.6 - at.continuous[0];
    let model = FailureModel::fit(&space, &known, &known.iter().map(fails).collect::<Vec<_>>()).unwrap();
    let at = |x: f64, y: f64| Point { continuous: vec![x, y], discrete: Vec::new() };
    let group = |x: [f64; 4]| x.map(|x| (at(x, 0.5), 1.0)).to_vec();
    let found = model.shares(&[group([0.1, 0.2, 0.3, 0.4]), group([0.2, 0.3, 0.4, 0.9]), group([0.9; 4])], 1);
    // As sure as a hundred tests can be.
    let (never, always) = (1.0 / 102.0, 101.0 / 102.0);
    let expected = [(0.0, never), (0.25, never), (1.0, always)];
    for (found, (mean, above)) in found.iter().zip(expected) {
        assert!((found.mean - mean).abs() < 0.02 && found.deviation < 0.05 && found.above_half == above, "{found:?}");
    }
    // Between tests of which no more than the verdict is known nothing is sure; the mean is that of the probabilities.
    let verdicts: Vec<f64> = known.iter().map(|at| 1.0_f64.copysign(fails(at))).collect();
    let model = FailureModel::fit(&space, &known[..30], &verdicts[..30]).unwrap();
    let (mut last, mut first) = (0.0_f64, 1.0_f64);
    for test in &known[..30] {
        let x = test.continuous[0];
        if fails(test) < 0.0 { first = first.min(x) } else { last = last.max(x) }
    }
    let edge = [at(0.5 * (last + first), 0.5), at(0.5 * (last + first) + 1e-4, 0.5)];
    let unsure = model.shares(&[edge.clone().map(|test| (test, 1.0)).to_vec()], 1)[0];
    assert!(unsure.deviation > 0.1 && (0.05..0.95).contains(&unsure.above_half), "{unsure:?}");
    let mean = model.probabilities(&edge).iter().sum::<f64>() / 2.0;
    assert!((unsure.mean - mean).abs() < 1e-12);
}

#[test]
fn the_error_of_taking_samples_is_in_the_deviation_and_weights_count() {
    let space = Space::unit_cube(2);
    let known = tests(&space, 100);
    let fails = |at: &Point| 0.6 - at.continuous[0];
    let model = FailureModel::fit(&space, &known, &known.iter().map(fails).collect::<Vec<_>>()).unwrap();
    let group = |tests: [(f64, f64); 4]| {
        vec![tests.map(|(x, weight)| (Point { continuous: vec![x, 0.5], discrete: Vec::new() }, weight)).to_vec()]
    };
    // Two samples, one of which fails whole: the share is one half, give or take one half.
    let apart = model.shares(&group([(0.1, 1.0), (0.2, 1.0), (0.8, 1.0), (0.9, 1.0)]), 2)[0];
    assert!((apart.mean - 0.5).abs() < 0.02 && (apart.deviation - 0.5).abs() < 0.02, "{apart:?}");
    let alike = model.shares(&group([(0.1, 1.0), (0.9, 1.0), (0.2, 1.0), (0.8, 1.0)]), 2)[0];
    assert!((alike.mean - 0.5).abs() < 0.02 && alike.deviation < 0.05, "{alike:?}");
    let weighed = model.shares(&group([(0.1, 1.0), (0.9, 3.0), (0.2, 1.0), (0.8, 0.0)]), 1)[0];
    assert!((weighed.mean - 0.6).abs() < 0.02, "{weighed:?}");
}

/// Of places along two of some parameters, where tests pass on one side of a random plane: the share that is decided
/// after so many tests, and the share of it that is right.
fn decided(dimensions: usize, n: usize, planes: u64) -> (f64, f64) {
    let (mut decided, mut right, mut places) = (0, 0, 0);
    for plane in 0..planes {
        let mut rng = seeded(plane, Purpose::Points, 77);
        let slopes: Vec<f64> = (0..dimensions).map(|_| normal(&mut rng)).collect();
        let space = Space::unit_cube(dimensions);
        let worth = |at: &Point| {
            let side: f64 = at.continuous.iter().zip(&slopes).map(|(u, slope)| slope * (u - 0.5)).sum();
            side + 0.1
        };
        let known = Strategy::RANDOM.build(&Request { seed: Some(plane), ..Request::new(&space, n) }).unwrap().ask(n);
        let told: Vec<f64> = known.iter().map(worth).collect();
        let failing = told.iter().filter(|told| **told < 0.0).count();
        if failing == 0 || failing == n {
            continue;
        }
        let model = FailureModel::fit(&space, &known, &told).unwrap();
        let others = Request { seed: Some(plane + 1000), ..Request::new(&space, 128) };
        let others = Strategy::RANDOM.build(&others).unwrap().ask(128);
        let at = |x: f64, y: f64| -> Vec<(Point, f64)> {
            let place = |mut other: Point| {
                (other.continuous[0], other.continuous[1]) = (x, y);
                (other, 1.0)
            };
            others.iter().cloned().map(place).collect()
        };
        let groups: Vec<_> = (0..25).map(|i| at(f64::from(i % 5) / 4.01, f64::from(i / 5) / 4.01)).collect();
        for (group, share) in groups.iter().zip(model.shares(&groups, 8)) {
            let fails = group.iter().filter(|(test, _)| worth(test) < 0.0).count() > 64;
            places += 1;
            if share.above_half >= 0.95 || share.above_half <= 0.05 {
                decided += 1;
                right += usize::from(fails == (share.above_half > 0.5));
            }
        }
    }
    (f64::from(decided) / f64::from(places), right as f64 / f64::from(decided.max(1)))
}

#[test]
fn a_few_tests_decide_nothing_and_what_more_tests_decide_is_right() {
    for (dimensions, n) in [(10, 5), (10, 10), (2, 4)] {
        assert_eq!(decided(dimensions, n, 10).0, 0.0, "{dimensions} axes, {n} tests");
    }
    for (dimensions, n, least) in [(3, 20, 0.7), (10, 50, 0.4)] {
        let (share, right) = decided(dimensions, n, 20);
        assert!(share > least && right > 0.97, "{dimensions} axes, {n} tests: {share}, {right} of it right");
    }
}

#[test]
fn where_little_can_be_told_as_many_are_said_to_fail_as_do() {
    // Of tests in six parameters one in eight fails, and hardly any parameter says which. The model sees 400 of them,
    // but all that fail.
    let space = Space::unit_cube(6);
    let known = tests(&space, 600);
    let told: Vec<f64> =
        (0..600_u64).map(|i| if crate::seeded::mix(i).is_multiple_of(8) { -3.0 } else { 1.0 }).collect();
    let counted = told.iter().filter(|told| **told < 0.0).count() as f64 / 600.0;
    let model = FailureModel::fit(&space, &known, &told).unwrap();
    let others = Strategy::RANDOM.build(&Request::new(&space, 2000)).unwrap().ask(2000);
    let mean = model.probabilities(&others).iter().sum::<f64>() / 2000.0;
    assert!((mean - counted).abs() < 0.02, "{mean}, counted {counted}");
}

#[test]
fn whatever_it_is_told_there_are_probabilities_or_no_model() {
    let space = Space::unit_cube(2);
    let known = tests(&space, 12);
    for told in [f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e-300, 1e300, f64::NAN] {
        let mixed: Vec<f64> = (0..12).map(|i| if i % 3 == 0 { -1.0 } else { told }).collect();
        for told in [vec![told; 12], mixed] {
            let Some(model) = FailureModel::fit(&space, &known, &told) else {
                assert!(told.iter().all(|told| told.is_nan()));
                continue;
            };
            assert!(model.probabilities(&known).iter().all(|p| (0.0..=1.0).contains(p)), "{told:?}");
        }
    }
    assert!(FailureModel::fit(&space, &known[..1], &[1.0]).is_none());
    let doubled: Vec<Point> = known.iter().chain(&known).cloned().collect();
    let told: Vec<f64> = (0..24).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
    assert!(FailureModel::fit(&space, &doubled, &told).is_some());
}
