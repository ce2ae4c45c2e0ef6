//! The witness: a driver with a defect that no test of a suite can notice.
//!
//! The witness drives like the driver of the study, but within an empty box of the suite it does not brake. No test of the suite is in
//! the box, so all their verdicts stay as they are. A failing test in the box shows that the suite misses a real defect. So the volume
//! of the largest such box has a meaning: it is the largest box-shaped defect that passes the suite.

use super::holes::{Holes, RowHole, empty_boxes, sides, tests_in};
use super::runs::{Runs, gives_away, mutated};
use super::{Estimate, Suite};
use crate::statistics::clopper_pearson;
use crate::statistics::random::SplitMix64;
use paracosm_campaign::{Error, Study, Trial};
use paracosm_coverage::dispersion::LargestEmptyBox;
use paracosm_mutants::{Condition, Mutant, NO_BRAKES};
use paracosm_space::{Coordinate, Point, Record, Space, Value, Values};
use serde::Serialize;

/// The number of tests in a box that are tried with the witness.
const TRIES: usize = 64;
/// The number of tests of a whole row that are tried, if the largest box of the row has no failure.
const TRIES_IN_ROW: usize = 256;
/// The greatest number of rows that are searched.
const MOST_ROWS: usize = 64;
/// The number of draws of the probability of the box.
const DRAWS: usize = 100_000;
const CONFIDENCE: f64 = 0.95;

/// A driver with a defect that passes all tests of a suite as the driver of the study does, and a test that it fails.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Witness {
    /// The defect with the box in which it is on.
    pub mutant: Mutant,
    /// The values of the discrete parameters.
    pub row: Record<Value>,
    /// The ends of the box along each continuous parameter, as values.
    #[serde(rename = "box")]
    pub sides: Record<[f64; 2]>,
    /// The volume of the box, as a share of the valid part of its row: at least so much if the box is the largest of its row, and at
    /// most so much if it is another one.
    pub volume: f64,
    /// `true` if the box is the largest hole of the suite.
    pub is_largest_hole: bool,
    /// `true` if the defect is on in no test of the suite, so that the witness gets the verdicts of the given driver in all of them.
    pub agrees_on_suite: bool,
    /// The number of tests in the box that were run.
    pub tried: usize,
    /// The number of them in which the witness violates a requirement that the driver of the study keeps.
    pub failing: usize,
    /// The values of a failing test: the one with the least robustness.
    pub fails_at: Values,
    /// The requirement that the witness violates in this test.
    pub requirement: String,
    /// The robustness of the requirement with the witness, and with the driver of the study.
    pub robustness: [Option<f64>; 2],
    /// The probability that a test with values from the distributions of the parameters is in the box, given that it is valid, from
    /// random draws. The interval is that of Clopper and Pearson.
    pub probability: Estimate,
}

impl Witness {
    /// Returns the study with the witness at the wheel, for the tests in its box.
    ///
    /// # Errors
    /// The study does not test a driver in this process.
    pub fn study(&self, of: &Study) -> Result<Study, Error> {
        mutated(of, self.mutant.defect)
    }
}

/// A search for the witness of a suite.
pub(super) struct Search<'a> {
    pub study: &'a Study,
    pub suite: &'a Suite,
    pub holes: &'a Holes,
    pub runs: &'a Runs,
}

/// A box of a row in which the witness is to fail.
struct Place<'a> {
    levels: &'a [usize],
    found: LargestEmptyBox,
    volume: f64,
    is_largest: bool,
}

/// The failing test with the least robustness, and how many tests failed.
struct Failing {
    test: Values,
    requirement: String,
    robustness: [Option<f64>; 2],
    count: usize,
}

impl Search<'_> {
    /// Finds the witness in the largest box in which it fails. Returns `None` if it fails in no test that was tried.
    ///
    /// # Errors
    /// The audit was stopped, or the driver cannot be made.
    pub fn run(&self) -> Result<Option<Witness>, Error> {
        let blind = mutated(self.study, NO_BRAKES)?;
        // A row without continuous parameters that has a test has no hole.
        let holes = || self.holes.rows.iter().filter(|hole| hole.volume.lower > 0.0).take(MOST_ROWS);
        for (rank, hole) in holes().enumerate() {
            let place = Place {
                levels: &hole.levels,
                found: hole.found.clone(),
                volume: hole.volume.lower,
                is_largest: rank == 0,
            };
            let tests = self.tests_in(&hole.levels, &hole.found, TRIES)?;
            if let Some(failing) = self.try_out(&blind, &tests)? {
                return self.witness(&place, tests.len(), failing).map(Some);
            }
        }
        for hole in holes() {
            if let Some(witness) = self.in_row(&blind, hole)? {
                return Ok(Some(witness));
            }
        }
        Ok(None)
    }

    /// Looks for the largest empty box of a row around a place where the witness fails.
    fn in_row(&self, blind: &Study, hole: &RowHole) -> Result<Option<Witness>, Error> {
        let dims = self.study.space().dims();
        if dims == 0 {
            return Ok(None);
        }
        let cube = LargestEmptyBox { lower: vec![0.0; dims], upper: vec![1.0; dims] };
        let tests = self.tests_in(&hole.levels, &cube, TRIES_IN_ROW)?;
        let trials = self.runs.of(blind, &tests)?;
        let bad: Vec<&Values> =
            tests.iter().zip(&trials).filter(|(_, t)| t.violated().next().is_some()).map(|(v, _)| v).collect();
        if bad.is_empty() {
            return Ok(None);
        }
        let places = bad.iter().map(|test| self.study.space().encode(test)).collect::<Result<Vec<Point>, _>>()?;
        let mut boxes = self.empty_boxes(&hole.levels)?;
        boxes.sort_by(|a, b| b.1.total_cmp(&a.1));
        for (found, volume) in boxes {
            let inside = |place: &Point| {
                let ends = found.lower.iter().zip(&found.upper);
                place.continuous.iter().zip(ends).all(|(x, (lower, upper))| lower < x && x < upper)
            };
            if !places.iter().any(inside) {
                continue;
            }
            let mut tests = self.tests_in(&hole.levels, &found, TRIES)?;
            tests.extend(bad.iter().zip(&places).filter(|(_, place)| inside(place)).map(|(test, _)| (*test).clone()));
            if let Some(failing) = self.try_out(blind, &tests)? {
                let place = Place { levels: &hole.levels, found, volume, is_largest: false };
                return self.witness(&place, tests.len(), failing).map(Some);
            }
        }
        Ok(None)
    }

    /// Returns the empty boxes of a row with their volumes.
    fn empty_boxes(&self, levels: &[usize]) -> Result<Vec<(LargestEmptyBox, f64)>, Error> {
        let space = self.study.space();
        let corners = |of: paracosm_coverage::empty_boxes::EmptyBox| {
            let (lower, upper) = (0..space.dims()).map(|axis| of.side(axis)).unzip();
            (LargestEmptyBox { lower, upper }, of.volume())
        };
        Ok(empty_boxes(space, levels, &self.suite.points)?.larger_than(0.0).map(corners).collect())
    }

    /// Returns valid tests inside a box of a row, evenly distributed.
    fn tests_in(&self, levels: &[usize], found: &LargestEmptyBox, most: usize) -> Result<Vec<Values>, Error> {
        let space = self.study.space();
        Ok(tests_in(space, levels, found, most)?.iter().map(|point| space.decode(point)).collect())
    }

    /// Runs tests with the witness, and those that it fails with the driver of the study, too.
    fn try_out(&self, blind: &Study, tests: &[Values]) -> Result<Option<Failing>, Error> {
        let trials = self.runs.of(blind, tests)?;
        let bad: Vec<Trial> = trials.into_iter().filter(|trial| trial.violated().next().is_some()).collect();
        let again: Vec<Values> = bad.iter().map(|trial| trial.test.clone()).collect();
        let given = self.runs.given(self.study, &again)?;
        let mut worst: Option<Failing> = None;
        let mut count = 0;
        for (given, trial) in given.iter().zip(&bad) {
            let Some(requirement) = gives_away(given, trial) else { continue };
            count += 1;
            let robustness = [trial, given].map(|trial| trial.robustness(requirement));
            let is_worse = worst.as_ref().is_none_or(|worst| robustness[0] < worst.robustness[0]);
            if is_worse {
                let (test, requirement) = (trial.test.clone(), requirement.to_owned());
                worst = Some(Failing { test, requirement, robustness, count });
            }
        }
        Ok(worst.map(|worst| Failing { count, ..worst }))
    }

    fn witness(&self, place: &Place, tried: usize, failing: Failing) -> Result<Witness, Error> {
        let space = self.study.space();
        let axes: Vec<Coordinate> = space.continuous().collect();
        let names: Vec<Coordinate> = space.discrete().collect();
        let sides = sides(&axes, &place.found);
        let row: Record<Value> = names
            .iter()
            .zip(place.levels)
            .map(|(name, level)| (name.name(), name.parameter.levels().expect("it is discrete")[*level].clone()))
            .collect();
        let between =
            sides.iter().map(|(name, [lo, hi])| Condition::Between { parameter: name.to_owned(), lo: *lo, hi: *hi });
        let is = row.iter().map(|(name, value)| Condition::Is { parameter: name.to_owned(), value: value.clone() });
        let mutant = Mutant { defect: NO_BRAKES, when: between.chain(is).collect() };
        let agrees_on_suite = !self.suite.points.iter().any(|point| mutant.is_active(&space.decode(point)));
        let (inside, valid) = draws(space, &mutant);
        Ok(Witness {
            row,
            sides,
            volume: place.volume,
            is_largest_hole: place.is_largest,
            agrees_on_suite,
            tried,
            failing: failing.count,
            fails_at: failing.test,
            requirement: failing.requirement,
            robustness: failing.robustness,
            probability: Estimate::of(
                inside as f64 / valid.max(1) as f64,
                clopper_pearson(inside, valid.max(1), CONFIDENCE),
            ),
            mutant,
        })
    }
}

/// Draws tests from the distributions of the parameters. Returns the number of valid tests for which a mutant is on, and the number
/// of all valid tests.
fn draws(space: &Space, mutant: &Mutant) -> (usize, usize) {
    let mut random = SplitMix64(0);
    let coordinates = space.coordinates().count();
    let (mut inside, mut valid) = (0, 0);
    for _ in 0..DRAWS {
        let quantiles: Vec<f64> = (0..coordinates).map(|_| random.unit()).collect();
        let point = space.at_quantiles(&quantiles);
        if space.allows(&point) {
            valid += 1;
            inside += usize::from(mutant.is_active(&space.decode(&point)));
        }
    }
    (inside, valid)
}
