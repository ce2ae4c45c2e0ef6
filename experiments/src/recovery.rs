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
    let (mut right, mut told, mut failures, mut hits) = (0, 0, 0, 0);
    for (place, fails) in map {
        let predicted = nearest(sample, place);
        right += usize::from(predicted == *fails);
        told += usize::from(predicted);
        failures += usize::from(*fails);
        hits += usize::from(predicted && *fails);
    }
    let share = |part: usize, whole: usize| part as f64 / whole as f64;
    Recovery { accuracy: share(right, map.len()), recall: share(hits, failures), precision: share(hits, told) }
}

/// Returns whether the test nearest to a place failed. Among tests at the same distance the first counts.
fn nearest<'a>(sample: impl IntoIterator<Item = &'a Mark>, place: &[f64; 2]) -> bool {
    let distance = |at: &[f64; 2]| (at[0] - place[0]) * (at[0] - place[0]) + (at[1] - place[1]) * (at[1] - place[1]);
    let nearest = sample.into_iter().min_by(|a, b| distance(&a.0).total_cmp(&distance(&b.0)));
    nearest.is_some_and(|(_, fails)| *fails)
}

/// Returns the share of tests that fail.
pub fn failing(tests: &[Mark]) -> f64 {
    tests.iter().filter(|test| test.1).count() as f64 / tests.len() as f64
}

/// Returns the share of tests whose verdict is that of the nearest other test.
pub fn nearest_neighbour(tests: &[Mark]) -> f64 {
    let told = |i: usize| nearest(tests[..i].iter().chain(&tests[i + 1..]), &tests[i].0) == tests[i].1;
    (0..tests.len()).filter(|i| told(*i)).count() as f64 / tests.len() as f64
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

    /// The recalls of 400 sets of each size on the map of Figure 9 with a network: medians of shifted Halton sets and of
    /// random sets in percent, and the probability that a Halton set has the larger recall.
    #[test]
    fn the_page_of_figure_9_with_a_network_has_the_recalls_of_400_shifted_halton_sets() {
        let rows = include_str!("../data/fig9-cnn-reference.csv").lines().skip(1);
        let map: Vec<Mark> = rows
            .enumerate()
            .map(|(row, line)| {
                let share = |place: usize| (place as f64 + 0.5) / 50.0;
                ([share(row % 50), share(row / 50)], line.contains(",fail,"))
            })
            .collect();
        let space = Space::unit_cube(2);
        let recalls = |strategy: Strategy, n: usize| -> Vec<f64> {
            let recall = |seed: u64| {
                let request = Request { seed: Some(seed), ..Request::new(&space, n) };
                let points = strategy.build(&request).unwrap().ask(n).into_iter().map(|point| point.continuous);
                let sample: Vec<Mark> = points
                    .map(|at| {
                        let [column, row] = [at[0], at[1]].map(|share| (share * 50.0) as usize);
                        ([at[0], at[1]], map[50 * row + column].1)
                    })
                    .collect();
                recovery(&sample, &map).recall
            };
            let mut recalls: Vec<f64> = (0..400).map(recall).collect();
            recalls.sort_by(f64::total_cmp);
            recalls
        };
        let percent = |recalls: &[f64]| format!("{:.0}", 50.0 * (recalls[199] + recalls[200]));
        let better = |halton: &[f64], random: &[f64]| {
            let wins = |h: &f64| {
                random
                    .iter()
                    .map(|r| {
                        if h > r {
                            1.0
                        } else if h == r {
                            0.5
                        } else {
                            0.0
                        }
                    })
                    .sum::<f64>()
            };
            format!("{:.2}", halton.iter().map(wins).sum::<f64>() / (400.0 * 400.0))
        };
        let found = [25, 50, 100].map(|n| {
            let (halton, random) = (recalls(Strategy::HALTON, n), recalls(Strategy::RANDOM, n));
            (percent(&halton), percent(&random), better(&halton, &random))
        });
        let list = |of: fn(&(String, String, String)) -> &String| {
            let [a, b, c] = found.each_ref().map(|found| of(found).as_str());
            format!("{a}, {b} and {c}")
        };
        let page = include_str!("../fig9-cnn.md");
        let said = [
            format!("400 shifted Halton sets have median recalls of {} %", list(|found| &found.0)),
            format!("400 random sets {} %", list(|found| &found.1)),
            format!("with a probability of {}", list(|found| &found.2)),
        ];
        let missing: Vec<&String> = said.iter().filter(|said| !page.contains(said.as_str())).collect();
        assert!(missing.is_empty(), "expected on the page: {missing:#?}");
    }
}
