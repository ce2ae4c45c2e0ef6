//! Measurements of a plan: how many points of a strategy are enough, and how many tests.

use super::{Guarantee, Need};
use paracosm_campaign::Error;
use paracosm_coverage::dispersion::valid_is_at_most;
use paracosm_coverage::kwise_dispersion::row_dispersion;
use paracosm_coverage::valid::Validity;
use paracosm_coverage::{Deadline, PointSet};
use paracosm_generators::{Generator, Request, Strategy};
use paracosm_space::{Point, Space};

/// The strategies whose points are measured. For each of them, a longer beginning of its sequence is never worse.
pub(super) const MEASURED: [Strategy; 3] = [Strategy::HALTON, Strategy::SOBOL, Strategy::GREEDY];

/// The greatest number of points that are measured.
pub(super) const MOST_MEASURED: usize = 1 << 20;

/// The greatest number of coordinates of the points that are measured, which take 256 MiB in each of their copies.
const MOST_COORDINATES: usize = 1 << 25;

/// Returns the numbers of points that have a dispersion of at most epsilon within the valid part of a space. No bound is known
/// before a measurement.
pub(super) fn valid_points_needed(
    space: &Space,
    validity: &Validity,
    epsilon: f64,
    deadline: Deadline,
) -> Result<Vec<Need>, Error> {
    let valid = validity.whole();
    measured(space, 0, deadline, &|points, deadline| valid_is_at_most(points, &valid, epsilon, deadline))
}

/// Makes tests that do both within the valid part of each row, and counts them.
pub(super) fn made(wanted: &Request, validity: &Validity, rows: &[Need]) -> Result<Need, Error> {
    let (mut generator, mut tests) = (Strategy::GREEDY.build(wanted)?, Vec::new());
    loop {
        let more = generator.ask(wanted.budget - tests.len());
        if more.is_empty() {
            break;
        }
        tests.extend(more);
    }
    let epsilon = wanted.epsilon.expect("it is asked for");
    let reached = row_dispersion(wanted.space.dims(), Some(validity), &tests, wanted.deadline);
    let is_enough = reached.upper <= epsilon;
    // Each row needs a test.
    let least = rows.iter().find(|need| need.guarantee == Guarantee::NeededByAny).and_then(|need| need.tests);
    Ok(Need {
        of: "greedy, the tests of seed 0".to_owned(),
        strategy: Some(Strategy::GREEDY),
        tests: is_enough.then_some(tests.len() as u64),
        over: least.filter(|_| !is_enough).map(|least| least.saturating_sub(1)),
        guarantee: Guarantee::Proved,
    })
}

/// Measures for each strategy how many points are enough. Any set needs at least `least` points.
pub(super) fn measured(
    space: &Space,
    least: u64,
    deadline: Deadline,
    is_enough: &IsEnough,
) -> Result<Vec<Need>, Error> {
    let strategies = MEASURED.into_iter().enumerate();
    let mut needs = Vec::new();
    for (i, strategy) in strategies.filter(|(_, strategy)| strategy.dims().contains(&space.dims())) {
        let share = 1.0 / (MEASURED.len() - i) as f64;
        let (tests, over) = match enough_of(strategy, space, least, deadline.part(share), is_enough)? {
            Enough::Least(tests) => (Some(tests), None),
            Enough::Over(tests) => (None, Some(tests)),
        };
        let of = strategy.name().to_owned();
        needs.push(Need { of, strategy: Some(strategy), tests, over, guarantee: Guarantee::Measured });
    }
    Ok(needs)
}

/// A function that says whether points are enough; `None` if the answer is not known at the deadline.
type IsEnough<'a> = dyn Fn(&PointSet, Deadline) -> Option<bool> + 'a;

/// A number of points that is enough.
enum Enough {
    /// The least number of points that is shown to be enough.
    Least(u64),
    /// More points than this are needed.
    Over(u64),
}

/// Finds the least number of first points of a strategy that are enough.
fn enough_of(
    strategy: Strategy,
    space: &Space,
    least: u64,
    deadline: Deadline,
    is_enough: &IsEnough,
) -> Result<Enough, Error> {
    let dims = space.dims();
    let most = MOST_MEASURED.min(MOST_COORDINATES / dims);
    if least > most as u64 {
        return Ok(Enough::Over(most as u64));
    }
    let mut generator = strategy.build(&Request::new(space, most))?;
    let mut all: Vec<Point> = Vec::new();
    let mut are_enough = |n: usize, generator: &mut dyn Generator| -> Result<Option<bool>, Error> {
        while all.len() < n {
            if deadline.passed() {
                return Ok(None);
            }
            // In very many dimensions, even a few points take so long that the deadline has to be checked again.
            let more = generator.ask((n - all.len()).min(1 + 10_000 / dims));
            if more.is_empty() {
                return Ok(None);
            }
            all.extend(more);
        }
        let points = PointSet::new(dims, all[..n].iter().map(|point| &point.continuous))?;
        Ok(is_enough(&points, deadline))
    };
    // Longer beginnings are never worse: double the length until it is enough, then search between by halving.
    let (mut short, mut long) = (0, 1);
    loop {
        match are_enough(long, generator.as_mut())? {
            Some(true) => break,
            // Within the valid part, a bracket may stay around epsilon. Only points that are shown to be enough count.
            found if 2 * long <= most && (found.is_some() || !deadline.passed()) => (short, long) = (long, 2 * long),
            _ => return Ok(Enough::Over(short as u64)),
        }
    }
    while long - short > 1 {
        let middle = short + (long - short) / 2;
        match are_enough(middle, generator.as_mut())? {
            Some(true) => long = middle,
            Some(false) => short = middle,
            None if !deadline.passed() => short = middle,
            None => return Ok(Enough::Over(short as u64)),
        }
    }
    Ok(Enough::Least(long as u64))
}
