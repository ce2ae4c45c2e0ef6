//! Measures how well places tell which tests fail: by the nearest test of a sample, compared with a dense map, and by
//! simple explanations, compared with the tests themselves.

/// A test: its place in the unit square, and whether it failed.
pub type Mark = ([f64; 2], bool);

/// The agreement of predictions by the nearest test with the verdicts of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recovery {
    /// The share of the map that is predicted right.
    pub accuracy: f64,
    /// The share of the map's failures that are predicted.
    pub recall: f64,
    /// The share of the predicted failures that are failures.
    pub precision: f64,
}

/// Predicts each verdict of the map from the sample's nearest test, and compares the predictions with the map.
pub fn recovery(sample: &[Mark], map: &[Mark]) -> Recovery {
    let sample = Sorted::of(sample.iter().copied());
    let (mut right, mut told, mut failures, mut hits) = (0, 0, 0, 0);
    for (place, fails) in map {
        let predicted = sample.nearest(*place, None);
        right += usize::from(predicted == *fails);
        told += usize::from(predicted);
        failures += usize::from(*fails);
        hits += usize::from(predicted && *fails);
    }
    let share = |part: usize, whole: usize| part as f64 / whole as f64;
    Recovery { accuracy: share(right, map.len()), recall: share(hits, failures), precision: share(hits, told) }
}

/// Tests in ascending order of their first coordinate, each with its index before.
struct Sorted(Vec<(Mark, usize)>);

impl Sorted {
    fn of(tests: impl IntoIterator<Item = Mark>) -> Self {
        let mut sorted: Vec<_> = tests.into_iter().enumerate().map(|(index, test)| (test, index)).collect();
        sorted.sort_by(|(a, _), (b, _)| a.0[0].total_cmp(&b.0[0]));
        Self(sorted)
    }

    /// Returns whether the test nearest to a place failed. Among tests at the same distance the first counts. The test
    /// with the index `except` does not count.
    ///
    /// The search goes to both sides from the place, until the first coordinate alone is further away than the nearest
    /// test so far.
    fn nearest(&self, place: [f64; 2], except: Option<usize>) -> bool {
        let start = self.0.partition_point(|(test, _)| test.0[0] < place[0]);
        let (mut best, mut first, mut failed) = (f64::INFINITY, usize::MAX, false);
        let mut look = |((at, fails), index): &(Mark, usize)| {
            let (x, y) = (at[0] - place[0], at[1] - place[1]);
            let distance = x * x + y * y;
            if except != Some(*index) && (distance, *index) < (best, first) {
                (best, first, failed) = (distance, *index, *fails);
            }
            x * x <= best
        };
        // `all` stops at the first test that is too far away.
        self.0[start..].iter().all(&mut look);
        self.0[..start].iter().rev().all(&mut look);
        failed
    }
}

/// Returns the share of tests that fail.
pub fn failing(tests: &[Mark]) -> f64 {
    tests.iter().filter(|test| test.1).count() as f64 / tests.len() as f64
}

/// Returns the share of tests whose verdict is that of the nearest other test.
pub fn nearest_neighbour(tests: &[Mark]) -> f64 {
    let sorted = Sorted::of(tests.iter().copied());
    let told = |i: &usize| sorted.nearest(tests[*i].0, Some(*i)) == tests[*i].1;
    (0..tests.len()).filter(told).count() as f64 / tests.len() as f64
}

/// Returns the largest share of tests that a straight line predicts right, with failing tests on one side of the line.
///
/// A best line can be moved until it passes through two tests, or as close beside them as one likes. So for every test,
/// the other tests are sorted by their direction, and a line is turned about the test.
pub fn straight_line(tests: &[Mark]) -> f64 {
    let failures = tests.iter().filter(|test| test.1).count();
    let mut best = failures.max(tests.len() - failures);
    for (pivot, (about, _)) in tests.iter().enumerate() {
        // The line turns by half a turn. Either side may be the failing side, so that the line's orientation does not
        // matter.
        let others = tests.iter().enumerate().filter(|(i, _)| *i != pivot).map(|(_, test)| test);
        let mut events: Vec<(f64, bool, bool)> = others
            .map(|(at, fails)| {
                let (x, y) = (at[0] - about[0], at[1] - about[1]);
                let upper = y > 0.0 || (y == 0.0 && x >= 0.0);
                // This number grows with the angle of the direction after the direction is brought to the upper
                // half-plane.
                let (x, y) = if upper { (x, y) } else { (-x, -y) };
                (-x / (x.abs() + y.abs()).max(f64::MIN_POSITIVE), upper, *fails)
            })
            .collect();
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        // `right` counts failing tests on the left of the line that points along x, plus passing tests on its right.
        let mut right = events.iter().filter(|(_, upper, fails)| upper == fails).count();
        for (i, (angle, upper, fails)) in events.iter().enumerate() {
            right = if upper == fails { right - 1 } else { right + 1 };
            // All tests in one direction change sides at once. The pivot itself can be put on either side.
            if events.get(i + 1).is_none_or(|next| next.0 - angle > 1e-12) {
                best = best.max(right + 1).max(tests.len() - right);
            }
        }
    }
    best as f64 / tests.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm::generators::{Request, Strategy};
    use paracosm::space::Space;

    #[test]
    fn a_straight_line_explains_what_lies_on_two_sides_and_not_what_lies_between() {
        let line = |fails: fn(f64, f64) -> bool| {
            let cells = (0..100).map(|i| [f64::from(i % 10) + 0.01 * f64::from(i / 10), f64::from(i / 10)]);
            straight_line(&cells.map(|at| (at, fails(at[0], at[1]))).collect::<Vec<_>>())
        };
        assert_eq!(line(|x, y| x + 2.0 * y > 13.0), 1.0);
        assert_eq!(line(|_, _| false), 1.0);
        // A band of 20 of 100 tests in the middle fails. The best is to call all tests passing.
        assert_eq!(line(|_, y| (4.0..6.0).contains(&y)), 0.8);
    }

    #[test]
    fn a_sample_is_held_against_the_map_by_its_nearest_test() {
        let sample = [([0.0, 0.0], false), ([1.0, 0.0], true)];
        let map = [([0.1, 0.0], false), ([0.4, 0.0], true), ([0.9, 0.5], true), ([0.6, 0.0], false)];
        let found = recovery(&sample, &map);
        assert_eq!(found, Recovery { accuracy: 0.5, recall: 0.5, precision: 0.5 });
    }

    #[test]
    fn the_nearest_test_is_the_one_that_a_search_of_all_tests_finds() {
        // A coarse grid has many tests at the same distance.
        let points = Strategy::RANDOM.build(&Request { seed: Some(7), ..Request::new(&Space::unit_cube(2), 400) });
        let places = points
            .unwrap()
            .ask(400)
            .into_iter()
            .map(|point| [0, 1].map(|i| (16.0 * point.continuous[i]).round() / 16.0));
        let (tests, places): (Vec<_>, Vec<_>) = places.enumerate().partition(|(i, _)| i % 2 == 0);
        let tests: Vec<Mark> = tests.into_iter().map(|(i, at)| (at, i % 3 == 0)).collect();
        let sorted = Sorted::of(tests.iter().copied());
        for (_, place) in places {
            let square = |x: f64| x * x;
            let distance = |at: [f64; 2]| square(at[0] - place[0]) + square(at[1] - place[1]);
            let naive = tests.iter().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0))).unwrap();
            assert_eq!(sorted.nearest(place, None), naive.1);
        }
    }
}
