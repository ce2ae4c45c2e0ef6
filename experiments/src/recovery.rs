//! How well a sample of tests tells what a dense map shows: the verdict of the nearest test, held against the
//! map's own.

/// A test in the unit square with whether it failed.
pub type Mark = ([f64; 2], bool);

/// How the nearest test's verdict agrees with the map's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recovery {
    /// Share of the map that is told right.
    pub accuracy: f64,
    /// Share of the map's failures that are told.
    pub recall: f64,
    /// Share of the told failures that are some.
    pub precision: f64,
}

/// Predicts every place of the map by the nearest test of the sample, in the unit square.
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

/// Whether the test nearest to a place failed; the first of equals.
fn nearest(sample: &[Mark], place: &[f64; 2]) -> bool {
    let distance = |at: &[f64; 2]| (at[0] - place[0]) * (at[0] - place[0]) + (at[1] - place[1]) * (at[1] - place[1]);
    let nearest = sample.iter().min_by(|a, b| distance(&a.0).total_cmp(&distance(&b.0)));
    nearest.is_some_and(|(_, fails)| *fails)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_held_against_the_map_by_its_nearest_test() {
        let sample = [([0.0, 0.0], false), ([1.0, 0.0], true)];
        let map = [([0.1, 0.0], false), ([0.4, 0.0], true), ([0.9, 0.5], true), ([0.6, 0.0], false)];
        let found = recovery(&sample, &map);
        assert_eq!(found, Recovery { accuracy: 0.5, recall: 0.5, precision: 0.5 });
    }
}
