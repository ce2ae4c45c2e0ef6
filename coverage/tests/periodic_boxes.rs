//! The maximal periodic empty boxes of a growing set, against their definition.

use paracosm_coverage::empty_boxes::EmptyBoxes;
use proptest::prelude::*;

type Points = Vec<Vec<f64>>;

/// The ends of a box along each axis.
type Sides = Vec<(f64, f64)>;

/// Points whose coordinates are fractions of a power of two, so that sums are exact; few fractions make ties.
fn any_points(sizes: [usize; 3]) -> impl Strategy<Value = (usize, Points)> {
    (1..=3usize, prop::sample::select(&[4_u16, 16, 1024][..])).prop_flat_map(move |(dims, parts)| {
        let coordinate = (0..=parts).prop_map(move |i| f64::from(i) / f64::from(parts));
        let points = prop::collection::vec(prop::collection::vec(coordinate, dims), 0..=sizes[dims - 1]);
        points.prop_map(move |points| (dims, points))
    })
}

fn boxes_of(dims: usize, most: usize, points: &[Vec<f64>]) -> EmptyBoxes {
    let mut boxes = EmptyBoxes::periodic_at_most(dims, most).unwrap();
    for point in points {
        boxes.add(point).unwrap();
    }
    boxes
}

fn sorted(dims: usize, boxes: &EmptyBoxes) -> Vec<Sides> {
    let sides = |b: paracosm_coverage::empty_boxes::EmptyBox| (0..dims).map(|axis| b.side(axis)).collect();
    let mut boxes: Vec<Sides> = boxes.larger_than(0.0).map(sides).collect();
    boxes.sort_by(|a, b| a.partial_cmp(b).unwrap());
    boxes
}

/// The volume of a box; a side that goes all the way round has the width 1.
fn volume(sides: &Sides) -> f64 {
    sides.iter().map(|(lower, upper)| (upper - lower).min(1.0)).product()
}

/// All empty boxes from coordinate to coordinate of the points, once round at most, and all the way round. A point is
/// in a box if one of its copies is, moved by whole numbers.
fn empty_boxes(dims: usize, points: &[Vec<f64>]) -> Vec<Sides> {
    let mut boxes: Vec<Sides> = vec![vec![]];
    for axis in 0..dims {
        let mut grid: Vec<f64> = points.iter().map(|point| point[axis] % 1.0).collect();
        grid.sort_by(f64::total_cmp);
        grid.dedup();
        let copies: Vec<f64> = grid.iter().flat_map(|x| [*x, x + 1.0]).collect();
        let once_round = |a: f64| copies.iter().filter(move |b| a < **b && **b <= a + 1.0).map(move |b| (a, *b));
        let mut sides: Sides = grid.iter().flat_map(|a| once_round(*a)).collect();
        sides.push((f64::NEG_INFINITY, f64::INFINITY));
        boxes = boxes.iter().flat_map(|b| sides.iter().map(|side| [&b[..], &[*side]].concat())).collect();
    }
    let inside =
        |(lower, upper): &(f64, f64), x: f64| (-1..=1).any(|k| *lower < x + f64::from(k) && x + f64::from(k) < *upper);
    boxes.retain(|sides| !points.iter().any(|point| sides.iter().zip(point).all(|(side, x)| inside(side, *x))));
    boxes
}

/// The empty boxes that lie in no other one.
fn maximal_by_definition(dims: usize, points: &[Vec<f64>]) -> Vec<Sides> {
    let boxes = empty_boxes(dims, points);
    let side_within =
        |(a, b): (&(f64, f64), &(f64, f64))| (-1..=1).any(|k| b.0 <= a.0 + f64::from(k) && a.1 + f64::from(k) <= b.1);
    let within = |a: &Sides, b: &Sides| a.iter().zip(b).all(side_within);
    let maximal = |a: &&Sides| !boxes.iter().any(|b| b != *a && within(a, b));
    let mut maximal: Vec<Sides> = boxes.iter().filter(maximal).cloned().collect();
    maximal.sort_by(|a, b| a.partial_cmp(b).unwrap());
    maximal
}

proptest! {
    #[test]
    fn the_periodic_boxes_are_the_maximal_ones_each_once((dims, points) in any_points([10, 5, 3])) {
        let boxes = boxes_of(dims, usize::MAX, &points);
        prop_assert_eq!(sorted(dims, &boxes), maximal_by_definition(dims, &points));
    }

    #[test]
    fn the_largest_periodic_box_is_the_largest_of_all_empty_ones((dims, points) in any_points([20, 8, 4])) {
        let boxes = boxes_of(dims, usize::MAX, &points);
        let largest = empty_boxes(dims, &points).iter().map(volume).fold(0.0, f64::max);
        prop_assert!(boxes.dispersion().is_exact());
        prop_assert!((boxes.dispersion().lower - largest).abs() <= 1e-15, "{largest} {:?}", boxes.dispersion());
        prop_assert_eq!(boxes.largest().volume(), boxes.dispersion().lower);
    }

    #[test]
    fn points_that_are_all_moved_round_the_cube_leave_boxes_of_the_same_volumes(
        (dims, points) in any_points([20, 20, 12]),
        shift in prop::collection::vec((0..64_u8).prop_map(|i| f64::from(i) / 64.0), 3),
    ) {
        let moved: Points =
            points.iter().map(|point| point.iter().zip(&shift).map(|(x, by)| (x + by) % 1.0).collect()).collect();
        let volumes = |points| {
            let boxes = boxes_of(dims, usize::MAX, points);
            let mut volumes: Vec<f64> = boxes.larger_than(0.0).map(|b| b.volume()).collect();
            volumes.sort_by(f64::total_cmp);
            volumes
        };
        prop_assert_eq!(volumes(&points), volumes(&moved));
    }

    #[test]
    fn a_periodic_store_that_forgets_never_claims_more_than_it_knows(
        (dims, points) in any_points([40, 40, 20]),
        most in 1..40usize,
    ) {
        let mut few = EmptyBoxes::periodic_at_most(dims, most).unwrap();
        let mut all = EmptyBoxes::periodic_at_most(dims, usize::MAX).unwrap();
        for point in &points {
            few.add(point).unwrap();
            all.add(point).unwrap();
            let (exact, known) = (all.dispersion().lower, few.dispersion());
            prop_assert!(few.len() <= most);
            prop_assert!(known.lower <= exact && exact <= known.upper, "{exact} {known:?}");
        }
    }
}

#[test]
fn the_two_ends_of_an_axis_are_the_same_place() {
    let at_0 = boxes_of(2, 100, &[vec![0.0, 0.5]]);
    assert_eq!(sorted(2, &at_0), sorted(2, &boxes_of(2, 100, &[vec![1.0, 0.5]])));
    assert_eq!(at_0.dispersion().lower, 1.0);
}
