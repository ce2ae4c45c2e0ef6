//! Joins points with discrete values that are drawn for each test separately, so that strategies can be compared by
//! their points alone.
//!
//! Over a family of rows a strategy is two things at once: a way to place points, and a family. Its results then
//! depend on the rows as well. A covering array of any two parameters misses most combinations of three parameters,
//! and a failure that needs one of them is out of reach, however the points are placed. Rows that are drawn
//! uniformly, one for each test, favour no strategy. Random points with such rows are a uniform distribution over all
//! valid tests.

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

/// Random rows without repetitions, for a space without continuous parameters.
struct Once {
    rows: Rows,
    seen: BTreeSet<Vec<usize>>,
    /// The number of rows that satisfy the constraints.
    valid: f64,
}

/// Random rows among those that satisfy the constraints.
struct Rows {
    tests: UniformTests,
    seed: u64,
    drawn: u64,
}

impl Strategy {
    /// Builds a generator of tests by this strategy, with independent random discrete values for each test. The
    /// discrete values are drawn uniformly among the valid rows, instead of taking the rows of a family in turn.
    /// Without continuous parameters no test comes twice, and the generator ends when all tests have come. Strategies
    /// that choose all values together do so here too.
    ///
    /// # Errors
    /// As [`Strategy::build`]; also if the constraints join too many parameters for random rows.
    pub fn build_independent(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        self.build_valid_independent(request)
    }

    /// Builds the generator, which may propose tests that break a constraint on continuous parameters.
    pub(crate) fn unchecked_independent(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        let levels = request.space.levels();
        if levels.is_empty() || !self.has_rows(request) {
            return self.unchecked(request);
        }
        // This finds what is wrong with the request. The one row is not used.
        let row = [vec![0; levels.len()]];
        let points = self.unchecked(&Request { rows: Some(&row), ..*request })?;
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
