//! Random sets of points for property tests. Many points share coordinates or lie on the border.

use crate::PointSet;
use proptest::prelude::*;

fn coordinate() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![0.0..=1.0_f64, (0..=8_u8).prop_map(|eighths| f64::from(eighths) / 8.0)]
}

/// Fewer than `most` points on a line.
pub(crate) fn points_on_a_line(most: usize) -> impl Strategy<Value = PointSet> {
    let points = prop::collection::vec(coordinate().prop_map(|x| [x]), 1..most);
    points.prop_map(|points| PointSet::new(1, points).expect("points of the cube"))
}

/// Fewer than `most` points in the plane, some of them evenly spread.
pub(crate) fn points_in_the_plane(most: usize) -> impl Strategy<Value = PointSet> {
    let lattice = |n: usize| {
        (0..n).map(move |i| [i as f64 / n as f64, (i as f64 * 0.618_033_988_749).fract()]).collect::<Vec<_>>()
    };
    let any = prop::collection::vec((coordinate(), coordinate()).prop_map(|(x, y)| [x, y]), 1..most);
    let points = prop_oneof![any, (1..most).prop_map(lattice)];
    points.prop_map(|points| PointSet::new(2, points).expect("points of the cube"))
}
