//! K-wise dispersion against its definition, written out.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::kwise_dispersion::kwise_dispersion;
use paracosm_coverage::{Bracket, Deadline, PointSet};
use paracosm_space::Point;
use paracosm_space::rules::Rules;
use proptest::prelude::*;

/// The largest dispersion over the projections on two of the parameters, discrete ones after continuous ones.
fn pairwise(dims: usize, levels: &[usize], tests: &[Point]) -> f64 {
    let of = |axes: &[usize], has: &dyn Fn(&Point) -> bool| {
        let points = tests.iter().filter(|test| has(test));
        let points = points.map(|test| axes.iter().map(|&axis| test.continuous[axis]).collect::<Vec<_>>());
        dispersion(&PointSet::new(axes.len(), points).unwrap(), Deadline::never()).volume.lower
    };
    let mut largest = 0.0f64;
    for a in 0..dims {
        for b in 0..a {
            largest = largest.max(of(&[b, a], &|_| true));
        }
        for (p, &levels) in levels.iter().enumerate() {
            for level in 0..levels {
                largest = largest.max(of(&[a], &|test| test.discrete[p] == level));
            }
        }
    }
    for p in 0..levels.len() {
        for q in 0..p {
            for (x, y) in (0..levels[p]).flat_map(|x| (0..levels[q]).map(move |y| (x, y))) {
                let covered = tests.iter().any(|test| test.discrete[p] == x && test.discrete[q] == y);
                largest = largest.max(if covered { 0.0 } else { 1.0 });
            }
        }
    }
    largest
}

fn tests(dims: usize, levels: Vec<usize>) -> impl Strategy<Value = Vec<Point>> {
    let continuous = prop::collection::vec((0..=20u32).prop_map(|x| f64::from(x) / 20.0), dims);
    let discrete: Vec<_> = levels.iter().map(|&levels| 0..levels).collect();
    prop::collection::vec(
        (continuous, discrete).prop_map(|(continuous, discrete)| Point { continuous, discrete }),
        0..40,
    )
}

proptest! {
    #[test]
    fn it_is_the_largest_over_all_pairs_of_parameters(tests in tests(3, vec![2, 3])) {
        let found = kwise_dispersion(3, &Rules::free(&[2, 3]), None, &tests, 2, Deadline::never()).unwrap();
        prop_assert!(found.volume.is_exact());
        prop_assert_eq!(found.volume.lower, pairwise(3, &[2, 3], &tests));
    }

    #[test]
    fn with_all_parameters_it_is_the_dispersion(tests in tests(3, vec![])) {
        let points = PointSet::new(3, tests.iter().map(|test| &test.continuous)).unwrap();
        let found = kwise_dispersion(3, &Rules::free(&[]), None, &tests, 3, Deadline::never()).unwrap();
        prop_assert_eq!(found.volume, dispersion(&points, Deadline::never()).volume);
    }
}

#[test]
fn without_time_the_bracket_is_honest() {
    let tests = vec![Point { continuous: vec![0.5; 6], discrete: vec![] }];
    let found =
        kwise_dispersion(6, &Rules::free(&[]), None, &tests, 2, Deadline::after(std::time::Duration::ZERO)).unwrap();
    assert_eq!(found.volume, Bracket { lower: 0.0, upper: 1.0 });
}

#[test]
fn a_hole_names_the_parameters_it_is_in() {
    let test = |x: f64, level| Point { continuous: vec![0.5, x], discrete: vec![level] };
    let tests: Vec<Point> = (0..10).map(|i| test(f64::from(i) / 10.0, usize::from(i < 9))).collect();
    let found = kwise_dispersion(2, &Rules::free(&[2]), None, &tests, 2, Deadline::never()).unwrap();
    // Level 0 has one test at (0.5, 0.9).
    assert_eq!((found.fixed, found.axes), (vec![(0, 0)], vec![1]));
    assert_eq!(found.volume, Bracket::exact(0.9));
    assert!(kwise_dispersion(2, &Rules::free(&[2]), None, &tests, 4, Deadline::never()).is_err());
}
