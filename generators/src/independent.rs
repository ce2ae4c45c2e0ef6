//! Points joined with discrete values that every test draws for itself: what strategies are when they are held against each
//! other by chance.
//!
//! Over a family of rows a strategy is two things at once, a way to place points and a family. What it finds then says as
//! much of the rows: a covering array of any two parameters has most combinations of three of them in no row, and whatever
//! fails only with one of those is out of reach, however the points are placed. Rows that are drawn uniformly, one for each
//! test, take no side. Random points with such rows are what a uniform distribution over all valid tests gives.

use crate::seeded::{Purpose, seeded};
use crate::{Generator, GeneratorError, Request, Strategy};
use paracosm_space::Point;
use paracosm_space::rules::UniformTests;
use rand::Rng;
use std::collections::BTreeSet;

/// The points of one set or sequence, each with a random row.
struct Independent {
    points: Box<dyn Generator>,
    rows: Rows,
}

/// In a space without continuous parameters, random rows none of which comes twice.
struct Once {
    rows: Rows,
    seen: BTreeSet<Vec<usize>>,
    /// How many keep the constraints.
    valid: f64,
}

/// Random rows among those that keep the constraints.
struct Rows {
    tests: UniformTests,
    seed: u64,
    drawn: u64,
}

impl Strategy {
    /// A generator of this strategy whose tests draw their discrete values uniformly among the valid ones, each for itself,
    /// rather than take the rows of a family in turn. Without continuous parameters no test comes twice, and it ends when
    /// all have come. Strategies that choose values of both kinds together do that here too.
    ///
    /// # Errors
    /// As [`Strategy::build`], and where constraints are too entangled for random rows.
    pub fn build_independent(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        let levels = request.space.levels();
        if levels.is_empty() || !self.has_rows(request) {
            return self.build(request);
        }
        // What is wrong with the request is found here, and the one row is not used.
        let row = [vec![0; levels.len()]];
        let points = self.build(&Request { rows: Some(&row), ..*request })?;
        let rules = request.space.rules()?;
        let (tests, valid) = rules.uniform().zip(rules.tests()).ok_or(GeneratorError::RandomUnderConstraints)?;
        let rows = Rows { tests, seed: request.seed.unwrap_or(0), drawn: 0 };
        Ok(match request.space.dims() {
            0 => Box::new(Once { rows, seen: BTreeSet::new(), valid }),
            _ => Box::new(Independent { points, rows }),
        })
    }
}

impl Rows {
    fn draw(&mut self) -> Vec<usize> {
        let mut rng = seeded(self.seed, Purpose::Rows, self.drawn);
        self.drawn += 1;
        self.tests.draw(|levels| rng.random_range(0..levels))
    }
}

impl Generator for Independent {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let points = self.points.ask(n).into_iter();
        points.map(|point| Point { discrete: self.rows.draw(), ..point }).collect()
    }
}

impl Generator for Once {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let mut tests = Vec::new();
        while tests.len() < n && (self.seen.len() as f64) < self.valid {
            let discrete = self.rows.draw();
            if self.seen.insert(discrete.clone()) {
                tests.push(Point { continuous: Vec::new(), discrete });
            }
        }
        tests
    }
}
