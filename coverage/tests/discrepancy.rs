//! Star and extreme discrepancy against their definitions, evaluated by brute force that shares nothing with the
//! crate, and against what must hold of them whatever the time and the number of threads.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::extreme::extreme_discrepancy;
use paracosm_coverage::star::star_discrepancy;
use paracosm_coverage::{Bracket, Deadline, PointSet, l2};
use proptest::prelude::*;
use std::time::{Duration, Instant};

type Points = Vec<Vec<f64>>;

/// Points of which many tie, coincide and lie on faces.
fn points(dims: usize, most: usize) -> impl Strategy<Value = Points> {
    let grid = || (0..=4u8).prop_map(|i| f64::from(i) / 4.0);
    let anywhere = prop::collection::vec(prop::collection::vec(prop_oneof![0.0..=1.0f64, grid()], dims), 1..=most);
    let tied = prop::collection::vec(prop::collection::vec(grid(), dims), 1..=most);
    let twice = anywhere.prop_map(|points| points.iter().chain(&points).cloned().collect());
    let once = prop::collection::vec(prop::collection::vec(prop_oneof![0.0..=1.0f64, grid()], dims), 1..=most);
    prop_oneof![once, tied, twice]
}

/// Points of one to four dimensions, few enough for brute force.
fn few_points() -> impl Strategy<Value = (usize, Points)> {
    let of = |dims, most| points(dims, most).prop_map(move |points| (dims, points));
    prop_oneof![of(1, 12), of(2, 8), of(3, 4), of(4, 2)]
}

fn set(points: &Points) -> PointSet {
    PointSet::new(points[0].len(), points).unwrap()
}

fn exact(bracket: Bracket) -> f64 {
    assert!(bracket.is_exact(), "{bracket:?}");
    bracket.lower
}

/// The largest difference over all boxes whose corners have coordinates of points, or are ends of the cube.
fn by_definition(dims: usize, points: &Points, anchored: bool) -> f64 {
    let n = points.len() as f64;
    let mut largest = 0.0f64;
    let grids: Vec<Vec<f64>> = (0..dims)
        .map(|axis| {
            let mut grid: Vec<f64> = points.iter().map(|point| point[axis]).chain([0.0, 1.0]).collect();
            grid.sort_by(f64::total_cmp);
            grid.dedup();
            grid
        })
        .collect();
    let mut boxes: Vec<Vec<(f64, f64)>> = vec![vec![]];
    for grid in &grids {
        let mut longer = Vec::new();
        for sides in &boxes {
            for (i, a) in grid.iter().enumerate() {
                for b in &grid[i..] {
                    if !anchored || *a == 0.0 {
                        longer.push(sides.iter().copied().chain([(*a, *b)]).collect());
                    }
                }
            }
        }
        boxes = longer;
    }
    for sides in &boxes {
        let volume: f64 = sides.iter().map(|(a, b)| b - a).product();
        let count = |inside: &dyn Fn(f64, f64, f64) -> bool| {
            let holds = |point: &&Vec<f64>| sides.iter().zip(*point).all(|((a, b), x)| inside(*a, *x, *b));
            points.iter().filter(holds).count() as f64
        };
        let open = count(&|a, x, b| (a < x || anchored) && x < b);
        let closed = count(&|a, x, b| a <= x && x <= b);
        largest = largest.max(volume - open / n).max(closed / n - volume);
    }
    largest
}

/// Multiples of irrational numbers: evenly spread, so that many boxes are nearly the worst.
fn spread(dims: usize, n: u32) -> PointSet {
    let steps = [0.8566749, 0.7338918, 0.6287067, 0.5385973, 0.4614019, 0.3952706, 0.3386177, 0.2900846];
    let point = |i: u32| steps[..dims].iter().map(|step| (f64::from(i) * step).fract()).collect::<Vec<f64>>();
    PointSet::new(dims, (1..=n).map(point)).unwrap()
}

const MEASURES: [fn(&PointSet, Deadline) -> Bracket; 2] = [star_discrepancy, extreme_discrepancy];

fn in_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

proptest! {
    #[test]
    fn discrepancies_are_the_largest_differences_on_the_grid((dims, points) in few_points()) {
        let star = exact(star_discrepancy(&set(&points), Deadline::never()));
        prop_assert!((star - by_definition(dims, &points, true)).abs() <= 1e-14);
        let extreme = exact(extreme_discrepancy(&set(&points), Deadline::never()));
        prop_assert!((extreme - by_definition(dims, &points, false)).abs() <= 1e-14);
    }

    #[test]
    fn extreme_discrepancy_is_no_less_than_dispersion_and_star_discrepancy(points in points(3, 25)) {
        let set = set(&points);
        let extreme = exact(extreme_discrepancy(&set, Deadline::never()));
        prop_assert!(exact(dispersion(&set, Deadline::never()).volume) <= extreme + 1e-15);
        prop_assert!(exact(star_discrepancy(&set, Deadline::never())) <= extreme + 1e-15);
    }

    #[test]
    fn the_order_of_points_and_axes_and_their_direction_change_nothing(points in points(3, 20)) {
        let reversed: Points = points.iter().rev().cloned().collect();
        let turned: Points = points.iter().map(|point| vec![point[1], point[2], point[0]]).collect();
        let flipped: Points = points.iter().map(|point| vec![1.0 - point[0], point[1], point[2]]).collect();
        for measure in MEASURES {
            let of = |points: &Points| exact(measure(&set(points), Deadline::never()));
            prop_assert_eq!(of(&reversed), of(&points));
            prop_assert!((of(&turned) - of(&points)).abs() <= 1e-15);
        }
        let of = |points: &Points| exact(extreme_discrepancy(&set(points), Deadline::never()));
        prop_assert!((of(&flipped) - of(&points)).abs() <= 1e-15);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn brackets_of_an_interrupted_search_hold_the_exact_value(points in points(4, 60)) {
        let set = set(&points);
        for measure in MEASURES {
            let exact = exact(measure(&set, Deadline::never()));
            for limit in [Duration::ZERO, Duration::from_millis(1), Duration::from_millis(20)] {
                let early = measure(&set, Deadline::after(limit));
                prop_assert!(early.lower <= exact && exact <= early.upper, "{:?} {}", early, exact);
                prop_assert!(early.upper <= 1.0);
            }
        }
    }

    #[test]
    fn one_thread_and_two_say_the_same(points in points(4, 60)) {
        let set = set(&points);
        for measure in MEASURES {
            let of = |threads| in_threads(threads, || measure(&set, Deadline::never()));
            prop_assert_eq!(of(1), of(2));
        }
        for measure in [l2::centered, l2::wraparound, l2::mixture, l2::l2_star] {
            let of = |threads| in_threads(threads, || measure(&set, Deadline::never()));
            prop_assert_eq!(of(1), of(2));
        }
    }
}

#[test]
fn one_thread_and_two_say_the_same_of_many_points() {
    let (star, extreme, many) = (spread(5, 150), spread(2, 200), spread(6, 1000));
    let of = |threads| {
        in_threads(threads, || {
            let never = Deadline::never();
            (star_discrepancy(&star, never), extreme_discrepancy(&extreme, never), l2::mixture(&many, never))
        })
    };
    assert_eq!(of(1), of(2));
}

#[test]
fn extreme_discrepancy_is_that_of_the_reference() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/point_sets.json");
    let file: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut compared = 0;
    for set in file["sets"].as_array().unwrap() {
        let Some(expected) = set["extreme"].as_f64() else { continue };
        let points: Points = serde_json::from_value(set["points"].clone()).unwrap();
        let found = exact(extreme_discrepancy(&self::set(&points), Deadline::never()));
        assert!((found - expected).abs() <= 1e-12, "{}: found {found}, expected {expected}", set["name"]);
        compared += 1;
    }
    assert!(compared >= 15, "{compared}");
}

#[test]
fn small_sets_have_the_extreme_discrepancy_one_computes_by_hand() {
    let nothing = PointSet::new::<[f64; 3]>(3, []).unwrap();
    assert_eq!(extreme_discrepancy(&nothing, Deadline::never()), Bracket::exact(1.0));
    assert_eq!(extreme_discrepancy(&nothing, Deadline::after(Duration::ZERO)), Bracket::exact(1.0));
    // The point alone, in a box of no volume.
    assert_eq!(extreme_discrepancy(&set(&vec![vec![0.25, 0.6]]), Deadline::never()), Bracket::exact(1.0));
    // Between the points of a regular row there is nothing, on a point there is one of ten.
    let row: Points = (0..10).map(|i| vec![(f64::from(i) + 0.5) / 10.0]).collect();
    assert!((exact(extreme_discrepancy(&set(&row), Deadline::never())) - 0.1).abs() <= 1e-15);
    assert!((exact(star_discrepancy(&set(&row), Deadline::never())) - 0.05).abs() <= 1e-15);
}

#[test]
fn a_search_that_may_take_long_returns_a_bracket_in_time() {
    let set = spread(8, 2000);
    for measure in MEASURES {
        let begun = Instant::now();
        let bracket = measure(&set, Deadline::after(Duration::from_secs(1)));
        // Generous: the machine may be busy with other tests.
        assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
        assert!(0.0 < bracket.lower && bracket.lower <= bracket.upper && bracket.upper <= 1.0, "{bracket:?}");
    }
}

#[test]
fn the_l2_family_is_what_its_kernels_say_pair_by_pair() {
    // More points than fit in one task, and not a multiple of anything.
    let set = spread(3, 211);
    let n = set.len() as f64;
    let sum = |kernel: &dyn Fn(f64, f64) -> f64| {
        let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| kernel(*x, *y)).product::<f64>();
        set.iter().map(|x| set.iter().map(|y| product(x, y)).sum::<f64>()).sum::<f64>() / (n * n)
    };
    let apart = |x: f64, y: f64| (x - y).abs();
    let wraparound = sum(&|x, y| 1.5 - apart(x, y) * (1.0 - apart(x, y))) - (4.0f64 / 3.0) * (4.0 / 3.0) * (4.0 / 3.0);
    assert!((l2::wraparound(&set, Deadline::never()).unwrap() - wraparound).abs() <= 1e-13);
    assert_eq!(l2::wraparound(&spread(8, 4000), Deadline::after(Duration::ZERO)), None);
}
