//! A better suite: fewer tests than the audited suite, with smaller holes, that kill all mutants of the set.
//!
//! The suite begins with the fewest tests of the screen that kill all mutants. Then it grows into its largest hole: for each row of
//! discrete values, the valid test nearest to the centre of the largest empty box comes next, until each hole is smaller than the
//! largest hole of the audited suite.
//!
//! The mutants that choose the suite also grade it, so its score on them is no evidence. An audit with another seed has other mutants.

use super::cover::Cover;
use super::holes::{empty_boxes, tests_in};
use super::{Estimate, Holes, Screen, Share, Suite};
use paracosm_campaign::{Error, Study};
use paracosm_coverage::dispersion::LargestEmptyBox;
use paracosm_coverage::{Bracket, Deadline};
use paracosm_space::{Point, Space, SpaceError, Values};
use serde::Serialize;

/// The number of tests of a box among which that nearest to the centre is chosen.
const CANDIDATES: usize = 64;

/// A suite with fewer tests and smaller holes than the audited suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Better {
    /// The number of tests.
    pub tests: usize,
    /// The number of tests that were chosen because they kill mutants.
    pub killing: usize,
    /// The file of the tests in the folder of the audit.
    pub file: String,
    /// The volume of the largest hole of the better suite.
    pub hole: Bracket,
    /// The share of the mutants that the tests of the screen in the suite kill; `None` without mutants. These mutants chose the tests.
    pub mutation_score: Option<Estimate>,
    /// The tests: first those that kill the mutants, then those in holes.
    #[serde(skip)]
    pub suite: Vec<Values>,
}

impl Better {
    /// Makes a better suite; `None` if this method finds none until the deadline. `holes` are the holes of the audited suite. `number` is the number of the audited suite, from 1.
    pub(super) fn of(
        number: usize,
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
        let chosen = screen.map_or_else(Vec::new, killing);
        let encoded = |test: &usize| study.space().encode(&screen.expect("it chose the test").values[*test]);
        let mut points = chosen.iter().map(encoded).collect::<Result<Vec<Point>, SpaceError>>()?;
        for row in &holes.rows {
            if !close(study, &row.levels, goal, suite.points.len(), deadline, &mut points)? {
                return Ok(None);
            }
        }
        let better = Suite::new(String::new(), points, study)?;
        let hole = Holes::of(&better, study, deadline)?.largest();
        let mutants = screen.map_or(&[][..], |screen| &screen.mutants);
        let killed = mutants.iter().filter(|mutant| mutant.tests.iter().any(|test| chosen.contains(test))).count();
        Ok((hole.upper < goal).then(|| Self {
            tests: better.points.len(),
            killing: chosen.len(),
            file: format!("better-{number}.csv"),
            hole,
            mutation_score: Share::new(killed, mutants.len()).mutation_score,
            suite: better.values(study),
        }))
    }
}

/// Returns the fewest tests of a screen that kill all its mutants, as positions.
fn killing(screen: &Screen) -> Vec<usize> {
    let mutants: Vec<&[usize]> = screen.mutants.iter().map(|noticed| &noticed.tests[..]).collect();
    Cover::of(&mutants, screen.values.len()).tests
}

/// Adds tests to the largest empty box of a row until it is smaller than `goal`. Returns `false` if that takes `most` tests or more in
/// all, if it takes longer than until the deadline, or if no valid test is found in a box.
fn close(
    study: &Study,
    levels: &[usize],
    goal: f64,
    most: usize,
    deadline: Deadline,
    points: &mut Vec<Point>,
) -> Result<bool, Error> {
    let space = study.space();
    let mut boxes = empty_boxes(space, levels, points)?;
    loop {
        let largest = boxes.largest();
        // A box that was forgotten may be larger.
        if boxes.dispersion().upper < goal {
            return Ok(points.len() < most);
        }
        if points.len() + 1 >= most || largest.volume() < goal || deadline.passed() {
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
