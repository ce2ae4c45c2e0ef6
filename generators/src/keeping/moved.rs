//! Moves a test that breaks a constraint to a valid test near it.
//!
//! A search for failures learns from the results of its proposals. If many proposals got no result, a search would stand
//! still. So each proposal moves towards the nearest of some known valid tests, up to the edge of the valid part.

use super::PROBES;
use crate::seeded::{Purpose, seeded};
use crate::sequence::{Halton, Sequence};
use paracosm_space::{Point, Space};
use rand::Rng;

/// The number of known valid places.
const KNOWN: usize = 256;
/// The number of halvings of the way to a valid test: what is left of the way is below a millionth.
const HALVINGS: usize = 20;

/// The valid tests to which other tests move.
pub(crate) struct Moved {
    space: Space,
    /// The continuous coordinates of valid tests.
    places: Vec<Vec<f64>>,
    /// The discrete coordinates of valid tests.
    rows: Vec<Vec<usize>>,
}

impl Moved {
    /// Finds valid tests of a space; `None` if no constraint depends on continuous parameters. `row` makes a row that keeps the
    /// constraints on discrete parameters of any row.
    pub(crate) fn new(space: &Space, row: impl Fn(Vec<usize>) -> Vec<usize>) -> Option<Self> {
        if !space.checks_each_test() || space.dims() == 0 {
            return None;
        }
        let halton = Halton::new(space.dims(), None);
        let levels = space.levels();
        let mut rng = seeded(0, Purpose::Redraws, 0);
        let (mut places, mut rows) = (Vec::new(), Vec::new());
        for index in 1..=16 * PROBES as u64 {
            let discrete = row(levels.iter().map(|&levels| rng.random_range(0..levels)).collect());
            let test = Point { continuous: halton.point(index), discrete };
            if space.allows(&test) {
                places.push(test.continuous);
                rows.push(test.discrete);
                if places.len() == KNOWN {
                    break;
                }
            }
        }
        Some(Self { space: space.clone(), places, rows })
    }

    /// Returns the test itself if it is valid, and otherwise a valid test near it. The discrete values change only if no valid
    /// test with them is found. If there is no known valid test, the test stays as it is.
    pub(crate) fn moved(&self, test: Point) -> Point {
        if self.space.allows(&test) {
            return test;
        }
        let distance =
            |place: &[f64]| -> f64 { place.iter().zip(&test.continuous).map(|(a, b)| (a - b) * (a - b)).sum() };
        let mut nearest: Vec<usize> = (0..self.places.len()).collect();
        nearest.sort_by(|&a, &b| distance(&self.places[a]).total_cmp(&distance(&self.places[b])));
        let with = |continuous: Vec<f64>| Point { continuous, discrete: test.discrete.clone() };
        let is_valid = |test: &Point| self.space.allows(test);
        let known = nearest.iter().map(|&index| with(self.places[index].clone())).find(is_valid);
        let target = known.or_else(|| {
            let mut rng = seeded(0, Purpose::Redraws, 1);
            let drawn = (0..PROBES).map(|_| with(test.continuous.iter().map(|_| rng.random()).collect()));
            drawn.filter(is_valid).min_by(|a, b| distance(&a.continuous).total_cmp(&distance(&b.continuous)))
        });
        let target = target.or_else(|| {
            let &index = nearest.first()?;
            Some(Point { continuous: self.places[index].clone(), discrete: self.rows[index].clone() })
        });
        target.map_or_else(|| test.clone(), |target| self.towards(&test.continuous, target))
    }

    /// Returns the valid test between a place and a valid test that is as near to the place as halvings find.
    fn towards(&self, from: &[f64], target: Point) -> Point {
        let along = |share: f64| {
            let ends = from.iter().zip(&target.continuous);
            ends.map(|(&a, &b)| (a + (b - a) * share).clamp(a.min(b), a.max(b))).collect::<Vec<f64>>()
        };
        let (mut outside, mut inside) = (0.0, 1.0);
        let mut found = target.clone();
        for _ in 0..HALVINGS {
            let middle = 0.5 * (outside + inside);
            let test = Point { continuous: along(middle), discrete: target.discrete.clone() };
            if self.space.allows(&test) {
                (inside, found) = (middle, test);
            } else {
                outside = middle;
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space(constraint: &str) -> Space {
        let text = format!(
            "constraints = [\"{constraint}\"]\nparameter = [{{ name = \"x\", interval = [0, 1] }}, \
             {{ name = \"y\", interval = [0, 1] }}, {{ name = \"a\", choice = [1, 2, 3] }}]"
        );
        Space::from_toml(&text).unwrap()
    }

    fn test(x: f64, y: f64, level: usize) -> Point {
        Point { continuous: vec![x, y], discrete: vec![level] }
    }

    #[test]
    fn an_invalid_test_moves_to_the_edge_of_the_valid_part() {
        let space = space("x + y < 0.4 * a");
        let moved = Moved::new(&space, |row| row).unwrap();
        assert_eq!(moved.moved(test(0.1, 0.2, 0)), test(0.1, 0.2, 0));
        for level in 0..3 {
            let found = moved.moved(test(0.9, 0.9, level));
            let sum = found.continuous[0] + found.continuous[1];
            let most = 0.4 * (level + 1) as f64;
            assert!(space.allows(&found) && found.discrete == [level] && most - sum < 1e-3, "{found:?}");
        }
    }

    #[test]
    fn discrete_values_without_a_valid_test_change() {
        let space = space("a - 3 < x - x and x < 0.5");
        let found = Moved::new(&space, |row| row).unwrap().moved(test(0.9, 0.9, 2));
        assert!(space.allows(&found) && found.discrete[0] < 2, "{found:?}");
    }

    #[test]
    fn a_space_whose_levels_decide_the_constraints_moves_nothing() {
        assert!(Moved::new(&space("a < 3"), |row| row).is_none());
    }
}
