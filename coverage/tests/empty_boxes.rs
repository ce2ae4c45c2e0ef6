//! The maximal empty boxes of a growing set, against the search for the largest and against their definition.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::empty_boxes::EmptyBoxes;
use paracosm_coverage::{Deadline, PointSet, PointSetError};
use proptest::prelude::*;

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

fn any_points(sizes: [usize; 4]) -> impl Strategy<Value = (usize, Points)> {
    (1..=4usize).prop_flat_map(move |dims| points(dims, sizes[dims - 1]).prop_map(move |points| (dims, points)))
}

fn boxes_of(dims: usize, points: &[Vec<f64>]) -> EmptyBoxes {
    let mut boxes = EmptyBoxes::new(dims).unwrap();
    for point in points {
        boxes.add(point).unwrap();
    }
    boxes
}

fn sorted(dims: usize, boxes: &EmptyBoxes) -> Vec<(Vec<f64>, Vec<f64>)> {
    let boxes = boxes.larger_than(0.0);
    let mut boxes: Vec<_> = boxes.map(|b| (0..dims).map(|axis| b.side(axis)).unzip()).collect();
    boxes.sort_by(|a, b| a.partial_cmp(b).unwrap());
    boxes
}

/// All boxes between coordinates of the points that are empty and in no other such box.
fn maximal_by_definition(dims: usize, points: &[Vec<f64>]) -> Vec<(Vec<f64>, Vec<f64>)> {
    let mut boxes = vec![(vec![], vec![])];
    for axis in 0..dims {
        let mut grid: Vec<f64> = points.iter().map(|point| point[axis]).chain([0.0, 1.0]).collect();
        grid.sort_by(f64::total_cmp);
        grid.dedup();
        let mut longer = vec![];
        for (lower, upper) in &boxes {
            for (i, a) in grid.iter().enumerate() {
                let more = |b: &f64| ([lower.as_slice(), &[*a]].concat(), [upper.as_slice(), &[*b]].concat());
                longer.extend(grid[i + 1..].iter().map(more));
            }
        }
        boxes = longer;
    }
    let holds = |(lower, upper): &(Vec<f64>, Vec<f64>), point: &[f64]| {
        (0..dims).all(|axis| lower[axis] < point[axis] && point[axis] < upper[axis])
    };
    boxes.retain(|sides| !points.iter().any(|point| holds(sides, point)));
    let within = |a: &(Vec<f64>, Vec<f64>), b: &(Vec<f64>, Vec<f64>)| {
        (0..dims).all(|axis| b.0[axis] <= a.0[axis] && a.1[axis] <= b.1[axis])
    };
    let maximal = |a: &&(Vec<f64>, Vec<f64>)| !boxes.iter().any(|b| b != *a && within(a, b));
    let mut maximal: Vec<_> = boxes.iter().filter(maximal).cloned().collect();
    maximal.sort_by(|a, b| a.partial_cmp(b).unwrap());
    maximal
}

proptest! {
    #[test]
    fn the_largest_is_the_one_that_the_search_finds_after_every_point((dims, points) in any_points([40, 40, 30, 16])) {
        let mut boxes = EmptyBoxes::new(dims).unwrap();
        for i in 0..=points.len() {
            if i > 0 {
                boxes.add(&points[i - 1]).unwrap();
            }
            let set = PointSet::new(dims, &points[..i]).unwrap();
            let searched = dispersion(&set, Deadline::never()).volume;
            let kept = boxes.dispersion();
            prop_assert!(kept.is_exact() && searched.is_exact());
            prop_assert!((kept.lower - searched.lower).abs() <= 1e-15 * searched.lower, "{kept:?} {searched:?}");
            prop_assert_eq!(boxes.largest().volume(), kept.lower);
            let sides: Vec<(f64, f64)> = (0..dims).map(|axis| boxes.largest().side(axis)).collect();
            let holds = |p: &[f64]| sides.iter().zip(p).all(|((lower, upper), x)| lower < x && x < upper);
            prop_assert!(!set.iter().any(holds));
        }
    }

    #[test]
    fn the_boxes_are_the_maximal_ones_each_once((dims, points) in any_points([12, 7, 4, 2])) {
        let boxes = boxes_of(dims, &points);
        prop_assert_eq!(sorted(dims, &boxes), maximal_by_definition(dims, &points));
    }

    #[test]
    fn the_order_of_the_points_does_not_matter((dims, mut points) in any_points([40, 40, 30, 16])) {
        let forward = sorted(dims, &boxes_of(dims, &points));
        points.reverse();
        prop_assert_eq!(forward, sorted(dims, &boxes_of(dims, &points)));
    }

    #[test]
    fn a_store_that_forgets_never_claims_more_than_it_knows(
        (dims, points) in any_points([40, 40, 30, 16]),
        most in 1..40usize,
    ) {
        let mut boxes = EmptyBoxes::new(dims).unwrap();
        let mut few = EmptyBoxes::at_most(dims, most).unwrap();
        for point in &points {
            boxes.add(point).unwrap();
            few.add(point).unwrap();
            let (exact, known) = (boxes.dispersion().lower, few.dispersion());
            prop_assert!(few.len() <= most);
            prop_assert!(known.lower <= exact && exact <= known.upper, "{exact} {known:?}");
        }
    }
}

#[test]
fn points_that_are_none_are_refused_and_change_nothing() {
    assert_eq!(EmptyBoxes::new(0).unwrap_err(), PointSetError::NoDimension);
    let mut boxes = boxes_of(2, &[vec![0.5, 0.5]]);
    let ragged = PointSetError::Ragged { index: 1, found: 1, expected: 2 };
    assert_eq!(boxes.add(&[0.5]), Err(ragged));
    let outside = PointSetError::OutsideCube { index: 1, axis: 1, value: 1.5 };
    assert_eq!(boxes.add(&[0.5, 1.5]), Err(outside));
    assert!(boxes.add(&[f64::NAN, 0.5]).is_err());
    assert_eq!(boxes.len(), 4);
}

#[test]
fn a_duplicate_and_a_point_on_a_wall_leave_all_boxes_as_they_are() {
    let mut boxes = boxes_of(3, &[vec![0.25, 0.5, 0.75]]);
    let before = sorted(3, &boxes);
    for point in [[0.25, 0.5, 0.75], [0.0, 0.3, 0.3], [0.9, 1.0, 0.1]] {
        boxes.add(&point).unwrap();
    }
    assert_eq!(before, sorted(3, &boxes));
}
