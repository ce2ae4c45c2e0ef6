//! Searches for sets of points that make a measure as small as possible, for as long as there is time.
//!
//! The exact measure judges each set that a search keeps. In the plane, the star discrepancy has a search over the orders of the points, each with its best
//! coordinates (`plane.rs`). In more dimensions, its search moves points and keeps a pool of bad boxes (`anchored.rs`). The dispersions have a search that moves
//! one point after another (`exchange.rs`). On a line the best sets are known.

mod anchored;
mod exchange;
mod objective;
mod placement;
mod plane;
mod pool;
mod ranks;
mod shared;
mod spots;

pub use objective::{Objective, ObjectiveError};

use crate::{Generator, GeneratorError, Request, Strategy};
use paracosm_coverage::records::{largest_record_below, record};
use paracosm_coverage::{Deadline, Measure, PointSet};
use paracosm_space::{Point, Space};

/// The most points in the plane whose order is searched. The counts take about 12 n^2 bytes for each thread.
const MOST_RANKS: usize = 3000;

/// The most points of a set for the strategy `best` that is not shipped.
const MOST_SETTLED: usize = 1000;

/// The least number of moves that make up for the time of an exact measure.
const LEAST_MOVES: usize = 50;

/// The share of the time in which the search may look for a set to begin with.
const OPENING: f64 = 0.1;

/// The most seeds of each strategy for a set to begin with.
const MOST_SEEDS: u64 = 1000;

/// The share of the rest of this time for the measure of a set.
const MEASURING: f64 = 0.2;

/// A set of points with a small measure.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimised {
    /// The points.
    pub points: PointSet,
    /// `false` if the time was too short to measure the points, so that nothing was searched.
    pub is_searched: bool,
}

/// Returns `n` points in `[0,1)^dims` with a small measure. The result depends on the time. The search begins with the given points, or else with the points of
/// this size that are shipped, and returns no worse points. `watch` is called with the measure of each better set.
///
/// # Panics
/// There are no points or no dimensions, or the given points have another number or other dimensions.
pub fn optimised(
    objective: Objective,
    (n, dims): (usize, usize),
    given: Option<&PointSet>,
    seed: u64,
    deadline: Deadline,
    watch: &(dyn Fn(f64) + Sync),
) -> Optimised {
    assert!(n > 0 && dims > 0, "a set has at least one point and one dimension");
    assert!(given.is_none_or(|given| (given.len(), given.dims()) == (n, dims)), "the given points have another size");
    let shipped = if given.is_none() { record(objective.measure(), dims, n) } else { None };
    let given = given.or(shipped.as_ref());
    match (objective, dims) {
        (_, 1) => Optimised { points: on_the_line(objective, n), is_searched: true },
        (Objective::Star, 2) if n <= MOST_RANKS => {
            let pairs: Option<Vec<[f64; 2]>> =
                given.map(|given| given.iter().map(|point| [point[0], point[1]]).collect());
            let found = plane::small_star(n, pairs.as_deref(), seed, deadline, watch);
            Optimised { points: PointSet::new(2, found).expect("the points are in the square"), is_searched: true }
        }
        _ => {
            let opening = given.cloned().unwrap_or_else(|| opening(objective, n, dims, deadline.part(OPENING)));
            let (points, is_searched) = match objective {
                Objective::Star if dims > 2 => anchored::improved(&opening, seed, deadline, watch),
                _ => exchange::improved(objective, &opening, seed, deadline, watch),
            };
            Optimised { points, is_searched }
        }
    }
}

/// Returns a set with a small dispersion. The result depends on the size alone. It is the shipped set, or else the best plain set after a number of moves. Where an exact
/// measure takes long, it is the set of `greedy`.
pub(crate) fn settled(n: usize, dims: usize) -> Result<PointSet, GeneratorError> {
    if n > MOST_SETTLED {
        return Err(GeneratorError::BestLimit { points: n, most: MOST_SETTLED });
    }
    if dims == 1 {
        return Ok(on_the_line(Objective::Dispersion, n));
    }
    if let Some(known) = record(Measure::DISPERSION, dims, n) {
        return Ok(known);
    }
    let space = Space::unit_cube(dims);
    let made = |strategy: Strategy, existing: &[Point]| -> Result<PointSet, GeneratorError> {
        let request = Request { existing, ..Request::new(&space, n - existing.len()) };
        let new = strategy.build(&request)?.ask(n - existing.len());
        let points = existing.iter().chain(&new).map(|point| point.continuous.clone());
        Ok(PointSet::new(dims, points).expect("tests are in the cube"))
    };
    let greedy = made(Strategy::GREEDY, &[])?;
    let moves = moves(n, dims);
    if moves < LEAST_MOVES && dims > 2 {
        return Ok(greedy);
    }
    let mut sets = vec![greedy];
    let is_plain = |strategy: &Strategy| strategy.has_plain_set() && *strategy != Strategy::BEST;
    sets.extend(Strategy::all().filter(is_plain).filter_map(|strategy| made(strategy, &[]).ok()));
    // A further point never makes the dispersion larger.
    if let Some(smaller) = largest_record_below(Measure::DISPERSION, dims, n) {
        let existing = smaller.iter().map(|point| Point { continuous: point.to_vec(), discrete: Vec::new() });
        sets.push(made(Strategy::GREEDY, &existing.collect::<Vec<Point>>())?);
    }
    let value = |set: &PointSet| Objective::Dispersion.measured(set, Deadline::never()).upper;
    let least = sets.into_iter().map(|set| (value(&set), set)).min_by(|(a, _), (b, _)| a.total_cmp(b));
    let (_, points) = least.expect("greedy has made a set");
    Ok(if moves < LEAST_MOVES { points } else { exchange::after_moves(Objective::Dispersion, &points, moves) })
}

/// Returns the number of moves of the short search of `settled`, which takes some seconds at most.
fn moves(n: usize, dims: usize) -> usize {
    let boxes = n.saturating_mul(n).saturating_mul(4_usize.saturating_pow(u32::try_from(dims).unwrap_or(u32::MAX) - 2));
    (30_000_000 / boxes.max(1)).min(20_000)
}

/// Returns the best points on a line: in the middle of even cells for the star discrepancy, and at even distances for the dispersion.
fn on_the_line(objective: Objective, n: usize) -> PointSet {
    let n_points = n as f64;
    let point = |i: usize| match objective {
        Objective::Star => (2.0 * i as f64 + 1.0) / (2.0 * n_points),
        Objective::Dispersion | Objective::KwiseDispersion(_) => (i as f64 + 1.0) / (n_points + 1.0),
    };
    PointSet::new(1, (0..n).map(|i| [point(i)])).expect("the points are between 0 and 1")
}

/// Returns the best set of the strategies that make sets of this size: each plain set once, and then sets with random numbers for as long as there is time.
fn opening(objective: Objective, n: usize, dims: usize, deadline: Deadline) -> PointSet {
    let space = Space::unit_cube(dims);
    let made = |strategy: Strategy, seed: u64| -> Option<PointSet> {
        let request = Request { seed: (seed > 0).then_some(seed), deadline, ..Request::new(&space, n) };
        let mut generator: Box<dyn Generator> = strategy.build(&request).ok()?;
        let points = generator.ask(n);
        let points = PointSet::new(dims, points.into_iter().map(|point| point.continuous)).ok()?;
        (points.len() == n).then_some(points)
    };
    // The strategy `best` makes a search of its own.
    let is_left_out =
        |strategy: &Strategy| [Strategy::RANDOM, Strategy::RANDOM_CORNERS, Strategy::BEST].contains(strategy);
    let open_loop = || Strategy::all().filter(|strategy| !strategy.is_adaptive() && !is_left_out(strategy));
    // Sequences take no time. To fill holes takes long, and a seed changes little.
    let (slow, fast): (Vec<Strategy>, Vec<Strategy>) = open_loop().partition(|strategy| strategy.fills_holes());
    let first = fast.iter().chain(&slow).map(|&strategy| (strategy, 0));
    let more = (1..MOST_SEEDS).flat_map(|seed| fast.iter().map(move |&strategy| (strategy, seed)));
    let mut best: Option<(PointSet, f64)> = None;
    for (strategy, seed) in first.chain(more) {
        if best.is_some() && deadline.passed() {
            break;
        }
        let Some(points) = made(strategy, seed) else { continue };
        let value = objective.measured(&points, deadline.part(MEASURING)).upper;
        if best.as_ref().is_none_or(|(_, least)| value < *least) {
            best = Some((points, value));
        }
    }
    best.map(|(points, _)| points).or_else(|| made(Strategy::RANDOM, 0)).expect("random points have every size")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn found(objective: Objective, size: (usize, usize), given: Option<&PointSet>) -> (PointSet, f64) {
        // Long enough for some moves beside other tests.
        let deadline = Deadline::after(Duration::from_secs(1));
        let Optimised { points, .. } = optimised(objective, size, given, 1, deadline, &|_| ());
        let value = objective.measured(&points, Deadline::never());
        assert!(value.is_exact() && (points.len(), points.dims()) == size);
        assert!(points.iter().flatten().all(|x| (0.0..1.0).contains(x)), "generated points are in [0,1)");
        (points, value.upper)
    }

    #[test]
    fn no_measure_becomes_worse_than_that_of_the_given_points() {
        let space = Space::unit_cube(3);
        for (objective, dims) in
            [(Objective::Star, 2), (Objective::Star, 3), (Objective::Dispersion, 2), (Objective::KwiseDispersion(2), 3)]
        {
            let mut halton = Strategy::HALTON.build(&Request::new(&space, 20)).unwrap();
            let points = halton.ask(20).into_iter().map(|point| point.continuous[..dims].to_vec());
            let given = PointSet::new(dims, points).unwrap();
            let before = objective.measured(&given, Deadline::never()).upper;
            let (_, after) = found(objective, (20, dims), Some(&given));
            assert!(after < before, "{objective:?}: {after} after {before}");
        }
    }

    #[test]
    fn points_that_cannot_be_bettered_stay_as_they_are() {
        let (points, value) = found(Objective::Star, (5, 2), None);
        let again = optimised(Objective::Star, (5, 2), Some(&points), 2, Deadline::after(Duration::ZERO), &|_| ());
        assert!(Objective::Star.measured(&again.points, Deadline::never()).upper <= value);
    }

    #[test]
    fn points_that_take_too_long_to_measure_are_not_searched() {
        let deadline = Deadline::after(Duration::from_millis(100));
        let found = optimised(Objective::Star, (500, 20), None, 1, deadline, &|_| ());
        assert!(!found.is_searched && found.points.len() == 500);
        let deadline = Deadline::after(Duration::ZERO);
        assert_eq!(optimised(Objective::Star, (2500, 2), None, 1, deadline, &|_| ()).points.len(), 2500);
    }

    #[test]
    fn points_on_a_line_are_the_best() {
        assert_eq!(found(Objective::Star, (4, 1), None).1, 1.0 / 8.0);
        assert_eq!(found(Objective::Dispersion, (3, 1), None).1, 1.0 / 4.0);
        assert_eq!(found(Objective::KwiseDispersion(1), (3, 1), None).1, 1.0 / 4.0);
    }

    #[test]
    fn the_optimised_points_are_better_than_those_of_all_strategies() {
        for (objective, dims) in [(Objective::Star, 2), (Objective::Dispersion, 3)] {
            let (_, optimised) = found(objective, (16, dims), None);
            let opened = opening(objective, 16, dims, Deadline::never());
            assert!(optimised < objective.measured(&opened, Deadline::never()).upper);
        }
    }

    #[test]
    fn a_single_point_and_many_points_have_a_set() {
        found(Objective::Dispersion, (1, 2), None);
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        assert!((found(Objective::Star, (1, 2), None).1 - golden).abs() < 1e-9);
        found(Objective::Star, (2, 2), None);
        let deadline = Deadline::after(Duration::from_millis(100));
        assert_eq!(
            optimised(Objective::Star, (MOST_RANKS + 1, 2), None, 1, deadline, &|_| ()).points.len(),
            MOST_RANKS + 1
        );
    }
}
