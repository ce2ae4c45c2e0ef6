//! The measures against their definitions, evaluated by brute force that shares nothing with the crate, and
//! against what must hold of any set of points.

use paracosm_coverage::dispersion::{LargestEmptyBox, dispersion};
use paracosm_coverage::star::star_discrepancy;
use paracosm_coverage::{Bracket, Deadline, PointSet, l2};
use proptest::prelude::*;
use std::time::Duration;

type Points = Vec<Vec<f64>>;

/// Coordinates, half of the time from a small grid, so that points tie, coincide and lie on faces.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![0.0..=1.0f64, (0..=4u8).prop_map(|i| f64::from(i) / 4.0)]
}

fn points(dims: usize, most: usize) -> impl Strategy<Value = Points> {
    let anywhere = prop::collection::vec(prop::collection::vec(coordinate(), dims), 0..=most);
    let grid = (0..=4u8).prop_map(|i| f64::from(i) / 4.0);
    let tied = prop::collection::vec(prop::collection::vec(grid, dims), 0..=most);
    prop_oneof![anywhere, tied]
}

/// Points of one to three dimensions, few enough for brute force.
fn few_points() -> impl Strategy<Value = (usize, Points)> {
    let of = |dims, most| points(dims, most).prop_map(move |points| (dims, points));
    prop_oneof![of(1, 12), of(2, 8), of(3, 5)]
}

fn set(dims: usize, points: &Points) -> PointSet {
    PointSet::new(dims, points).unwrap()
}

/// The value, which has to be exact.
fn exact(bracket: Bracket) -> f64 {
    assert!(bracket.is_exact(), "{bracket:?}");
    bracket.lower
}

fn dispersion_of(dims: usize, points: &Points) -> f64 {
    exact(dispersion(&set(dims, points), Deadline::never()).volume)
}

fn star_of(dims: usize, points: &Points) -> f64 {
    exact(star_discrepancy(&set(dims, points), Deadline::never()))
}

/// All ways to take one element of each list.
fn product<T: Clone>(lists: &[Vec<T>]) -> Vec<Vec<T>> {
    lists.iter().fold(vec![vec![]], |heads, list| {
        let extend = |head: &Vec<T>| {
            list.iter().map(|item| [head.as_slice(), std::slice::from_ref(item)].concat()).collect::<Vec<_>>()
        };
        heads.iter().flat_map(extend).collect()
    })
}

/// The distinct coordinates along an axis, and `more`, in order.
fn grid(points: &Points, axis: usize, more: &[f64]) -> Vec<f64> {
    let mut grid: Vec<f64> = points.iter().map(|point| point[axis]).chain(more.iter().copied()).collect();
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

fn dispersion_by_definition(dims: usize, points: &Points) -> f64 {
    let intervals = |axis| {
        let grid = grid(points, axis, &[0.0, 1.0]);
        let pairs = (0..grid.len()).flat_map(|i| (i + 1..grid.len()).map(move |j| (i, j)));
        pairs.map(|(i, j)| (grid[i], grid[j])).collect::<Vec<_>>()
    };
    let boxes = product(&(0..dims).map(intervals).collect::<Vec<_>>());
    let holds = |sides: &[(f64, f64)], point: &[f64]| sides.iter().zip(point).all(|((a, b), x)| a < x && x < b);
    let empty = boxes.iter().filter(|sides| !points.iter().any(|point| holds(sides, point)));
    empty.map(|sides| sides.iter().map(|(a, b)| b - a).product::<f64>()).fold(0.0, f64::max)
}

fn star_by_definition(dims: usize, points: &Points) -> f64 {
    let n = points.len() as f64;
    let corners = product(&(0..dims).map(|axis| grid(points, axis, &[1.0])).collect::<Vec<_>>());
    let difference = |corner: &Vec<f64>| {
        let volume: f64 = corner.iter().product();
        let share = |inside: fn(&f64, &f64) -> bool| {
            points.iter().filter(|point| point.iter().zip(corner).all(|(x, y)| inside(x, y))).count() as f64 / n
        };
        (volume - share(|x, y| x < y)).max(share(|x, y| x <= y) - volume)
    };
    corners.iter().map(difference).fold(0.0, f64::max)
}

/// In two dimensions: for every strip between two heights, the widest gap of the points in it.
fn dispersion_by_strips(points: &Points) -> f64 {
    let heights = grid(points, 1, &[0.0, 1.0]);
    let mut by_x = points.clone();
    by_x.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut largest = 0.0f64;
    for (i, bottom) in heights.iter().enumerate() {
        for top in &heights[i + 1..] {
            let (mut left, mut widest) = (0.0, 0.0f64);
            for point in by_x.iter().filter(|point| *bottom < point[1] && point[1] < *top) {
                widest = widest.max(point[0] - left);
                left = point[0];
            }
            largest = largest.max(widest.max(1.0 - left) * (top - bottom));
        }
    }
    largest
}

fn is_empty(LargestEmptyBox { lower, upper }: &LargestEmptyBox, points: &Points) -> bool {
    let inside = |point: &Vec<f64>| (0..point.len()).all(|i| lower[i] < point[i] && point[i] < upper[i]);
    !points.iter().any(inside)
}

proptest! {
    #[test]
    fn dispersion_is_the_largest_empty_box_among_all_boxes((dims, points) in few_points()) {
        prop_assert_eq!(dispersion_of(dims, &points), dispersion_by_definition(dims, &points));
    }

    #[test]
    fn star_discrepancy_is_the_largest_difference_on_the_grid((dims, points) in few_points()) {
        let expected = if points.is_empty() { 1.0 } else { star_by_definition(dims, &points) };
        prop_assert!((star_of(dims, &points) - expected).abs() <= 1e-14);
    }

    #[test]
    fn the_witness_is_empty_lies_in_the_cube_and_has_the_volume(points in points(4, 40)) {
        let dispersion = dispersion(&set(4, &points), Deadline::never());
        prop_assert!(is_empty(&dispersion.witness, &points));
        let ends = dispersion.witness.lower.iter().zip(&dispersion.witness.upper);
        prop_assert!(ends.clone().all(|(lower, upper)| 0.0 <= *lower && lower < upper && *upper <= 1.0));
        prop_assert_eq!(exact(dispersion.volume), ends.map(|(lower, upper)| upper - lower).product::<f64>());
    }

    #[test]
    fn another_point_never_raises_dispersion(points in points(3, 30), more in prop::collection::vec(coordinate(), 3)) {
        let with = [points.as_slice(), &[more]].concat();
        prop_assert!(dispersion_of(3, &with) <= dispersion_of(3, &points));
    }

    #[test]
    fn the_order_of_points_and_axes_changes_nothing(points in points(3, 30)) {
        let reversed: Points = points.iter().rev().cloned().collect();
        let turned: Points = points.iter().map(|point| vec![point[1], point[2], point[0]]).collect();
        for other in [&reversed, &turned] {
            prop_assert!((dispersion_of(3, other) - dispersion_of(3, &points)).abs() <= 1e-15);
            prop_assert!((star_of(3, other) - star_of(3, &points)).abs() <= 1e-15);
            for measure in [l2::centered, l2::wraparound, l2::mixture, l2::l2_star] {
                let difference = measure(&set(3, other), Deadline::never()).zip(measure(&set(3, &points), Deadline::never())).map_or(0.0, |(a, b)| a - b);
                prop_assert!(difference.abs() <= 1e-7, "{}", difference);
            }
        }
    }

    #[test]
    fn l2_star_is_the_root_mean_square_over_anchored_boxes(points in points(2, 10)) {
        prop_assume!(!points.is_empty());
        let n = points.len() as f64;
        let steps = 400u32;
        let middle = |i| (f64::from(i) + 0.5) / f64::from(steps);
        let mut squares = 0.0;
        for (x, y) in (0..steps).flat_map(|i| (0..steps).map(move |j| (middle(i), middle(j)))) {
            let inside = points.iter().filter(|point| point[0] < x && point[1] < y).count() as f64;
            squares += (x * y - inside / n) * (x * y - inside / n);
        }
        let integral = (squares / f64::from(steps * steps)).sqrt();
        prop_assert!((l2::l2_star(&set(2, &points), Deadline::never()).unwrap() - integral).abs() <= 0.01);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn dispersion_of_many_points_in_the_plane_is_that_of_the_widest_strip(points in points(2, 120)) {
        prop_assert!((dispersion_of(2, &points) - dispersion_by_strips(&points)).abs() <= 1e-15);
    }

    #[test]
    fn brackets_of_an_interrupted_search_hold_the_exact_value(
        points in prop::collection::vec(prop::collection::vec(coordinate(), 4), 200..400)
    ) {
        let set = set(4, &points);
        let at_once = Deadline::after(Duration::ZERO);
        let (early, exact) = (dispersion(&set, at_once), dispersion_of(4, &points));
        prop_assert!(early.volume.lower <= exact && exact <= early.volume.upper);
        prop_assert!(is_empty(&early.witness, &points));
        prop_assert_eq!(early.witness.volume(), early.volume.lower);

        let (early, exact) = (star_discrepancy(&set, at_once), star_of(4, &points));
        prop_assert!(early.lower <= exact && exact <= early.upper);
    }
}

#[test]
fn a_passed_deadline_interrupts_a_search_that_takes_long() {
    // Multiples of irrational numbers: evenly spread, so that many boxes are nearly the largest.
    let spread = |i: u32| [0.8191725, 0.6710436, 0.5497005].map(|step: f64| (f64::from(i) * step).fract()).to_vec();
    let set = set(3, &(1..=500).map(spread).collect());
    let at_once = Deadline::after(Duration::ZERO);
    for (early, full) in [
        (dispersion(&set, at_once).volume, dispersion(&set, Deadline::never()).volume),
        (star_discrepancy(&set, at_once), star_discrepancy(&set, Deadline::never())),
    ] {
        assert!(early.lower > 0.0 && early.lower <= exact(full) && exact(full) < early.upper, "{early:?} {full:?}");
    }
}

#[test]
fn boxes_are_cut_as_deep_as_there_are_points() {
    let line: Points = (0..20_000).map(|i| vec![1.0 - 1e-7 * f64::from(i), 1e-7 * f64::from(i)]).collect();
    assert!(dispersion_of(2, &line) > 0.99);
    let halving: Points = (1..1000).map(|i| vec![libm::exp2(-f64::from(i))]).collect();
    assert_eq!(dispersion_of(1, &halving), 0.5);
}

#[test]
fn one_point_leaves_the_larger_part_beside_it() {
    let points = vec![vec![0.25, 0.6]];
    assert_eq!(dispersion_of(2, &points), 0.75);
    assert_eq!(star_of(2, &points), 0.85);
}
