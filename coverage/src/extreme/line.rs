//! The extreme discrepancy of points on a line, by sorting them.

use crate::PointSet;

/// Computes the extreme discrepancy of points on a line, in O(n log n): for the sorted points `x_1 <= .. <= x_n` it is
/// `1/n + max (i/n - x_i) - min (i/n - x_i)` (Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods,
/// 1992, theorem 2.7).
///
/// # Panics
/// The points are not on a line.
pub(super) fn extreme_on_the_line(points: &PointSet) -> f64 {
    assert_eq!(points.dims(), 1, "points on a line");
    let n = points.len() as f64;
    let mut all: Vec<f64> = points.iter().map(|point| point[0]).collect();
    all.sort_unstable_by(f64::total_cmp);
    let excess = |i: usize| (i + 1) as f64 / n - all[i];
    let (mut least, mut most) = (0, 0);
    for i in 1..all.len() {
        if excess(i) < excess(least) {
            least = i;
        }
        if excess(i) > excess(most) {
            most = i;
        }
    }
    // The difference of the interval between the two points.
    if least <= most {
        (most + 1 - least) as f64 / n - (all[most] - all[least])
    } else {
        (all[least] - all[most]) - (least - most - 1) as f64 / n
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Deadline;
    use crate::samples::points_on_a_line;
    use crate::star::{Cell, Sides, largest_difference};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_line_has_what_the_general_search_finds(points in points_on_a_line(60)) {
            let sides = Sides::of_all_boxes(&points);
            let searched = largest_difference::<Cell>(&sides, &sides, Deadline::never());
            prop_assert!(searched.is_exact());
            // The sums have another order, so that the last bits may differ.
            prop_assert!((extreme_on_the_line(&points) - searched.lower).abs() < 1e-14);
        }
    }
}
