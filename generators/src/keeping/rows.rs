//! Gives every row of discrete values its share of valid tests.
//!
//! A row has its own points, as without constraints, and leaves out those that break a constraint. A row walks through its
//! own block of a sequence, which is longer than the row needs. A set that depends on its size gets the size at which just
//! the wanted number of its points is valid.
//!
//! A covering array needs each of its rows. So if the points of a row do not suffice, random points stand in for them. If
//! random points do not keep the constraints either, the row counts as impossible, and the other rows share its tests.

use super::sized::sized;
use super::{MOST_DRAWS, MOST_REFUSED, Share};
use crate::deal::Deal;
use crate::family::Family;
use crate::seeded::{Purpose, seeded};
use crate::strategy::{BuildSets, Sequence};
use crate::{Generator, GeneratorError, Request};
use paracosm_space::{Point, Space};
use rand::Rng;
use std::collections::VecDeque;

/// The number of points that a row's block of a sequence has for each test of the row.
const POINTS_PER_TEST: u64 = 128;

/// A generator of valid tests of the rows of a family.
pub(crate) struct ValidRows {
    space: Space,
    family: Family,
    points: RowPoints,
    seed: u64,
    /// The number of tests to come.
    left: u64,
    /// The number of points for one valid test, as the quotient of two numbers.
    per_test: [usize; 2],
    /// The rows that have tests to come, in their order; `None` before the first test.
    turns: Option<VecDeque<Row>>,
    drawn: u64,
}

/// The source of the points of rows.
pub(crate) enum RowPoints {
    /// The points are those of a sequence, in which each row has a block.
    Walked {
        sequence: Box<dyn Sequence>,
        first: u64,
        /// The number of points of each row.
        block: u64,
        /// `true` if random points may stand in for those of the sequence.
        fills: bool,
    },
    /// The points come from sets that are made for a number of points.
    Sets { build: BuildSets, seed: Option<u64> },
}

/// A row of discrete values with its points to come.
struct Row {
    discrete: Vec<usize>,
    points: Points,
}

enum Points {
    /// The indices of a sequence from `next` on, and before `end`.
    Walked { next: u64, end: u64 },
    /// The valid tests of a set.
    Listed(std::vec::IntoIter<Point>),
}

/// Returns a deal of `len` points in which each row's block has enough points for the tests that keep the constraints.
pub(crate) fn roomy(deal: Deal, len: u64) -> Deal {
    let all = len / deal.rows;
    if deal.rows == 1 {
        return Deal { block: all, budget: u64::MAX, ..deal };
    }
    let enough = deal.block.saturating_mul(POINTS_PER_TEST).checked_next_power_of_two().unwrap_or(u64::MAX);
    Deal { block: enough.min(all).max(deal.block), budget: u64::MAX, ..deal }
}

impl ValidRows {
    /// Makes the generator of the tests of a request. It ends after `tests` tests.
    ///
    /// # Errors
    /// A set with enough points cannot be made.
    pub(crate) fn new(
        request: &Request,
        family: Family,
        points: RowPoints,
        tests: u64,
        share: &Share,
    ) -> Result<Self, GeneratorError> {
        if let RowPoints::Sets { build, seed } = points {
            build(request.space.dims(), seed, Deal::new(family.len(), share.proposals(request.budget) as u64))?;
        }
        let (space, seed) = (request.space.clone(), request.seed.unwrap_or(0));
        let per_test = [share.probes, share.valid.max(1)];
        Ok(Self { space, family, points, seed, left: tests, per_test, turns: None, drawn: 0 })
    }

    /// Returns the rows that have a test, each with its points.
    fn rows(&mut self) -> VecDeque<Row> {
        let mut possible = Vec::new();
        for number in 0..self.family.len() {
            if possible.len() as u64 >= self.left {
                break;
            }
            let discrete = self.family.row(number);
            if !self.points.fills() || self.drawn(&discrete).is_some() {
                possible.push((number, discrete));
            }
        }
        let deal = Deal::new(possible.len().max(1) as u64, self.left);
        let row = |(place, (number, discrete)): (usize, (u64, Vec<usize>))| {
            let points = match &self.points {
                RowPoints::Walked { first, block, .. } => {
                    let next = first.saturating_add(number.saturating_mul(*block));
                    Points::Walked { next, end: next.saturating_add(*block) }
                }
                RowPoints::Sets { build, seed } => {
                    let wanted = deal.tests_of(place as u64) as usize;
                    let expected = wanted.saturating_mul(self.per_test[0]) / self.per_test[1];
                    let tests = sized(wanted, expected, |size| {
                        let set = build(self.space.dims(), *seed, Deal::of_row(number, size as u64)).ok()?;
                        let test = |index| Point { continuous: set.point(index), discrete: discrete.clone() };
                        Some((0..size as u64).map(test).filter(|test| self.space.allows(test)).collect())
                    });
                    Points::Listed(tests.into_iter())
                }
            };
            Row { discrete, points }
        };
        possible.into_iter().enumerate().map(row).collect()
    }

    /// Returns the next valid test of a row; `None` if none was found.
    fn next_of(&mut self, row: &mut Row) -> Option<Point> {
        let found = match (&mut row.points, &self.points) {
            (Points::Walked { next, end }, RowPoints::Walked { sequence, .. }) => {
                let last = (*end).min(next.saturating_add(MOST_REFUSED as u64)).min(sequence.len());
                let test = |index| Point { continuous: sequence.point(index), discrete: row.discrete.clone() };
                let found = (*next..last).map(|index| (index, test(index))).find(|(_, test)| self.space.allows(test));
                *next = found.as_ref().map_or(last, |(index, _)| index + 1);
                found.map(|(_, test)| test)
            }
            (Points::Listed(tests), _) => tests.next(),
            (Points::Walked { .. }, RowPoints::Sets { .. }) => unreachable!("sets are listed"),
        };
        if found.is_none() && self.points.fills() { self.drawn(&row.discrete) } else { found }
    }

    /// Returns a random valid test of a row; `None` if none was found.
    fn drawn(&mut self, discrete: &[usize]) -> Option<Point> {
        let mut rng = seeded(self.seed, Purpose::Redraws, self.drawn);
        self.drawn += 1;
        let dims = self.space.dims();
        (0..MOST_DRAWS).find_map(|_| {
            let continuous = (0..dims).map(|_| rng.random()).collect();
            Some(Point { continuous, discrete: discrete.to_vec() }).filter(|test| self.space.allows(test))
        })
    }
}

impl RowPoints {
    /// Returns `true` if random points may stand in for the points of a row.
    fn fills(&self) -> bool {
        match self {
            Self::Walked { fills, .. } => *fills,
            Self::Sets { .. } => true,
        }
    }
}

impl Generator for ValidRows {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        if n == 0 {
            return Vec::new();
        }
        let mut turns = self.turns.take().unwrap_or_else(|| self.rows());
        let mut tests = Vec::new();
        while tests.len() < n && self.left > 0 {
            let Some(mut row) = turns.pop_front() else { break };
            // A row without another test loses its turn.
            let Some(test) = self.next_of(&mut row) else { continue };
            tests.push(test);
            self.left -= 1;
            turns.push_back(row);
        }
        self.turns = Some(turns);
        tests
    }
}
