//! As many points for every discrete row as it takes: sets that are (k, epsilon)-covering in the paper's sense.
//!
//! Section 3.1 asks of every row that its own continuous points leave no empty box above epsilon. How many points that
//! takes no bound tells, so it is measured: every row has a copy of the sequence of its own, randomly shifted but for the
//! first, and the largest empty box of its points at hand. The next test goes to the row with the largest hole. It ends
//! when none is above epsilon; cut short earlier, by the number of tests or by the clock, it has spread the tests so that
//! the worst row is as good as it can be.

use crate::seeded::mix;
use crate::{Generator, GeneratorError, Request, Strategy};
use paracosm_coverage::dispersion::is_at_most;
use paracosm_coverage::{Deadline, Point, PointSet, Space, empty_boxes::EmptyBoxes};

/// How much memory the boxes of all rows take together, in bytes.
const MOST_MEMORY: usize = 200_000_000;

/// How many faces may have to be looked at when a point splits all boxes: a box has `2d` parts with `2d` faces each.
const MOST_FACES: usize = 500_000_000;

/// A row with the points that it has so far.
struct Row {
    discrete: Vec<usize>,
    more: Box<dyn Generator>,
    points: Vec<Vec<f64>>,
    holes: EmptyBoxes,
    /// With how many points it is looked again whether they are enough, where the holes do not tell.
    look_at: usize,
    enough: bool,
}

/// Tests that go where the largest hole is, until none is above epsilon.
pub(crate) struct Spread {
    rows: Vec<Row>,
    epsilon: f64,
    deadline: Deadline,
}

impl Spread {
    /// Points of `strategy` for these rows; those that `existing` tests have count.
    ///
    /// # Errors
    /// Epsilon is not in (0, 1), or the strategy makes sets of a size that has to be known beforehand.
    pub(crate) fn new(
        strategy: Strategy,
        request: &Request,
        rows: impl Iterator<Item = Vec<usize>>,
        epsilon: f64,
    ) -> Result<Self, GeneratorError> {
        if !(epsilon > 0.0 && epsilon < 1.0) {
            return Err(GeneratorError::Epsilon(epsilon));
        }
        if !strategy.goes_on() {
            return Err(GeneratorError::Sized { strategy: strategy.name() });
        }
        let cube = Space::unit_cube(request.space.dims());
        let rows: Vec<Vec<usize>> = rows.collect();
        let dims = cube.dims();
        let in_memory = MOST_MEMORY / (24 * dims + 8) / rows.len().max(1);
        let most = in_memory.min(MOST_FACES / (2 * dims).saturating_mul(2 * dims).max(1)).max(100);
        let row = |(number, discrete): (usize, Vec<usize>)| {
            let of_row = request.existing.iter().filter(|test| test.discrete == discrete);
            let existing: Vec<Point> =
                of_row.map(|test| Point { continuous: test.continuous.clone(), discrete: Vec::new() }).collect();
            let seed = match number {
                0 => request.seed,
                _ => Some(mix(request.seed.unwrap_or(0) ^ mix(number as u64))),
            };
            let looks = strategy == Strategy::Greedy;
            let more = strategy.build(&Request {
                seed,
                skip: request.skip,
                existing: if looks { &existing } else { &[] },
                ..Request::new(&cube, request.budget)
            })?;
            let holes = EmptyBoxes::at_most(cube.dims(), most).expect("there is an axis");
            let mut row = Row { discrete, more, points: Vec::new(), holes, look_at: 1, enough: false };
            existing.into_iter().for_each(|point| row.add(point.continuous, epsilon, request.deadline));
            Ok(row)
        };
        let rows = rows.into_iter().enumerate().map(row).collect::<Result<_, GeneratorError>>()?;
        Ok(Self { rows, epsilon, deadline: request.deadline })
    }
}

impl Row {
    fn add(&mut self, point: Vec<f64>, epsilon: f64, deadline: Deadline) {
        self.holes.add(&point).expect("a point of the cube");
        self.points.push(point);
        let hole = self.holes.dispersion();
        self.enough = hole.upper <= epsilon;
        if !self.enough && hole.lower <= epsilon && self.points.len() >= self.look_at {
            // Boxes were forgotten that may be larger: search.
            let points = PointSet::new(self.points[0].len(), &self.points).expect("points of the cube");
            self.enough = is_at_most(&points, epsilon, deadline) == Some(true);
            self.look_at = self.points.len() + self.points.len().div_ceil(20);
        }
    }
}

impl Generator for Spread {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let mut tests = Vec::new();
        while tests.len() < n && !self.deadline.passed() {
            let open = self.rows.iter_mut().filter(|row| !row.enough);
            let hole = |row: &Row| row.holes.largest().volume();
            // Of rows alike the one with the fewest points, then the first.
            let worst = open.min_by(|a, b| hole(b).total_cmp(&hole(a)).then(a.points.len().cmp(&b.points.len())));
            let Some(row) = worst else { break };
            let Some(point) = row.more.ask(1).pop() else { break };
            row.add(point.continuous.clone(), self.epsilon, self.deadline);
            tests.push(Point { continuous: point.continuous, discrete: row.discrete.clone() });
        }
        tests
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_coverage::dispersion::dispersion;

    fn space() -> Space {
        let text = "parameter = [{ name = \"x\", interval = [0, 1] }, { name = \"a\", choice = [1, 2, 3] },
            { name = \"y\", interval = [0, 1] }, { name = \"b\", choice = [1, 2] }, { name = \"c\", choice = [1, 2] }]";
        Space::from_toml(text).unwrap()
    }

    fn worst_row(tests: &[Point]) -> f64 {
        let rows: std::collections::BTreeSet<&Vec<usize>> = tests.iter().map(|test| &test.discrete).collect();
        let of_row = |row: &&Vec<usize>| {
            let points = tests.iter().filter(|test| test.discrete == **row).map(|test| &test.continuous);
            dispersion(&PointSet::new(2, points).unwrap(), Deadline::never()).volume.lower
        };
        rows.iter().map(of_row).fold(0.0, f64::max)
    }

    #[test]
    fn every_row_gets_as_many_points_as_it_takes_and_no_more() {
        let space = space();
        for strategy in [Strategy::Halton, Strategy::Sobol, Strategy::Greedy, Strategy::Random] {
            let request = Request { epsilon: Some(0.1), ..Request::new(&space, 500) };
            let tests = strategy.build(&request).unwrap().ask(100_000);
            assert!(tests.len() < 1000, "{strategy}: {}", tests.len());
            assert!(worst_row(&tests) <= 0.1, "{strategy}");
            assert!(worst_row(&tests[..tests.len() - 1]) > 0.1, "{strategy}: the last test was needed");
        }
    }

    #[test]
    fn cut_short_the_worst_row_is_better_than_with_equal_shares() {
        let space = space();
        for strategy in [Strategy::Halton, Strategy::Random] {
            let spread = Request { epsilon: Some(0.001), seed: Some(1), ..Request::new(&space, 180) };
            let equal = Request { epsilon: None, ..spread };
            let of = |request: &Request| worst_row(&strategy.build(request).unwrap().ask(180));
            assert!(of(&spread) < of(&equal), "{strategy}");
        }
    }

    #[test]
    fn points_that_are_there_count() {
        let space = space();
        let request = Request { epsilon: Some(0.1), ..Request::new(&space, 500) };
        let all = Strategy::Greedy.build(&request).unwrap().ask(100_000);
        let existing = &all[..all.len() - 5];
        let more = Strategy::Greedy.build(&Request { existing, ..request }).unwrap().ask(100_000);
        assert!((1..20).contains(&more.len()), "{}", more.len());
        assert!(worst_row(&[existing, &more].concat()) <= 0.1);
    }
}
