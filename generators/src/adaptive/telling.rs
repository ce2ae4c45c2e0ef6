//! Selects the most informative tests, as many as a model has room for.
//!
//! The first half of them fill the space: each is the test that is farthest from all chosen tests (the k-centre
//! greedy of Gonzalez 1985). The others lie where passing turns into failing, on both sides in turn. Among the tests
//! of a verdict that have tests of the other verdict near by, each is the test farthest from the chosen tests of its
//! verdict. So the first hundred tests, to which lengths are fitted, represent the whole space. If a search has put
//! all its tests at the edge of failing, a process would otherwise see noise or very short lengths.

use super::process::Kernel;

/// The greatest number of tests of one verdict to look at, evenly chosen from first to last: more would take too
/// long.
const MOST_OF_A_VERDICT: usize = 2048;

/// Chooses the most informative tests, at most `most`, by the kernel's distance, and returns the indices of the tests.
pub(super) fn telling(kernel: &Kernel, places: &[&[f64]], failed: &[bool], most: usize) -> Vec<usize> {
    let distance = |a: usize, b: usize| kernel.scaled_distance(places[a], places[b]);
    let sides = [true, false].map(|side| thinned((0..places.len()).filter(|&i| failed[i] == side).collect()));
    // Each side offers about twice as many close tests as are taken from it.
    let close = |side: &[usize], others: &[usize]| {
        let nearest = |i: usize| others.iter().map(|&j| distance(i, j)).min_by(f64::total_cmp);
        let mut close: Vec<(f64, usize)> = side.iter().filter_map(|&i| Some((nearest(i)?, i))).collect();
        close.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Spread::new(close.into_iter().take(most.div_ceil(2)).map(|(_, i)| i).collect())
    };
    let mut all = sides.concat();
    all.sort_unstable();
    let most = most.min(all.len());
    let mut turns = [close(&sides[0], &sides[1]), close(&sides[1], &sides[0]), Spread::new(all)];
    let mut chosen: Vec<usize> = Vec::with_capacity(most);
    while chosen.len() < most {
        let turn = if chosen.len() < most.div_ceil(2) { 2 } else { chosen.len() % 2 };
        let Some(next) = turns[turn].farthest().or_else(|| turns[2].farthest()) else { break };
        // At the boundary, tests of the other verdict do not count as neighbours.
        turns[usize::from(!failed[next])].take(next, distance);
        turns[2].take(next, distance);
        chosen.push(next);
    }
    chosen
}

/// An even selection of at most `MOST_OF_A_VERDICT` of the tests.
fn thinned(all: Vec<usize>) -> Vec<usize> {
    let kept = all.len().min(MOST_OF_A_VERDICT);
    (0..kept).map(|i| all[i * all.len() / kept]).collect()
}

/// Tests with their distances to the nearest test that was taken.
struct Spread {
    tests: Vec<usize>,
    distances: Vec<f64>,
}

impl Spread {
    fn new(tests: Vec<usize>) -> Self {
        Self { distances: vec![f64::INFINITY; tests.len()], tests }
    }

    /// The test farthest from all tests that were taken, and not one of them; the first among equals.
    fn farthest(&self) -> Option<usize> {
        let (tests, distances) = (&self.tests, &self.distances);
        let best = (0..tests.len()).rev().max_by(|&a, &b| distances[a].total_cmp(&distances[b]))?;
        (distances[best] >= 0.0).then(|| tests[best])
    }

    fn take(&mut self, test: usize, distance: impl Fn(usize, usize) -> f64) {
        for (&other, nearest) in self.tests.iter().zip(&mut self.distances) {
            // A negative distance marks a test that was taken.
            *nearest = if other == test { -1.0 } else { nearest.min(distance(test, other)) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::cube::Axis;
    use super::super::fit::prior;
    use super::*;

    fn grid(side: usize) -> Vec<Vec<f64>> {
        let at = |i: usize| (i as f64 + 0.5) / side as f64;
        (0..side * side).map(|i| vec![at(i % side), at(i / side)]).collect()
    }

    fn chosen(places: &[Vec<f64>], fails: impl Fn(&[f64]) -> bool, most: usize) -> Vec<usize> {
        let kernel = prior(&[Axis::Continuous; 2]);
        let views: Vec<&[f64]> = places.iter().map(Vec::as_slice).collect();
        let failed: Vec<bool> = views.iter().map(|at| fails(at)).collect();
        telling(&kernel, &views, &failed, most)
    }

    #[test]
    fn half_lie_at_the_boundary_and_no_place_is_far_from_a_chosen_one() {
        let places = grid(40);
        let chosen = chosen(&places, |at| at[0] < 0.4, 80);
        let mut once = chosen.clone();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), 80);
        let close = chosen.iter().filter(|&&i| (places[i][0] - 0.4).abs() < 0.06).count();
        assert!(close >= 40, "{close}");
        for at in &places {
            let to = |i: usize| (at[0] - places[i][0]).abs().max((at[1] - places[i][1]).abs());
            let nearest = chosen.iter().map(|&i| to(i)).min_by(f64::total_cmp).unwrap();
            assert!(nearest < 0.16, "{at:?} {nearest}");
        }
    }

    #[test]
    fn of_few_tests_all_are_chosen_and_rare_failures_are_never_lost() {
        let places = grid(8);
        let mut all = chosen(&places, |at| at[1] > 0.6, 100);
        all.sort_unstable();
        assert_eq!(all, (0..64).collect::<Vec<_>>());
        let places = grid(80);
        let chosen = chosen(&places, |at| at[0] < 0.02 && at[1] > 0.97, 60);
        assert!(chosen.iter().any(|&i| places[i][0] < 0.02 && places[i][1] > 0.97));
    }
}
