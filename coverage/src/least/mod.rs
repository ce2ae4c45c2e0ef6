//! Proves how small the dispersion of a number of points can be.
//!
//! The order of the points along each axis decides which boxes between them are empty. So a dispersion below a level bounds products of differences of
//! coordinates. If the differences along all axes but one have lower bounds, such a product is an upper bound on the difference along this axis, and upper bounds
//! on differences follow from each other as in a problem of shortest paths. A search adds one point after another to the order, in each of its places, and then cuts the
//! intervals of differences in two, until no coordinates keep the bounds.
//!
//! A box of the volume v with m points inside has an empty box of the volume v times the least dispersion of m points. So the levels that are proved for fewer
//! points bound the volumes of boxes with points inside.
//!
//! Bounds are whole numbers of units of 2^-40, rounded upward. So rounding never rules out points.

mod differences;
mod order;
mod search;
mod step;
mod table;

use crate::dispersion::dispersion;
use crate::{Deadline, PointSet};
use differences::{Differences, UNIT};
use order::Order;
use search::{Search, Stop};
pub use step::{Split, Step};
pub use table::{Row, Table};

/// The share by which a proved level may be less than the dispersion of the best points.
pub const PRECISION: f64 = 1e-6;

/// The share of the time for one attempt.
const ATTEMPT: f64 = 0.4;

/// The most boxes between points, of which each round of the search looks at all.
const MOST_BOXES: usize = 2_000_000;

/// Returns the most points in this number of dimensions for which a proof is tried; 0 if there are none.
pub fn most_points(dims: usize) -> usize {
    let fits = |points: &usize| {
        let intervals = (points + 2) * (points + 1) / 2;
        let boxes = u32::try_from(dims).ok().and_then(|dims| intervals.checked_pow(dims));
        dims > 0 && boxes.is_some_and(|boxes| boxes <= MOST_BOXES)
    };
    (1..=32).take_while(fits).last().unwrap_or(0)
}

/// The bounds on the least dispersion of a number of points.
#[derive(Debug, Clone)]
pub struct Least {
    /// No points have a dispersion below this level. If nothing is proved, it is the gap that the points leave along an axis.
    pub level: f64,
    /// The proof of the level; empty if nothing is proved.
    pub steps: Vec<Step>,
    /// The points with the smallest dispersion that is known.
    pub points: PointSet,
    /// The dispersion of these points.
    pub dispersion: f64,
}

impl Least {
    /// Returns true if the level is the least dispersion, except for a share of [`PRECISION`].
    pub fn is_proved(&self) -> bool {
        is_proved(self.level, self.dispersion)
    }
}

fn is_proved(level: f64, dispersion: f64) -> bool {
    level >= dispersion * (1.0 - PRECISION)
}

/// Finds the least dispersion of as many points as are given, beginning with these points, with a proof. `levels` has a proved level for each smaller number of points, from 0
/// on: the first is 1. If the time is too short, the proved level is lower than the dispersion of the points.
///
/// # Panics
/// There are no points or no dimensions, there are more than [`most_points`], or there are not as many levels as points.
pub fn least_dispersion(points: &PointSet, levels: &[f64], deadline: Deadline) -> Least {
    let most = most_points(points.dims());
    assert!((1..=most).contains(&points.len()), "{} points, expected from 1 to {most}", points.len());
    assert_eq!(levels.len(), points.len(), "each smaller number of points has a level");
    let value = dispersion(points, Deadline::never()).volume.upper;
    // Along an axis, n points leave a gap of 1 / (n + 1).
    let trivial = (1.0 / (points.len() + 1) as f64).next_down();
    let mut least = Least { level: trivial, steps: Vec::new(), points: points.clone(), dispersion: value };
    // Levels from here on are not tried: there are points, or the time was too short.
    let mut ceiling = value;
    // If the points are the best, the first attempt proves it.
    let mut level = value * (1.0 - PRECISION);
    while !least.is_proved() && least.level < ceiling * (1.0 - PRECISION / 4.0) && !deadline.passed() {
        match steps(points.len(), points.dims(), level, levels, deadline.part(ATTEMPT)) {
            Ok(steps) => (least.level, least.steps) = (level, steps),
            Err(Stop::Time) => ceiling = level,
            Err(Stop::Found(found)) => {
                ceiling = level;
                let value = dispersion(&found, Deadline::never()).volume.upper;
                if value < least.dispersion {
                    (least.points, least.dispersion) = (found, value);
                }
            }
        }
        level = f64::midpoint(least.level, ceiling);
    }
    least
}

/// Proves that no points have a dispersion below a level.
fn steps(points: usize, dims: usize, level: f64, levels: &[f64], deadline: Deadline) -> Result<Vec<Step>, Stop> {
    // A unit more than the quotient, which is rounded.
    let units = |volume: f64| (volume * UNIT as f64).ceil() as i64 + 1;
    // Boxes with so many points inside have at most this volume; all points together may fill the cube.
    let volumes: Vec<i64> = levels.iter().map(|known| units(level / known)).chain([UNIT]).collect();
    let mut bounds = vec![Differences::of_the_cube(points); dims];
    // The points are numbered along the first axis.
    for point in 1..points {
        let is_possible = bounds[0].demand(point + 1, point, 0);
        assert!(is_possible, "an order alone is always possible");
    }
    Search { volumes: &volumes, deadline }.order(&Order::new(points, dims), bounds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::points_in_the_plane;
    use proptest::prelude::*;
    use proptest::test_runner::TestRunner;
    use std::time::Duration;

    /// The least dispersions up to a number of points, from the diagonal on.
    fn leasts(dims: usize, most: usize) -> Vec<Least> {
        let mut levels = vec![1.0];
        let mut leasts = Vec::new();
        for n in 1..=most {
            let diagonal = (1..=n).map(|i| vec![i as f64 / (n + 1) as f64; dims]);
            let least = least_dispersion(&PointSet::new(dims, diagonal).unwrap(), &levels, Deadline::never());
            assert!(least.is_proved(), "{least:?}");
            levels.push(least.level);
            leasts.push(least);
        }
        leasts
    }

    #[test]
    fn the_least_dispersions_of_few_points_are_those_that_can_be_computed_by_hand() {
        // One point halves the cube. Of two points, one empty box lies between them, and two beside them: x = 1 - x^2.
        let golden = (3.0 - 5.0_f64.sqrt()) / 2.0;
        for (dims, known) in [
            (1, vec![1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0]),
            (2, vec![1.0 / 2.0, golden, 0.307_978_5, 1.0 / 4.0]),
            (3, vec![1.0 / 2.0, golden, 1.0 / 3.0]),
        ] {
            for (least, known) in leasts(dims, known.len()).iter().zip(known) {
                assert!((least.dispersion - known).abs() < 3e-6, "{dims}: {} instead of {known}", least.dispersion);
                assert!(least.level <= known, "{dims}: {} is proved, and {known} is reached", least.level);
            }
        }
    }

    #[test]
    fn no_points_are_better_than_a_proved_level() {
        let leasts = leasts(2, 6);
        let mut runner = TestRunner::default();
        let holds = runner.run(&points_in_the_plane(7), |points| {
            let value = dispersion(&points, Deadline::never()).volume.lower;
            prop_assert!(value >= leasts[points.len() - 1].level, "{value} of {points:?}");
            Ok(())
        });
        holds.unwrap();
    }

    #[test]
    fn points_beside_the_best_are_no_better_than_a_proved_level() {
        let leasts = leasts(2, 6);
        let moves = prop::collection::vec((-1e-4..1e-4_f64, -1e-4..1e-4_f64), 6);
        let mut runner = TestRunner::default();
        let holds = runner.run(&(0..6_usize, moves), |(at, moves)| {
            let best = &leasts[at].points;
            let moved =
                best.iter().zip(&moves).map(|(point, (x, y))| [point[0] + x, point[1] + y].map(|x| x.clamp(0.0, 1.0)));
            let value = dispersion(&PointSet::new(2, moved).unwrap(), Deadline::never()).volume.lower;
            prop_assert!(value >= leasts[at].level, "{value} of {} points", at + 1);
            Ok(())
        });
        holds.unwrap();
    }

    #[test]
    fn without_time_nothing_is_proved() {
        let points = PointSet::new(2, [[0.2, 0.4], [0.7, 0.6]]).unwrap();
        let least = least_dispersion(&points, &[1.0, 0.5], Deadline::after(Duration::ZERO));
        assert!(!least.is_proved() && least.points == points && least.level < 1.0 / 3.0);
    }
}
