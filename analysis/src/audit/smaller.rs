//! A smaller suite: fewer tests than the audited suite, with smaller holes, that kill all mutants of the set.
//!
//! The suite begins with the fewest tests of the screen that kill all mutants. Then it grows into its largest hole: for each row of
//! discrete values, the valid test nearest to the centre of the largest empty box comes next, until each hole is smaller than the
//! largest hole of the audited suite.
//!
//! The mutants that choose the suite also grade it, so its score on them is no evidence. An audit with another seed has other mutants.

use super::cover::Cover;
use super::holes::{empty_boxes, tests_in};
use super::{Holes, Screen, Suite};
use paracosm_campaign::{Error, Study};
use paracosm_coverage::dispersion::LargestEmptyBox;
use paracosm_coverage::{Bracket, Deadline};
use paracosm_space::{Point, Space, SpaceError, Values};
use serde::Serialize;

/// The number of tests of a box among which that nearest to the centre is chosen.
const CANDIDATES: usize = 64;

/// A suite with fewer tests and smaller holes than the audited suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Smaller {
    /// The tests: first those that kill the mutants, then those in holes.
    pub tests: Vec<Values>,
    /// The number of tests that were chosen because they kill mutants.
    pub killing: usize,
    /// The volume of the largest hole of the smaller suite.
    pub largest_hole: Bracket,
}

impl Smaller {
    /// Makes a smaller suite; `None` if this method finds none. `holes` are the holes of the audited suite, which are looked at for
    /// no longer than until the deadline in the smaller suite.
    pub(super) fn of(
        study: &Study,
        suite: &Suite,
        holes: &Holes,
        screen: Option<&Screen>,
        deadline: Deadline,
    ) -> Result<Option<Self>, Error> {
        let goal = holes.largest().lower;
        if study.space().dims() == 0 || holes.only_tested_rows || goal <= 0.0 {
            return Ok(None);
        }
        let mut points = screen.map_or_else(|| Ok(Vec::new()), |screen| killing(study.space(), screen))?;
        let killing = points.len();
        for row in &holes.rows {
            if !close(study, &row.levels, goal, suite.points.len(), &mut points)? {
                return Ok(None);
            }
        }
        let smaller = Suite::new(String::new(), points, study)?;
        let largest_hole = Holes::of(&smaller, study, deadline)?.largest();
        let tests = smaller.values(study);
        Ok((largest_hole.upper < goal).then_some(Self { tests, killing, largest_hole }))
    }
}

/// Returns the fewest tests of a screen that kill all its mutants.
fn killing(space: &Space, screen: &Screen) -> Result<Vec<Point>, SpaceError> {
    let mutants: Vec<&[usize]> = screen.mutants.iter().map(|noticed| &noticed.tests[..]).collect();
    let Cover { tests, .. } = Cover::of(&mutants, screen.values.len());
    tests.into_iter().map(|test| space.encode(&screen.values[test])).collect()
}

/// Adds tests to the largest empty box of a row until it is smaller than `goal`. Returns `false` if that takes `most` tests or more in
/// all, or if no valid test is found in a box.
fn close(study: &Study, levels: &[usize], goal: f64, most: usize, points: &mut Vec<Point>) -> Result<bool, Error> {
    let space = study.space();
    let mut boxes = empty_boxes(space, levels, points)?;
    loop {
        let largest = boxes.largest();
        // A box that was forgotten may be larger.
        if boxes.dispersion().upper < goal {
            return Ok(points.len() < most);
        }
        if points.len() + 1 >= most || largest.volume() < goal {
            return Ok(false);
        }
        let (lower, upper) = (0..space.dims()).map(|axis| largest.side(axis)).unzip();
        let Some(point) = central(space, levels, &LargestEmptyBox { lower, upper })? else { return Ok(false) };
        // The test is known by its values, which may be rounded.
        let point = space.encode(&space.decode(&point))?;
        boxes.add(&point.continuous)?;
        points.push(point);
    }
}

/// Returns the valid test of a box that is nearest to the centre of the box; `None` if none is found.
fn central(space: &Space, levels: &[usize], of: &LargestEmptyBox) -> Result<Option<Point>, Error> {
    let offset = |point: &Point| {
        let ends = of.lower.iter().zip(&of.upper);
        let along = |(x, (lower, upper)): (&f64, (&f64, &f64))| ((x - lower) / (upper - lower) - 0.5).abs();
        point.continuous.iter().zip(ends).map(along).fold(0.0, f64::max)
    };
    let inside = tests_in(space, levels, of, CANDIDATES)?;
    Ok(inside.into_iter().min_by(|a, b| offset(a).total_cmp(&offset(b))))
}
