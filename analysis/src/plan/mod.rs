//! Computes before any run how many tests a guarantee needs. `paracosm-cover plan` prints the result.
//!
//! A proved bound, a probability and a measurement are different kinds of knowledge, and every number here states its
//! kind. A number for rows and a number for points are only joined into a number that claims no more than either of
//! them.

mod measured;

use measured::{MOST_MEASURED, made, measured, valid_points_needed};
use paracosm_campaign::{Error, Reason};
use paracosm_coverage::Deadline;
use paracosm_coverage::dispersion::is_at_most;
use paracosm_coverage::theory::points;
use paracosm_coverage::theory::rows::RandomRows;
use paracosm_coverage::valid::Validity;
use paracosm_generators::covering::{CoveringError, CoveringRequest, covering_array};
use paracosm_generators::{GeneratorError, Request, Strategy};
use paracosm_space::Space;
use paracosm_space::demand::Demand;
use serde::{Serialize, Serializer};
use std::time::Duration;
use thiserror::Error;

/// The kind of guarantee that a number of tests gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Guarantee {
    /// A proof shows that every set with fewer tests is too small.
    NeededByAny,
    /// A proof shows that this set of tests suffices.
    Proved,
    /// A proof shows that this number of random tests suffices with at least the given probability.
    Probable,
    /// A measurement shows that this number of tests of this strategy suffices, and that one test fewer does not.
    Measured,
    /// The number is computed from measured numbers, but was not itself measured.
    Estimated,
}

impl Guarantee {
    /// Returns the guarantee in the words in which programs print the guarantee.
    pub fn words(self) -> &'static str {
        match self {
            Self::NeededByAny => "needed by any set",
            Self::Proved => "proved for this set",
            Self::Probable => "with probability 1-delta",
            Self::Measured => "measured",
            Self::Estimated => "estimated from measured",
        }
    }
}

impl Serialize for Guarantee {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.words())
    }
}

/// A number of tests with its guarantee.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Need {
    /// A description of the tests that the number counts.
    pub of: String,
    /// The strategy that proposes the tests; `None` if no strategy proposes the tests.
    #[serde(skip)]
    pub strategy: Option<Strategy>,
    /// The number of tests; `None` if the number exceeds 64 bits or could not be measured in time.
    pub tests: Option<u64>,
    /// A number of tests that is not enough, known from a measurement that ran out of time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over: Option<u64>,
    /// The kind of guarantee that the number has.
    pub guarantee: Guarantee,
}

/// The numbers of tests that a (k, epsilon)-covering set needs, each with its kind of guarantee.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// The number of discrete parameters in each combination to cover; `None` if the space has no discrete parameters.
    pub k: Option<usize>,
    /// The greatest allowed dispersion (volume of the largest empty box) of the tests with the same discrete values.
    pub epsilon: f64,
    /// The greatest allowed probability that a random set of tests fails to cover.
    pub delta: f64,
    /// The numbers of rows that cover the discrete parameters k-wise; `None` if the space has no discrete parameters.
    pub rows: Option<Vec<Need>>,
    /// The numbers of points that leave no hole above epsilon; `None` if the space has no continuous parameters, or if rows of discrete values
    /// may have different valid parts.
    pub points: Option<Vec<Need>>,
    /// The numbers of tests that satisfy both k and epsilon, with separate points for each row; `None` if the space
    /// lacks discrete or continuous parameters. If constraints depend on continuous parameters, rows have different valid parts, and the number
    /// is that of tests that were made.
    pub tests: Option<Vec<Need>>,
}

/// A reason why the numbers of tests cannot be planned.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum PlanFlaw {
    /// The epsilon or the delta of the plan is not between 0 and 1.
    #[error("{name} is {found}, expected a number above 0 and below 1")]
    NoShare {
        /// The name of the number that is out of range, `epsilon` or `delta`.
        name: &'static str,
        /// The value of the number that is out of range.
        found: f64,
    },
    /// The space has no parameters for which tests could be planned.
    #[error("the space has no parameters, so there is nothing to plan")]
    Empty,
    /// The number `k` is given, but the space has no discrete parameters.
    #[error("--k is a number of discrete parameters, and the space has no discrete parameters: leave it out")]
    NoDiscrete,
}

impl Reason for PlanFlaw {}

/// The greatest number of combinations for which a covering array is made. More would take minutes and gigabytes.
const MOST_COMBINATIONS: u128 = 1 << 31;

impl Plan {
    /// Computes the numbers of tests that cover a space, with their kinds of guarantee. `demand` may ask for more than
    /// all combinations of k values of the discrete parameters. Making a covering array takes at most half of `limit`
    /// (all of it if there are no continuous parameters); the measurements take at most the rest.
    ///
    /// # Errors
    /// The space is empty, `k` is given without discrete parameters or is not in 1 to their number, or epsilon or
    /// delta is not in (0, 1).
    pub fn of(
        space: &Space,
        k: Option<usize>,
        demand: &Demand,
        epsilon: f64,
        delta: f64,
        limit: Duration,
    ) -> Result<Self, Error> {
        for (name, share) in [("epsilon", epsilon), ("delta", delta)] {
            if !(share > 0.0 && share < 1.0) {
                return Err(PlanFlaw::NoShare { name, found: share }.into());
            }
        }
        if space.parameters().is_empty() {
            return Err(PlanFlaw::Empty.into());
        }
        let (dims, levels) = (space.dims(), space.levels());
        if k.is_some() && levels.is_empty() {
            return Err(PlanFlaw::NoDiscrete.into());
        }
        let k = Request { k, ..Request::new(space, 1) }.discrete_strength()?;
        let (rules, kinds) = (space.rules()?, demand.kinds(space)?);
        let deadline = Deadline::after(limit);
        let request = CoveringRequest {
            kinds: &kinds,
            groups: &demand.groups,
            deadline: deadline.part(if dims == 0 { 1.0 } else { 0.5 }),
            ..CoveringRequest::new(&rules, k)
        };
        let rows = if levels.is_empty() { None } else { Some(rows_needed(&request, delta)?) };
        let validity = Validity::of(space, &rules);
        let points = match &validity {
            _ if dims == 0 => None,
            // Rows with different valid parts need different points.
            Some(_) if !levels.is_empty() => None,
            Some(validity) => Some(valid_points_needed(space, validity, epsilon, deadline)?),
            None => Some(points_needed(dims, epsilon, delta, deadline)?),
        };
        let tests = match (&rows, &points, &validity) {
            (Some(rows), Some(points), None) => Some(joined(rows, points)),
            (Some(rows), None, Some(validity)) => {
                let wanted = Request {
                    epsilon: Some(epsilon),
                    k: Some(k),
                    groups: &demand.groups,
                    deadline,
                    ..Request::new(space, MOST_MEASURED)
                };
                Some(vec![made(&wanted, validity, rows)?])
            }
            _ => None,
        };
        Ok(Self { k: (!levels.is_empty()).then_some(k), epsilon, delta, rows, points, tests })
    }
}

/// Returns the numbers of rows that cover the discrete parameters k-wise, and the groups of parameters with their own
/// k.
fn rows_needed(request: &CoveringRequest, delta: f64) -> Result<Vec<Need>, Error> {
    let &CoveringRequest { rules, k, .. } = request;
    let need = |of: &str, tests, guarantee| Need { of: of.into(), strategy: None, tests, over: None, guarantee };
    let countable = |tests| (tests < u64::MAX).then_some(tests);
    // A row has only one combination of the same parameters.
    let least = u64::try_from(request.lower_bound().map_err(GeneratorError::from)?).ok();
    let array = if request.combinations().map_err(GeneratorError::from)? > MOST_COMBINATIONS {
        None
    } else {
        match covering_array(request) {
            Ok(array) => Some(array.rows.len() as u64),
            Err(CoveringError::OutOfTime | CoveringError::TooLarge { .. }) => None,
            Err(error) => return Err(GeneratorError::from(error).into()),
        }
    };
    // One row fewer than any set needs is not enough for the array either.
    let over = least.filter(|_| array.is_none()).map(|least| least - 1);
    let all = rules.tests().filter(|all| *all < 9e15).map(|all| all as u64);
    let mut needs = vec![
        need("any rows", least, Guarantee::NeededByAny),
        Need { over, ..need("ipog, the array of seed 0", array, Guarantee::Proved) },
        need("all combinations", all, Guarantee::Proved),
    ];
    let has_negatives = request.kinds.iter().any(|kind| kind.negative().is_some());
    if has_negatives || request.groups.iter().any(|(_, strength)| *strength > k) {
        // The bounds for random rows hold for any k parameters only, not for groups or negative values.
        return Ok(needs);
    }
    // If constraints connect too many parameters, the probability of a combination cannot be computed.
    if let Some(random) = RandomRows::new(rules, k) {
        if rules.groups() == 0 && rules.levels().iter().all(|&v| v == 2) {
            let of = "random rows, Proposition 3.2";
            needs.push(need(of, countable(random.family_size(delta)), Guarantee::Probable));
        }
        needs.push(need("random rows, union bound", countable(random.union_bound(delta)), Guarantee::Probable));
    }
    Ok(needs)
}

/// Returns the numbers of points that have a dispersion of at most epsilon.
fn points_needed(dims: usize, epsilon: f64, delta: f64, deadline: Deadline) -> Result<Vec<Need>, Error> {
    let need = |of: &str, tests, guarantee| Need { of: of.to_owned(), strategy: None, tests, over: None, guarantee };
    let proved = |strategy: Strategy, tests| {
        let of = format!("{}, a-priori bound", strategy.name());
        Need { strategy: Some(strategy), ..need(&of, tests, Guarantee::Proved) }
    };
    let mut needs = vec![
        need("any points", points::needed_by_any_set(dims, epsilon), Guarantee::NeededByAny),
        proved(Strategy::HALTON, points::enough_of_halton(dims, epsilon)),
        proved(Strategy::HAMMERSLEY, points::enough_of_hammersley(dims, epsilon)),
        proved(Strategy::SOBOL, points::enough_of_sobol(dims, epsilon)),
        need("random, a-priori bound", points::enough_at_random(dims, epsilon, delta), Guarantee::Probable),
    ];
    // It may be proved that no measurement can end well.
    let least = points::needed_by_any_set(dims, epsilon).unwrap_or(u64::MAX);
    let space = Space::unit_cube(dims);
    needs.extend(measured(&space, least, deadline, &|points, deadline| is_at_most(points, epsilon, deadline))?);
    Ok(needs)
}

/// Joins rows and points, with separate points for every row, into the fewest tests of each guarantee.
fn joined(rows: &[Need], points: &[Need]) -> Vec<Need> {
    let fewest = |needs: &[Need], guarantee: Guarantee| {
        let known = needs.iter().filter(|need| need.guarantee == guarantee);
        known.filter(|need| need.tests.is_some()).min_by_key(|need| need.tests).cloned()
    };
    // The rows get sections of one Halton sequence, whose bound is proved wherever a section begins. The bounds of
    // other sets are not proved for the shifted copies that rows get of them.
    let halton: Vec<Need> = points.iter().filter(|need| need.strategy == Some(Strategy::HALTON)).cloned().collect();
    let pair = |of_rows, of_points, guarantee| {
        let points = if of_points == Guarantee::Proved { &halton[..] } else { points };
        let (row, point) = (fewest(rows, of_rows)?, fewest(points, of_points)?);
        let tests = row.tests.zip(point.tests).and_then(|(rows, points)| rows.checked_mul(points));
        let of = match guarantee {
            Guarantee::NeededByAny => "any tests".to_owned(),
            _ => format!("{} x {}", row.of, point.of),
        };
        Some(Need { of, strategy: None, tests, over: None, guarantee })
    };
    use Guarantee::{Estimated, Measured, NeededByAny, Probable, Proved};
    let pairs = [
        pair(NeededByAny, NeededByAny, NeededByAny),
        pair(Proved, Proved, Proved),
        pair(Probable, Proved, Probable),
        // The points of one row were measured; the other rows have other points.
        pair(Probable, Measured, Estimated),
        pair(Proved, Measured, Estimated),
    ];
    pairs.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::measured::MEASURED;
    use super::*;
    use paracosm_coverage::PointSet;

    fn tests_of(needs: &[Need], of: &str) -> Option<u64> {
        needs.iter().find(|need| need.of == of).unwrap_or_else(|| panic!("no {of}")).tests
    }

    #[test]
    fn measured_numbers_are_the_least_that_do_and_lie_between_the_bounds() {
        let points = points_needed(3, 0.1, 0.05, Deadline::never()).unwrap();
        let space = Space::unit_cube(3);
        for strategy in MEASURED {
            let n = tests_of(&points, strategy.name()).unwrap();
            assert!(n >= tests_of(&points, "any points").unwrap(), "{strategy}");
            let all = strategy.build(&Request::new(&space, n as usize)).unwrap().ask(n as usize);
            let set = |n: usize| PointSet::new(3, all[..n].iter().map(|point| &point.continuous)).unwrap();
            assert_eq!(is_at_most(&set(n as usize), 0.1, Deadline::never()), Some(true), "{strategy}");
            assert_eq!(is_at_most(&set(n as usize - 1), 0.1, Deadline::never()), Some(false), "{strategy}");
        }
        assert!(tests_of(&points, "halton") < tests_of(&points, "halton, a-priori bound"));
    }

    #[test]
    fn the_reference_s_example_of_five_dimensions_comes_out() {
        let points = points_needed(5, 0.1, 0.05, Deadline::never()).unwrap();
        assert_eq!(tests_of(&points, "halton, a-priori bound"), Some(739_200));
        assert_eq!(tests_of(&points, "halton"), Some(141));
    }

    #[test]
    fn an_epsilon_that_needs_more_points_than_are_measured_is_not_measured() {
        // Without a deadline: each strategy would make a million points, and greedy takes milliseconds for each.
        for epsilon in [1e-300, 1e-7] {
            let points = points_needed(3, epsilon, 0.05, Deadline::never()).unwrap();
            for strategy in MEASURED {
                let need = points.iter().find(|need| need.of == strategy.name()).unwrap();
                assert_eq!((need.tests, need.over), (None, Some(MOST_MEASURED as u64)), "{strategy}");
            }
        }
    }

    #[test]
    fn what_was_not_measured_in_time_is_unknown() {
        let points = points_needed(6, 0.01, 0.05, Deadline::after(Duration::ZERO)).unwrap();
        assert_eq!(tests_of(&points, "halton"), None);
        assert_eq!(tests_of(&points, "any points"), Some(120));
    }
}
