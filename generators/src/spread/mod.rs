//! Gives every discrete row as many points as it needs: sets that are (k, epsilon)-covering in the paper's sense.
//!
//! Section 3.1 demands of every row that its own continuous points leave no empty box above epsilon. No bound tells
//! how many points that takes, so it is measured. Every row chooses among several sets, which grow side by side: the
//! block of the sequence that [`Deal`] gives it, and copies that are each shifted in their own way. A row's hole is
//! the largest hole of its best set, at the number of points that the row has so far.
//!
//! The next point goes to the row with the largest hole, until no hole is above epsilon or the budget is spent. With
//! these sets no other way does better: a row's hole never grows with its points, so the largest hole shrinks only if
//! its row gets a point. Hence, without a budget there are as few tests as these sets allow, and with a budget no row
//! is left worse than with equal shares. That is true as long as the boxes fit in memory ([`row`]); beyond that it is
//! only likely.
//!
//! Random points are chosen in this way too: a user who asks for an epsilon does not ask for independent points.
//!
//! If constraints depend on continuous parameters, a set leaves out the points that break them, and a hole is what a box has
//! of the valid part of its row.
//!
//! A row's set is known only when the row gets no more points, so everything is planned before the first test. The
//! tests that split the largest holes come first, so that a campaign that is stopped early has visited all rows.

mod row;

use crate::deal::Deal;
use crate::seeded::mix;
use crate::sequence::{PerRow, Sequence};
use crate::strategy::MethodKind;
use crate::{Generator, GeneratorError, Request, Strategy, family::Family, greedy::GreedyRows};
use paracosm_coverage::valid::{Effort, Validity};
use paracosm_space::Point;
use row::{Added, Limits, Row, Set};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// The number of sets that a row chooses from, and the greatest number of sets of all rows together.
const SETS: u64 = 16;
const MOST_SETS: u64 = 1 << 14;

/// The length of a row's block if the budget does not determine it.
const LONG: u64 = 1 << 20;

/// A generator that adds tests to the row with the largest hole, until no hole is above epsilon.
pub(crate) struct Spread {
    /// The work to be planned; `None` once it is planned.
    plan: Option<Plan>,
    planned: Planned,
}

/// The tests to come.
#[derive(Default)]
struct Planned {
    rows: Vec<(Vec<usize>, Set)>,
    /// For each test, its row and the number of its point in the row's set.
    tests: std::vec::IntoIter<(usize, u64)>,
}

impl Spread {
    /// Makes the generator from the points of `strategy` and the rows of `family`, which are all different. Points of
    /// `existing` tests count.
    ///
    /// # Errors
    /// Epsilon is not in (0, 1), or the strategy makes sets of a size that must be known beforehand, or it has no
    /// point at index `first`.
    pub(crate) fn new(
        strategy: Strategy,
        request: &Request,
        family: &Family,
        first: u64,
        epsilon: f64,
    ) -> Result<Self, GeneratorError> {
        if !(epsilon > 0.0 && epsilon < 1.0) {
            return Err(GeneratorError::Epsilon(epsilon));
        }
        if !strategy.goes_on() {
            return Err(GeneratorError::Sized { strategy: strategy.name() });
        }
        let sets = Sets::new(strategy, request, family, first);
        let len = sets.plain.len();
        if first >= len {
            return Err(GeneratorError::IndexLimit { strategy: strategy.name(), len, last: first });
        }
        let mut existing = family.points_of_rows(request.existing);
        let dims = request.space.dims();
        let limits = Limits::new(request.space, family.len(), epsilon, request.deadline);
        let rules = request.space.rules()?;
        let validity = Validity::of(request.space, &rules);
        let effort = Effort::for_parts(family.len());
        let row = |number| {
            let (discrete, existing) = (family.row(number), existing.remove(&number).unwrap_or_default());
            let valid = validity.as_ref().map(|validity| validity.of_row(&discrete, effort));
            Row::new(dims, discrete, valid, existing, &limits)
        };
        let rows = (0..family.len()).map(row).collect();
        let plan = Plan { rows, sets, budget: request.budget, limits };
        Ok(Self { plan: Some(plan), planned: Planned::default() })
    }
}

impl Generator for Spread {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        if let Some(plan) = self.plan.take() {
            self.planned = plan.carry_out();
        }
        let Planned { rows, tests } = &mut self.planned;
        let test = |(row, number): (usize, u64)| {
            let (discrete, set) = &rows[row];
            Point { continuous: set.point(number), discrete: discrete.clone() }
        };
        tests.take(n).map(test).collect()
    }
}

/// The rows before they have their points.
struct Plan {
    rows: Vec<Row>,
    sets: Sets,
    budget: usize,
    limits: Limits,
}

impl Plan {
    /// Gives points to the row with the largest hole as long as necessary. Then determines the set of each row, and
    /// the order of the tests.
    fn carry_out(mut self) -> Planned {
        // Volumes are not below 0, so that their bits have their order. Among rows with equal holes, the one with the
        // fewest points comes next, then the first.
        let key = |number: usize, row: &Row| (row.hole().to_bits(), Reverse((row.points(), number)));
        let mut open = BinaryHeap::new();
        for (number, row) in self.rows.iter_mut().enumerate() {
            if !row.is_enough(&self.limits) {
                open.push(key(number, row));
            }
        }
        for _ in 0..self.budget {
            if self.limits.deadline.passed() {
                break;
            }
            let Some((_, Reverse((_, number)))) = open.pop() else { break };
            let row = &mut self.rows[number];
            if row.points() == 0 {
                row.choose_from(self.sets.of_row(number as u64));
            }
            if row.grow(&self.limits) {
                open.push(key(number, row));
            }
        }
        let mut tests = Vec::new();
        let mut rows = Vec::new();
        for (number, (discrete, chosen)) in self.rows.into_iter().map(Row::chosen).enumerate() {
            let Some((set, added)) = chosen else { continue };
            tests.extend(added.into_iter().map(|Added { number: point, hole }| (hole, point, number, rows.len())));
            rows.push((discrete, set));
        }
        tests.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let tests: Vec<(usize, u64)> = tests.into_iter().map(|(_, point, _, row)| (row, point)).collect();
        Planned { rows, tests: tests.into_iter() }
    }
}

/// The sets of points that rows choose from.
struct Sets {
    strategy: Strategy,
    dims: usize,
    seed: u64,
    /// The sequence, in which every row has its own block.
    plain: Arc<dyn Sequence>,
    first: u64,
    block: u64,
    /// The number of shifted copies that a row has as well.
    copies: u64,
}

impl Sets {
    fn new(strategy: Strategy, request: &Request, family: &Family, first: u64) -> Self {
        let (dims, seed) = (request.space.dims(), request.seed.unwrap_or(0));
        let long = Deal { rows: family.len(), block: LONG, budget: u64::MAX, from: 0 };
        let (plain, deal): (Arc<dyn Sequence>, Deal) = match strategy.kind() {
            // Greedy points belong to one row, whose number selects it.
            MethodKind::Holes(make) => {
                let rows = GreedyRows::new(make, dims, seed, family.points_of_rows(request.existing));
                (Arc::new(PerRow::new(long, rows)), long)
            }
            _ => {
                let sequence = strategy.sequence(dims, request.seed).expect("strategies that go on have a sequence");
                let deal = Deal::new(family.len(), request.budget as u64);
                (sequence.into(), if request.budget == usize::MAX { long } else { deal })
            }
        };
        // One greedy set is about as good as another, and takes long.
        let sets = if strategy.fills_holes() { 1 } else { SETS.min(MOST_SETS / family.len()).max(1) };
        Self { strategy, dims, seed, plain, first, block: deal.block, copies: sets - 1 }
    }

    fn of_row(&self, row: u64) -> Vec<Set> {
        let block = Set { sequence: self.plain.clone(), first: self.first + row * self.block };
        let copy = |copy: u64| {
            let seed = mix(self.seed ^ mix(row) ^ mix(mix(copy)));
            let sequence = self.strategy.sequence(self.dims, Some(seed)).expect("one that can be copied");
            Set { sequence: sequence.into(), first: self.first }
        };
        [block].into_iter().chain((1..=self.copies).map(copy)).collect()
    }
}
