//! A better suite: fewer tests than the audited suite, with smaller holes, that kill as many mutants.
//!
//! Mutants that choose tests cannot grade them. So no mutant chooses a test. First the suite grows into its largest hole: for each row
//! of discrete values, a valid test near the centre of the largest empty box comes next, until each hole is smaller than the
//! largest hole of the audited suite. Then near misses come, a few at a time. The mutants of the audit only say when the
//! suite is large enough: it kills as many of them as the audited suite. So its score is still a little too high, and an audit
//! with another seed has other mutants.

use super::bout::{Bout, Noticed};
use super::holes::{empty_boxes, tests_in};
use super::near_misses::{NearMisses, nearest};
use super::{Estimate, Holes, Runs, Screen, Share, Suite};
use paracosm_campaign::{Error, Study};
use paracosm_coverage::dispersion::LargestEmptyBox;
use paracosm_coverage::{Bracket, Deadline};
use paracosm_space::{Point, Space, Values};
use serde::Serialize;

/// The file of the tests in the folder of the audit.
const FILE: &str = "better-1.csv";
/// The number of random tests among which near misses are looked for, for each test of the screen.
const POOL: usize = 64;
/// The seed of these tests, counted from the seed of the audit.
const SEED: u64 = 1 << 32;
/// The suite grows by its number of tests, divided by this number, at a time.
const BATCH: usize = 8;
/// The number of tests of a box among which one is chosen.
const CANDIDATES: usize = 64;

/// A suite with fewer tests and smaller holes than the audited suite, which kills as many mutants.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Better {
    /// The number of tests.
    pub tests: usize,
    /// The number of tests that were chosen for their places in holes; the others are near misses.
    pub in_holes: usize,
    /// The file of the tests in the folder of the audit.
    pub file: String,
    /// The volume of the largest hole of the better suite.
    pub hole: Bracket,
    /// The share of the audit's mutants that the suite kills; `None` without mutants.
    pub mutation_score: Option<Estimate>,
    /// The tests: first those in holes, then the near misses.
    #[serde(skip)]
    pub suite: Vec<Values>,
}

/// The search for a suite that is better than an audited suite.
pub(super) struct Search<'a> {
    pub study: &'a Study,
    /// The audited suite with its holes.
    pub suite: &'a Suite,
    pub holes: &'a Holes,
    /// The mutants of the audit, and how many of them the audited suite kills; `None` without mutants.
    pub screen: Option<(&'a Screen, usize)>,
    pub runs: &'a Runs,
    pub deadline: Deadline,
}

impl Search<'_> {
    /// Returns a better suite; `None` if this method finds none until the deadline.
    pub fn run(&self) -> Result<Option<Better>, Error> {
        let Self { study, suite, holes, .. } = *self;
        let goal = holes.largest().lower;
        if study.space().dims() == 0 || holes.only_tested_rows || goal <= 0.0 {
            return Ok(None);
        }
        let mut points = Vec::new();
        for row in &holes.rows {
            if !self.close(&row.levels, goal, &mut points)? {
                return Ok(None);
            }
        }
        let in_holes = points.len();
        let mut jury = Jury::of(self);
        if let Some((screen, _)) = self.screen
            && !jury.is_content(&points)?
        {
            let seed = screen.seed.wrapping_add(SEED);
            let mut near = NearMisses::of(study, POOL * screen.tests, seed, self.runs)?;
            loop {
                let more = points.len().div_ceil(BATCH).min(suite.points.len() - 1 - points.len());
                if near.add(more, &mut points) == 0 || self.deadline.passed() {
                    return Ok(None);
                }
                if jury.is_content(&points)? {
                    break;
                }
            }
        }
        self.made(points, in_holes, &jury)
    }

    /// Makes the result if the holes are certainly smaller than the largest hole of the audited suite.
    fn made(&self, points: Vec<Point>, in_holes: usize, jury: &Jury) -> Result<Option<Better>, Error> {
        let better = Suite::new(String::new(), points, self.study)?;
        let hole = Holes::of(&better, self.study, self.deadline)?.largest();
        Ok((hole.upper < self.holes.largest().lower).then(|| Better {
            tests: better.points.len(),
            in_holes,
            file: FILE.to_owned(),
            hole,
            mutation_score: jury.score().mutation_score,
            suite: better.values(self.study),
        }))
    }

    /// Adds tests to the largest empty box of a row until it is smaller than `goal`. Returns `false` if there are then as many tests as
    /// in the audited suite, if it takes longer than until the deadline, or if no valid test is found in a box.
    fn close(&self, levels: &[usize], goal: f64, points: &mut Vec<Point>) -> Result<bool, Error> {
        let (space, most) = (self.study.space(), self.suite.points.len());
        let mut boxes = empty_boxes(space, levels, points)?;
        loop {
            let largest = boxes.largest();
            // A box that was forgotten may be larger.
            if boxes.dispersion().upper < goal {
                return Ok(points.len() < most);
            }
            if points.len() + 1 >= most || largest.volume() < goal || self.deadline.passed() {
                return Ok(false);
            }
            let (lower, upper) = (0..space.dims()).map(|axis| largest.side(axis)).unzip();
            let found = LargestEmptyBox { lower, upper };
            let Some(point) = inside(space, levels, &found, points)? else { return Ok(false) };
            // The test is known by its values, which may be rounded.
            let point = space.encode(&space.decode(&point))?;
            boxes.add(&point.continuous)?;
            points.push(point);
        }
    }
}

/// Returns a valid test of a box; `None` if none is found. It is near the centre, so that the boxes that are left are small, and far
/// from the tests of all rows, so that rows do not repeat each other.
fn inside(space: &Space, levels: &[usize], of: &LargestEmptyBox, points: &[Point]) -> Result<Option<Point>, Error> {
    let (lower, upper) =
        of.lower.iter().zip(&of.upper).map(|(lo, hi)| (0.75 * lo + 0.25 * hi, 0.25 * lo + 0.75 * hi)).unzip();
    let mut tests = tests_in(space, levels, &LargestEmptyBox { lower, upper }, CANDIDATES)?;
    if tests.is_empty() {
        tests = tests_in(space, levels, of, CANDIDATES)?;
    }
    Ok(tests.into_iter().max_by(|a, b| nearest(a, points).total_cmp(&nearest(b, points))))
}

/// The mutants of the audit, which say when a suite is large enough.
struct Jury<'a> {
    study: &'a Study,
    runs: &'a Runs,
    /// The mutants that the suite has not killed so far.
    left: Vec<Noticed>,
    counted: usize,
    /// The number of mutants that the suite has to kill.
    asked: usize,
    /// The number of tests that were on trial.
    heard: usize,
}

impl<'a> Jury<'a> {
    fn of(search: &Search<'a>) -> Self {
        let (left, asked) =
            search.screen.map_or_else(Default::default, |(screen, asked)| (screen.mutants.clone(), asked));
        Self { study: search.study, runs: search.runs, counted: left.len(), left, asked, heard: 0 }
    }

    /// Returns `true` if the tests kill as many mutants as asked. They begin with the tests that were on trial before.
    fn is_content(&mut self, points: &[Point]) -> Result<bool, Error> {
        let new = &points[self.heard..];
        self.heard = points.len();
        if !new.is_empty() {
            let suite = Suite::new(String::new(), new.to_vec(), self.study)?;
            let mut kills = Vec::new();
            let bout = Bout { study: self.study, suites: &[suite], mutants: &self.left, runs: self.runs };
            bout.run(0, |tried| {
                kills.push(tried.kills[0].is_some());
                Ok(())
            })?;
            let mut kills = kills.into_iter();
            self.left.retain(|_| kills.next() == Some(false));
        }
        Ok(self.score().killed >= self.asked)
    }

    fn score(&self) -> Share {
        Share::new(self.counted - self.left.len(), self.counted)
    }
}
