//! Leaves out the tests that break a constraint on continuous parameters.
//!
//! Constraints on discrete parameters are part of the rows that strategies make. A constraint on continuous parameters
//! cuts the cube in a way that no strategy knows. So the strategy proposes tests of the whole cube, and the tests that break
//! a constraint are left out. The strategy proposes more tests than the budget for this reason.
//!
//! A row of discrete values must not vanish, because a covering array needs each of its rows. So if a row has no test yet
//! and its test is left out, the row gets other continuous values, which are drawn at random until the test keeps the
//! constraints.

use crate::seeded::{Purpose, seeded};
use crate::{Generator, GeneratorError, Request, Strategy};
use paracosm_space::{Point, Space};
use rand::Rng;
use std::collections::BTreeSet;

/// The number of proposals in a row that may break a constraint before the strategy counts as exhausted.
const MOST_REFUSED: usize = 10_000;
/// At least one of so many tests has to keep the constraints.
const LEAST_SHARE: usize = 100;
/// The number of tests for an estimate of the share of tests that keep the constraints.
const PROBES: usize = 2048;
/// The factor by which a strategy proposes more tests than the estimated share demands, as a fraction.
const RESERVE: [usize; 2] = [11, 10];
/// The greatest number of draws for the continuous values of a row.
const MOST_DRAWS: usize = 10_000;

/// A generator that leaves out the tests that break a constraint.
struct Keeping {
    inner: Box<dyn Generator>,
    space: Space,
    /// The rows that have a test; `None` if the strategy has no rows.
    rows: Option<BTreeSet<Vec<usize>>>,
    seed: u64,
    drawn: u64,
}

/// The share of the tests of a space that keep its constraints, estimated with points of the Halton sequence.
#[derive(Debug, Clone, PartialEq)]
struct Share {
    valid: usize,
    probes: usize,
    /// The text of a constraint that tests break; `None` if all probes keep all constraints.
    broken: Option<String>,
}

/// Makes a generator with `build`, and leaves out the tests that break a constraint of the space.
pub(crate) fn keeping(
    strategy: Strategy,
    request: &Request,
    build: impl Fn(&Request) -> Result<Box<dyn Generator>, GeneratorError>,
) -> Result<Box<dyn Generator>, GeneratorError> {
    if !request.space.checks_each_test() {
        return build(request);
    }
    // What is wrong with the request itself is said first.
    build(request)?;
    let share = Share::of(request)?;
    let least = share.probes.div_ceil(LEAST_SHARE);
    if share.valid < least {
        let Share { valid, probes, broken } = share;
        return Err(GeneratorError::Rare { valid, probes, constraint: broken.unwrap_or_default() });
    }
    if request.epsilon.is_some() && strategy.goes_on() {
        // A search for an epsilon knows the valid part.
        return build(request);
    }
    // Some of the proposed tests are left out.
    let most = request.budget.saturating_mul(share.probes) / share.valid;
    let inner = build(&Request { budget: (most / RESERVE[1]).saturating_mul(RESERVE[0]).max(most) + 1, ..*request })?;
    let rows = strategy.has_rows(request) && request.space.dims() > 0 && !request.space.levels().is_empty();
    let (space, seed) = (request.space.clone(), request.seed.unwrap_or(0));
    Ok(Box::new(Keeping { inner, space, rows: rows.then(BTreeSet::new), seed, drawn: 0 }))
}

impl Share {
    fn of(request: &Request) -> Result<Self, GeneratorError> {
        let space = request.space;
        let points = match Strategy::HALTON.unchecked_independent(&Request::new(space, PROBES)) {
            Ok(mut halton) => halton.ask(PROBES),
            Err(GeneratorError::RandomUnderConstraints) => {
                Strategy::HALTON.unchecked(&Request::new(space, PROBES))?.ask(PROBES)
            }
            Err(error) => return Err(error),
        };
        let refused = |point: &&Point| !space.allows(point);
        let broken = points.iter().find(refused).and_then(|point| {
            let constraint = space.constraints().iter().find(|constraint| !constraint.allows(point))?;
            Some(constraint.text().to_owned())
        });
        let valid = points.len() - points.iter().filter(refused).count();
        Ok(Self { valid, probes: points.len(), broken })
    }
}

impl Keeping {
    /// Returns a test of the same row that keeps the constraints; `None` if none was found.
    fn redrawn(&mut self, refused: &Point) -> Option<Point> {
        let mut rng = seeded(self.seed, Purpose::Redraws, self.drawn);
        self.drawn += 1;
        (0..MOST_DRAWS).find_map(|_| {
            let continuous = refused.continuous.iter().map(|_| rng.random()).collect();
            Some(Point { continuous, discrete: refused.discrete.clone() }).filter(|point| self.space.allows(point))
        })
    }
}

impl Generator for Keeping {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let mut kept = Vec::new();
        let mut refused = 0;
        while kept.len() < n && refused < MOST_REFUSED {
            let proposed = self.inner.ask(n - kept.len());
            if proposed.is_empty() {
                break;
            }
            let mut bad = Vec::new();
            for point in proposed {
                let is_new = self.rows.as_mut().is_some_and(|rows| rows.insert(point.discrete.clone()));
                if self.space.allows(&point) {
                    refused = 0;
                    kept.push(point);
                    continue;
                }
                refused += 1;
                if is_new && let Some(other) = self.redrawn(&point) {
                    kept.push(other);
                }
                bad.push(point);
            }
            // An adaptive strategy has to know that no result of these tests will come.
            self.inner.tell(&bad, &vec![None; bad.len()]);
        }
        kept
    }

    fn tell(&mut self, tests: &[Point], robustness: &[Option<f64>]) {
        self.inner.tell(tests, robustness);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_coverage::Deadline;
    use paracosm_coverage::kwise_dispersion::row_dispersion;
    use paracosm_coverage::valid::Validity;
    use paracosm_space::{Domain, Parameter};
    use proptest::prelude::{prop_assert, proptest};

    fn space(constraints: &[&str]) -> Space {
        let interval = |name: &str| Parameter::new(name, Domain::Interval { lo: 0.0, hi: 1.0 });
        let choice = |name: &str| Parameter::new(name, Domain::Choice([1, 2, 3].map(Into::into).into()));
        let parameters = vec![interval("x"), choice("a"), interval("y"), choice("b"), choice("c")];
        Space::new(parameters).unwrap().with_constraints(constraints).unwrap()
    }

    #[test]
    fn each_row_of_a_covering_array_keeps_a_test() {
        let free = space(&[]);
        let bound = space(&["x + y < 0.1 * a"]);
        let rows = |space: &Space| {
            let mut tests = Strategy::HALTON.build(&Request::new(space, 9)).unwrap();
            let tests = tests.ask(9);
            assert!(tests.iter().all(|test| space.allows(test)));
            tests.into_iter().map(|test| test.discrete).collect::<BTreeSet<_>>()
        };
        assert_eq!(rows(&free).len(), 9);
        assert_eq!(rows(&free), rows(&bound));
    }

    #[test]
    fn a_combination_that_no_continuous_value_allows_is_left_out_of_the_rows() {
        let space = space(&["a == 3 implies x > 2", "x < 0.5 or b == 1"]);
        let mut tests = Strategy::HALTON.build(&Request::new(&space, 60)).unwrap();
        let tests = tests.ask(60);
        assert!(tests.len() == 60 && tests.iter().all(|test| test.discrete[0] != 2 && space.allows(test)));
    }

    #[test]
    fn a_search_for_an_epsilon_reaches_it_in_the_valid_part_of_each_row() {
        let space = space(&["x + y < 0.3 * a", "x * y <= 0.2 or a == 1"]);
        let rules = space.rules().unwrap();
        let validity = Validity::of(&space, &rules).unwrap();
        let epsilon = 0.25;
        for strategy in [Strategy::HALTON, Strategy::GREEDY] {
            let request = Request { k: Some(1), epsilon: Some(epsilon), ..Request::new(&space, 400) };
            let tests = strategy.build(&request).unwrap().ask(400);
            assert!(tests.iter().all(|test| space.allows(test)));
            let found = row_dispersion(2, Some(&validity), &tests, Deadline::never());
            assert!(found.upper <= epsilon && tests.len() < 60, "{strategy}: {found:?} of {} tests", tests.len());
        }
    }

    #[test]
    fn a_space_with_hardly_any_valid_test_is_refused_with_the_constraint() {
        let space = space(&["x * y > 0.999"]);
        let error = Strategy::HALTON.build(&Request::new(&space, 9)).err().unwrap();
        let expected = GeneratorError::Rare { valid: 0, probes: PROBES, constraint: "x * y > 0.999".to_owned() };
        assert_eq!(error, expected);
    }

    proptest! {
        #[test]
        fn every_strategy_proposes_valid_tests_only(index in 0..Strategy::all().count(), seed in 0..100u64) {
            let strategy = Strategy::all().nth(index).unwrap();
            let space = Space::unit_cube(2).with_constraints(["x1 + x2 < 1.2 and (x1 > 0.2 or x2 > 0.2)"]).unwrap();
            let request = Request { seed: Some(seed), ..Request::new(&space, 20) };
            let mut generator = strategy.build(&request).unwrap();
            for _ in 0..4 {
                let tests = generator.ask(5);
                prop_assert!(tests.iter().all(|test| space.allows(test)), "{strategy} {tests:?}");
                let robustness: Vec<_> = tests.iter().map(|test| Some(test.continuous[0])).collect();
                generator.tell(&tests, &robustness);
            }
        }
    }
}
