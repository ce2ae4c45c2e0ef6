//! The largest empty interval and rectangle, against all rectangles there are: on points that tie, that coincide, and
//! on curves along which a great many rectangles are nearly as large as the largest.

use paracosm_coverage::dispersion::{Dispersion, dispersion, is_at_most};
use paracosm_coverage::{Deadline, PointSet};
use proptest::prelude::*;
use std::time::Duration;

type Points = Vec<[f64; 2]>;

fn set(points: &Points) -> PointSet {
    PointSet::new(2, points).unwrap()
}

/// The largest area between any two columns, computed as areas are.
fn largest_by_brute_force(points: &Points) -> f64 {
    let mut columns: Vec<f64> = points.iter().map(|point| point[0]).chain([0.0, 1.0]).collect();
    columns.sort_by(f64::total_cmp);
    let mut upward = points.clone();
    upward.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let mut largest = 0.0f64;
    for (i, left) in columns.iter().enumerate() {
        for right in &columns[i..] {
            let mut bottom = 0.0;
            let between = upward.iter().filter(|[x, _]| left < x && x < right).map(|point| point[1]);
            for top in between.chain([1.0]) {
                largest = largest.max((right - left) * (top - bottom));
                bottom = top;
            }
        }
    }
    largest
}

fn holds_none(found: &Dispersion, points: &Points) -> bool {
    let inside = |point: &[f64; 2]| {
        let sides = found.witness.lower.iter().zip(&found.witness.upper).zip(point);
        sides.into_iter().all(|((lower, upper), x)| lower < x && x < upper)
    };
    !points.iter().any(inside)
}

/// Points of one kind in a random order, with copies and rounded ones among them.
fn points() -> impl Strategy<Value = Points> {
    let shares = prop::collection::vec((0.0..=1.0f64, 0.0..=1.0f64), 0..48);
    let step = prop_oneof![Just(None), (1..12u8).prop_map(Some)];
    (0..7u8, shares, step).prop_map(|(kind, shares, step)| {
        let round = |x: f64| step.map_or(x, |step| (x * f64::from(step)).round() / f64::from(step));
        let place = |(index, (u, v)): (usize, (f64, f64))| match kind {
            0 => [u, v],
            1 => [0.5 + 0.49 * libm::cos(7.0 * u), 0.5 + 0.49 * libm::sin(7.0 * u)],
            // One hyperbola, and two that face each other, at a distance and close by.
            2 => [0.1 + 0.9 * u, 0.1 / (0.1 + 0.9 * u)],
            3 if index % 2 == 0 => [0.1 + 0.4 * u, 0.05 / (0.1 + 0.4 * u)],
            3 => [0.9 - 0.4 * u, 1.0 - 0.05 / (0.1 + 0.4 * u)],
            4 => [0.5 + 1e-9 * u, 0.25 / (0.5 + 1e-9 * u)],
            // Two lines that go down, for which each gives one side and one end.
            5 if index % 2 == 0 => [0.5 * u, 0.5 - 0.5 * u],
            5 => [0.5 + 0.5 * u, 1.0 - 0.5 * u],
            _ => [u, if index % 2 == 0 { u } else { 1.0 - u }],
        };
        shares.into_iter().enumerate().map(place).map(|point| point.map(|x| round(x).clamp(0.0, 1.0))).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn no_rectangle_is_larger_to_the_last_bit(points in points()) {
        let found = dispersion(&set(&points), Deadline::never());
        prop_assert!(found.volume.is_exact());
        prop_assert_eq!(found.volume.lower, largest_by_brute_force(&points));
        prop_assert_eq!(found.volume.lower, found.witness.volume());
        prop_assert!(holds_none(&found, &points));
    }

    #[test]
    fn whether_all_are_at_most_so_large_is_known_to_the_last_bit(points in points()) {
        let largest = largest_by_brute_force(&points);
        let at_most = |area| is_at_most(&set(&points), area, Deadline::never());
        prop_assert_eq!(at_most(largest), Some(true));
        prop_assert_eq!(at_most(largest.next_down()), Some(false));
    }
}

fn circle(n: usize) -> Points {
    (0..n).map(|i| i as f64).map(|i| [0.5 + 0.49 * libm::cos(i), 0.5 + 0.49 * libm::sin(i)]).collect()
}

/// The points of a square grid, where all rectangles between neighbouring lines are alike.
fn square_grid(side: usize) -> Points {
    let at = |i: usize| (i as f64 + 0.5) / side as f64;
    (0..side * side).map(|i| [at(i % side), at(i / side)]).collect()
}

#[test]
fn threads_change_nothing_where_many_rectangles_are_as_large() {
    for points in [circle(20_000), square_grid(120), vec![[0.25, 0.75]; 5_000]] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| dispersion(&set(&points), Deadline::never()))
        };
        let one = on(1);
        assert!(one.volume.is_exact() && holds_none(&one, &points));
        for threads in [2, 3, 8] {
            assert_eq!(one, on(threads), "{threads} threads");
        }
    }
}

#[test]
fn a_limit_leaves_a_bracket_around_the_largest_rectangle() {
    // The sequence of multiples of the golden ratio, which leaves no large holes.
    let points: Points =
        (0..50_000).map(|i| [(f64::from(i) + 0.5) / 5e4, f64::from(i) * 0.618_033_988_749_895 % 1.0]).collect();
    let exact = dispersion(&set(&points), Deadline::never()).volume.lower;
    for microseconds in [0, 10, 1_000, 5_000, 20_000] {
        let found = dispersion(&set(&points), Deadline::after(Duration::from_micros(microseconds)));
        assert!(found.volume.lower <= exact && exact <= found.volume.upper, "{:?}", found.volume);
        assert!(found.volume.lower == found.witness.volume() && holds_none(&found, &points));
    }
    let at_once = dispersion(&set(&points), Deadline::after(Duration::ZERO));
    assert!(!at_once.volume.is_exact());
    assert_eq!(is_at_most(&set(&points), exact, Deadline::after(Duration::ZERO)), None);
}

#[test]
fn the_longest_interval_is_exact_in_no_time() {
    let points = PointSet::new(1, [[0.75], [0.125], [0.5], [0.5]]).unwrap();
    let found = dispersion(&points, Deadline::after(Duration::ZERO));
    assert!(found.volume.is_exact());
    assert_eq!(
        (found.volume.lower, &found.witness.lower[..], &found.witness.upper[..]),
        (0.375, &[0.125][..], &[0.5][..])
    );
    assert_eq!(is_at_most(&points, 0.375, Deadline::after(Duration::ZERO)), Some(true));
    assert_eq!(is_at_most(&points, 0.374, Deadline::after(Duration::ZERO)), Some(false));
}
