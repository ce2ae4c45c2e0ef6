//! Leaves out the tests that break a constraint on continuous parameters.
//!
//! Constraints on discrete parameters are part of the rows that strategies make. A constraint on continuous parameters
//! cuts the cube in a way that no strategy knows. So the strategy proposes tests of the whole cube, and the tests that break
//! a constraint are left out.
//!
//! - Points of rows, of sequences and of sets fill the shares of their rows (`rows`).
//! - A set that depends on its size is made in the size at which just the wanted number of its tests is valid (`sized`).
//! - A search for an epsilon knows the valid part ([`Spread`](crate::spread::Spread)).
//! - A search for failures moves its proposals into the valid part (`moved`).
//! - All other strategies propose more tests than the budget, and lose those that break a constraint.

mod moved;
mod rows;
mod sized;

pub(crate) use moved::Moved;
pub(crate) use rows::{RowPoints, ValidRows, roomy};

use crate::strategy::MethodKind;
use crate::{Aim, Generator, GeneratorError, Request, Strategy};
use paracosm_space::{Point, Space};
use sized::sized;
use std::collections::BTreeSet;

/// The number of proposals in a row that may break a constraint before the strategy counts as exhausted.
const MOST_REFUSED: usize = 10_000;
/// At least one of so many tests has to keep the constraints.
const LEAST_SHARE: usize = 100;
/// The number of tests for an estimate of the share of tests that keep the constraints.
const PROBES: usize = 2048;
/// The factor by which a strategy proposes more tests than the estimated share demands, as a fraction.
const RESERVE: [usize; 2] = [11, 10];
/// The greatest number of draws for the continuous values of a test.
const MOST_DRAWS: usize = 10_000;

/// A generator that leaves out the tests that break a constraint.
struct Keeping {
    inner: Box<dyn Generator>,
    space: Space,
    /// The tests to which the first test of a row moves; `None` if such a test is left out like any other.
    moved: Option<Moved>,
    rows: BTreeSet<Vec<usize>>,
    is_exhausted: bool,
}

/// A generator of the tests of a list.
struct Listed(std::vec::IntoIter<Point>);

/// The share of the tests of a space that keep its constraints, estimated with points of the Halton sequence.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Share {
    valid: usize,
    probes: usize,
    /// The text of a constraint that tests break; `None` if all probes keep all constraints.
    broken: Option<String>,
}

impl Strategy {
    /// Returns the strategy that takes the place of this one, because this one makes sets of the whole space and constraints on continuous
    /// parameters leave a part of the space; `None` if this strategy makes the tests itself.
    pub fn replacement(self, request: &Request) -> Option<Self> {
        // What is wrong with such a request, the strategy has to say itself.
        let is_plain =
            request.existing.is_empty() && request.skip.is_none() && request.epsilon.is_none() && request.aim.is_none();
        self.in_a_part().filter(|_| request.space.checks_each_test() && is_plain)
    }

    /// Builds the generator that [`Strategy::build`] promises.
    pub(crate) fn build_valid(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        // The tests of a file are checked as they are written, by whoever reads the file.
        if !request.space.checks_each_test() || self == Self::GIVEN {
            return self.unchecked(request);
        }
        if let Some(other) = self.replacement(request) {
            return other.build_valid(&row_by_row(other, request));
        }
        // What is wrong with the request itself is said first.
        let share = Share::of(request.space);
        let knows_the_share = share.as_ref().ok().filter(|share| !share.is_rare());
        let proposals = knows_the_share.map_or(request.budget, |share| share.proposals(request.budget));
        let places_rows = request.space.dims() > 0 && self.has_rows(request);
        let keeps_the_budget =
            request.space.dims() > 0 && (places_rows || self.is_adaptive()) || self.given().is_some();
        let budget = if keeps_the_budget { request.budget } else { proposals };
        let inner = self.assembled(&Request { budget, ..*request }, knows_the_share)?;
        share?.checked()?;
        // Holes between all parameters are holes in rows, too: a row that lost its test would look covered.
        let moves = self.fills_holes() && !request.space.levels().is_empty();
        Ok(if places_rows { inner } else { Keeping::of(inner, request.space, moves) })
    }

    /// Builds the generator that [`Strategy::build_independent`] promises.
    pub(crate) fn build_valid_independent(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        if !request.space.checks_each_test() {
            return self.unchecked_independent(request);
        }
        if let Some(other) = self.replacement(request) {
            return other.build_valid_independent(&row_by_row(other, request));
        }
        if request.space.levels().is_empty() || !self.has_rows(request) {
            return self.build_valid(request);
        }
        self.unchecked_independent(request)?;
        let share = Share::of(request.space)?.checked()?;
        let proposals = share.proposals(request.budget);
        if let MethodKind::Sets { .. } = self.kind() {
            let tests = sized(request.budget, proposals, |size| {
                let mut tests = self.unchecked_independent(&Request { budget: size, ..*request }).ok()?.ask(size);
                tests.retain(|test| request.space.allows(test));
                Some(tests)
            });
            return Ok(Box::new(Listed(tests.into_iter())));
        }
        let inner = self.unchecked_independent(&Request { budget: proposals, ..*request })?;
        Ok(Keeping::of(inner, request.space, false))
    }
}

/// Returns the request for a strategy that takes the place of sets. If the strategy fills holes, it fills the holes of each row.
fn row_by_row<'a>(strategy: Strategy, request: &Request<'a>) -> Request<'a> {
    Request { aim: strategy.fills_holes().then_some(Aim::Dispersion), ..*request }
}

impl Share {
    fn of(space: &Space) -> Result<Self, GeneratorError> {
        let points = match Strategy::HALTON.unchecked_independent(&Request::new(space, PROBES)) {
            Ok(mut halton) => halton.ask(PROBES),
            Err(GeneratorError::RandomUnderConstraints) => {
                Strategy::HALTON.unchecked(&Request::new(space, PROBES))?.ask(PROBES)
            }
            Err(error) => return Err(error),
        };
        let refused = |point: &&Point| !space.allows(point);
        let broken = points.iter().find_map(|point| space.broken(point)).map(|constraint| constraint.text().to_owned());
        let valid = points.len() - points.iter().filter(refused).count();
        Ok(Self { valid, probes: points.len(), broken })
    }

    fn is_rare(&self) -> bool {
        self.valid < self.probes.div_ceil(LEAST_SHARE)
    }

    fn checked(self) -> Result<Self, GeneratorError> {
        if !self.is_rare() {
            return Ok(self);
        }
        let Self { valid, probes, broken } = self;
        Err(GeneratorError::Rare { valid, probes, constraint: broken.unwrap_or_default() })
    }

    /// Returns the number of tests to propose, so that a budget of them probably keeps the constraints.
    fn proposals(&self, budget: usize) -> usize {
        let most = budget.saturating_mul(self.probes) / self.valid.max(1);
        (most / RESERVE[1]).saturating_mul(RESERVE[0]).max(most).saturating_add(usize::from(budget > 0))
    }
}

impl Keeping {
    fn of(inner: Box<dyn Generator>, space: &Space, moves: bool) -> Box<dyn Generator> {
        let moved = if moves { Moved::new(space, |row| row) } else { None };
        Box::new(Self { inner, space: space.clone(), moved, rows: BTreeSet::new(), is_exhausted: false })
    }
}

impl Generator for Keeping {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let mut kept = Vec::new();
        let mut refused = 0;
        while kept.len() < n && !self.is_exhausted {
            let proposed = self.inner.ask(n - kept.len());
            if proposed.is_empty() {
                // A strategy may wait for the results of what it has proposed.
                self.is_exhausted = kept.is_empty();
                break;
            }
            let mut bad = Vec::new();
            for mut point in proposed {
                if let Some(moved) = self.moved.as_ref().filter(|_| !self.rows.contains(&point.discrete)) {
                    point = moved.moved(point);
                    self.rows.insert(point.discrete.clone());
                }
                if self.space.allows(&point) {
                    refused = 0;
                    kept.push(point);
                } else {
                    refused += 1;
                    bad.push(point);
                }
            }
            self.is_exhausted |= refused >= MOST_REFUSED;
            // An adaptive strategy has to know that no result of these tests will come.
            self.inner.tell(&bad, &vec![None; bad.len()]);
        }
        kept
    }

    fn tell(&mut self, tests: &[Point], robustness: &[Option<f64>]) {
        self.inner.tell(tests, robustness);
    }

    fn failure(&self) -> Option<String> {
        self.inner.failure()
    }
}

impl Generator for Listed {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        self.0.by_ref().take(n).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DiscreteFamily;
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
    fn every_row_gets_its_share_of_the_budget_whatever_part_of_it_is_valid() {
        let space = space(&["x + y < 0.1 * a"]);
        let open_loop =
            Strategy::all().filter(|strategy| !strategy.is_adaptive() && *strategy != Strategy::RANDOM_CORNERS);
        for strategy in open_loop {
            // Holes take long to find in rows with a small valid part.
            let budgets = if strategy.fills_holes() { &[9, 20][..] } else { &[1, 8, 9, 10, 40] };
            for &budget in budgets {
                let families = [DiscreteFamily::Ipog, DiscreteFamily::Random { delta: 0.05 }, DiscreteFamily::Cross];
                for discrete in families {
                    let aim = strategy.fills_holes().then_some(crate::Aim::Dispersion);
                    let request = Request { discrete, aim, ..Request::new(&space, budget) };
                    let mut generator = strategy.build(&request).unwrap();
                    // Portions do not matter.
                    let tests = [generator.ask(3), generator.ask(0), generator.ask(budget)].concat();
                    let tests = &tests[..budget];
                    assert!(tests.iter().all(|test| space.allows(test)), "{strategy} {discrete:?}");
                    if strategy.has_rows(&request) {
                        assert_eq!(generator.ask(1), [], "{strategy} {discrete:?}");
                        let mut again = strategy.build(&request).unwrap();
                        assert_eq!(again.ask(budget), tests, "{strategy} {discrete:?}");
                    }
                    if strategy.has_rows(&request) && discrete == DiscreteFamily::Cross && budget == 40 {
                        let first: BTreeSet<_> = tests[..27].iter().map(|test| &test.discrete).collect();
                        assert_eq!(first.len(), 27, "{strategy}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_set_of_a_fixed_size_is_cut_off_nowhere() {
        // Half of the square is valid, in every tenth of the first axis.
        let space = Space::unit_cube(2).with_constraints(["x2 < 0.5"]).unwrap();
        for strategy in
            [Strategy::HAMMERSLEY, Strategy::FIBONACCI, Strategy::LATTICE, Strategy::LHS, Strategy::LHS_CENTRED]
        {
            for seed in [None, Some(1), Some(2)] {
                let request = Request { seed, ..Request::new(&space, 100) };
                let tests = strategy.build(&request).unwrap().ask(100);
                let mut tenths = [0; 10];
                tests.iter().for_each(|test| tenths[(test.continuous[0] * 10.0) as usize] += 1);
                let even = if matches!(strategy.name(), "lhs" | "lhs-centred") { 4..=16 } else { 8..=12 };
                assert!(tests.len() == 100 && tenths.iter().all(|count| even.contains(count)), "{strategy} {tenths:?}");
            }
        }
    }

    #[test]
    fn a_row_without_a_valid_test_leaves_its_tests_to_the_others() {
        // Intervals do not show that `x - x` is 0.
        let space = space(&["a - 3 < x - x"]);
        for strategy in [Strategy::HALTON, Strategy::LHS] {
            let tests = strategy.build(&Request::new(&space, 20)).unwrap().ask(20);
            assert!(tests.len() == 20 && tests.iter().all(|test| test.discrete[0] < 2), "{strategy}");
        }
    }

    #[test]
    fn holes_between_all_parameters_leave_no_pair_of_levels_out() {
        let space = space(&["x + y < 0.1 * a"]);
        let tests = Strategy::GREEDY.build(&Request::new(&space, 30)).unwrap().ask(30);
        assert!(tests.len() == 30 && tests.iter().all(|test| space.allows(test)));
        for [a, b] in [[0, 1], [0, 2], [1, 2]] {
            let pairs: BTreeSet<_> = tests.iter().map(|test| (test.discrete[a], test.discrete[b])).collect();
            assert_eq!(pairs.len(), 9, "{a} {b}");
        }
    }

    #[test]
    fn a_search_gives_the_whole_budget_in_a_narrow_valid_part() {
        let narrow = ["abs(x - y) < 0.05 * a and x + y < 1.5"];
        for strategy in Strategy::all().filter(|strategy| strategy.is_adaptive()) {
            let space = space(&narrow);
            let mut generator = strategy.build(&Request::new(&space, 60)).unwrap();
            let mut tests = Vec::new();
            while tests.len() < 60 {
                let asked = generator.ask(10.min(60 - tests.len()));
                assert!(!asked.is_empty() && asked.iter().all(|test| space.allows(test)), "{strategy} {asked:?}");
                let robustness: Vec<_> = asked.iter().map(|test| Some(1.0 - test.continuous[0])).collect();
                generator.tell(&asked, &robustness);
                tests.extend(asked);
            }
            // The search reaches the far end of the valid part.
            let best = tests.iter().map(|test| test.continuous[0]).fold(0.0, f64::max);
            assert!(best > 0.75, "{strategy}: {best}");
        }
    }

    #[test]
    fn corners_remain_corners_and_end_where_no_corner_is_valid() {
        let corners = |constraint: &str| {
            let space = space(&[constraint]);
            Strategy::RANDOM_CORNERS.build(&Request::new(&space, 30)).unwrap().ask(30)
        };
        let is_end = |u: &f64| *u == 0.0 || *u > 0.999;
        let tests = corners("x + y < 0.4 * a");
        assert!(tests.len() == 30 && tests.iter().all(|test| test.continuous.iter().all(is_end)));
        assert_eq!(corners("x > 0.2 and x < 0.8"), []);
    }

    #[test]
    fn independent_discrete_values_stay_as_probable_as_their_valid_parts() {
        let space = space(&["x < 0.2 * a"]);
        for strategy in [Strategy::RANDOM, Strategy::HALTON, Strategy::LHS, Strategy::HAMMERSLEY] {
            let request = Request { seed: Some(3), ..Request::new(&space, 3000) };
            let tests = strategy.build_independent(&request).unwrap().ask(3000);
            assert!(tests.len() == 3000 && tests.iter().all(|test| space.allows(test)), "{strategy}");
            for (level, expected) in [500_i64, 1000, 1500].into_iter().enumerate() {
                let found = tests.iter().filter(|test| test.discrete[0] == level).count() as i64;
                assert!((found - expected).abs() < 120, "{strategy}: {found} of level {level}");
            }
        }
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
