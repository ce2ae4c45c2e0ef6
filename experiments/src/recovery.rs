//! Measures how well places tell which tests fail: by the nearest test of a sample, compared with a dense map, and by
//! simple explanations, compared with the tests themselves.

use paracosm::analysis::statistics::quantile;
use paracosm::generators::{Request, Strategy};
use paracosm::space::Space;

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

/// The number of sets whose recalls are compared, of each strategy.
const SETS: u64 = 400;

/// The recalls of shifted Halton sets and of random sets of one size. One set says little, because the recalls of sets
/// of one size are spread widely.
#[derive(Debug, Clone, Copy)]
pub struct Recalls {
    /// The median recall of the Halton sets.
    pub halton: f64,
    /// The median recall of the random sets.
    pub random: f64,
    /// The probability that a Halton set has a larger recall than a random set. Equal recalls count as half.
    pub better: f64,
}

impl Recalls {
    /// Measures sets of `size` tests on a square map, whose rows follow each other. A test has the verdict of its cell.
    pub fn on(map: &[Mark], size: usize) -> Self {
        let side = map.len().isqrt();
        let space = Space::unit_cube(2);
        let recalls = |strategy: Strategy| -> Vec<f64> {
            let sets = (0..SETS).map(|seed| {
                let request = Request { seed: Some(seed), ..Request::new(&space, size) };
                let points = strategy.build(&request).expect("a plain request").ask(size);
                let verdict = |at: [f64; 2]| {
                    let [column, row] = at.map(|share| (share * side as f64) as usize);
                    (at, map[side * row + column].1)
                };
                let places = points.iter().map(|point| [point.continuous[0], point.continuous[1]]);
                recovery(&places.map(verdict).collect::<Vec<_>>(), map).recall
            });
            let mut recalls: Vec<f64> = sets.collect();
            recalls.sort_by(f64::total_cmp);
            recalls
        };
        let (halton, random) = (recalls(Strategy::HALTON), recalls(Strategy::RANDOM));
        let wins = |of: f64| {
            let (less, most) = (random.partition_point(|r| *r < of), random.partition_point(|r| *r <= of));
            0.5 * (less + most) as f64
        };
        let better = halton.iter().map(|recall| wins(*recall)).sum::<f64>() / (SETS * SETS) as f64;
        Self { halton: quantile(&halton, 0.5), random: quantile(&random, 0.5), better }
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

    /// The recalls of 400 sets of each size on both maps of Figure 9, as the pages say them.
    #[test]
    fn the_pages_of_figure_9_have_the_recalls_of_400_shifted_halton_sets() {
        let rows = include_str!("../data/fig9-cnn-reference.csv").lines().skip(1);
        let verdicts = rows.enumerate().map(|(row, line)| {
            let share = |place: usize| (place as f64 + 0.5) / 50.0;
            ([share(row % 50), share(row / 50)], line.contains(",fail,"))
        });
        let with_network: Vec<Mark> = verdicts.collect();
        let study = crate::scenario("pedestrian-crossing").unwrap().build().unwrap();
        let trials = crate::sampling::grid(&study, 100, &indicatif::ProgressBar::hidden()).unwrap();
        let without = crate::sampling::marks(&study, &trials).unwrap();
        let pages = [
            (with_network, [25, 50, 100], include_str!("../fig9-cnn.md")),
            (without, [25, 100, 500], include_str!("../fig9.md")),
        ];
        for (map, sizes, page) in pages {
            let found = sizes.map(|size| Recalls::on(&map, size));
            let percent = |of: fn(&Recalls) -> f64| {
                let [a, b, c] = found.each_ref().map(|recalls| format!("{:.0}", 100.0 * of(recalls)));
                format!("{a}, {b} and {c} %")
            };
            let [a, b, c] = found.each_ref().map(|recalls| format!("{:.2}", recalls.better));
            let said = [
                format!("400 shifted Halton sets have median recalls of {}", percent(|recalls| recalls.halton)),
                format!("400 random sets {}", percent(|recalls| recalls.random)),
                format!("with a probability of {a}, {b} and {c}"),
            ];
            let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
            let missing: Vec<&String> = said.iter().filter(|said| !page.contains(said.as_str())).collect();
            assert!(missing.is_empty(), "expected on the page: {missing:#?}");
        }
    }
}
