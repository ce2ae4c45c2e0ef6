//! The star discrepancy of points on a line, by sorting them (Niederreiter, Random Number Generation and Quasi-Monte
//! Carlo Methods, 1992, theorem 2.6).

use super::sides::Sides;
use crate::PointSet;

/// Computes the star discrepancy of points on a line, in O(n log n). The general search computes the same number to the
/// last bit.
///
/// # Panics
/// The points are not on a line.
pub(super) fn star_on_the_line(points: &PointSet) -> f64 {
    assert_eq!(points.dims(), 1, "points on a line");
    let sides = Sides::of_anchored_boxes(points);
    let mut all: Vec<f64> = points.iter().map(|point| point[0]).collect();
    all.sort_unstable_by(f64::total_cmp);
    let (mut most, mut below) = (0.0_f64, 0);
    for same in all.chunk_by(|a, b| a == b) {
        let x = same[0];
        most = most.max(x - sides.share(below));
        below += same.len();
        most = most.max(sides.share(below) - x);
    }
    // The open interval up to 1 holds all points but the points at 1.
    let at_1 = all.iter().rev().take_while(|x| **x >= 1.0).count();
    most.max(1.0 - sides.share(all.len() - at_1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Deadline;
    use crate::samples::points_on_a_line;
    use crate::star::{Cell, largest_difference};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_line_has_what_the_general_search_finds(points in points_on_a_line(60)) {
            let sides = Sides::of_anchored_boxes(&points);
            let searched = largest_difference::<Cell>(&sides, &sides, Deadline::never());
            prop_assert!(searched.is_exact());
            prop_assert_eq!(star_on_the_line(&points), searched.lower);
        }
    }
}
