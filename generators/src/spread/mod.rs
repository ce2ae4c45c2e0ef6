//! As many points for every discrete row as it takes: sets that are (k, epsilon)-covering in the paper's sense.
//!
//! Section 3.1 asks of every row that its own continuous points leave no empty box above epsilon. How many points that
//! takes no bound tells, so it is measured. Every row has several sets to choose from, which grow side by side: the
//! block of the sequence that [`Deal`] gives it, and copies that are shifted each in its own way. A row's hole is that of
//! the set with the smallest, at the number of points that the row has by now.
//!
//! The next point goes to the row with the largest hole, until none is above epsilon or the budget is spent. Of these
//! sets nothing does better: a row's hole never grows with its points, so whoever wants the largest hole smaller has
//! to give the row that has it a point. Hence without a budget there are as few tests as these sets allow, and under one
//! no row is left worse than with equal shares. That is true as long as the boxes fit in memory ([`row`]); beyond, it is
//! no more than likely.
//!
//! Random points are chosen in this way too: whoever asks for an epsilon does not ask for independent ones.
//!
//! Which set a row uses is known only when it gets no more points, so all is planned before the first test. Of what was
//! planned the tests come first that split the largest holes: a campaign that is stopped has looked at all rows.

mod row;

use crate::deal::Deal;
use crate::seeded::mix;
use crate::sequence::{PerRow, Sequence};
use crate::{Generator, GeneratorError, Request, Strategy, family::Family, greedy::GreedyRows};
use paracosm_space::Point;
use row::{Limits, Row, Set};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// How many sets a row chooses from, and how many there are for all rows if these are many.
const SETS: u64 = 16;
const MOST_SETS: u64 = 1 << 14;

/// The length of a row's block where the budget does not say one.
const LONG: u64 = 1 << 20;

/// Tests that go where the largest hole is, until none is above epsilon.
pub(crate) struct Spread {
    /// What is to be planned; nothing once it is.
    plan: Option<Plan>,
    planned: Planned,
}

/// The tests to come.
#[derive(Default)]
struct Planned {
    rows: Vec<(Vec<usize>, Set)>,
    /// For each test its row and the number of its point.
    tests: std::vec::IntoIter<(usize, u64)>,
}

impl Spread {
    /// Points of `strategy` for the rows of `family`, no two of which are alike; those that `existing` tests have count.
    ///
    /// # Errors
    /// Epsilon is not in (0, 1), the strategy makes sets of a size that has to be known beforehand, or has no point at
    /// index `first`.
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
        let limits = Limits::new(dims, family.len(), epsilon, request.deadline);
        let row = |number| Row::new(dims, family.row(number), existing.remove(&number).unwrap_or_default(), &limits);
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
    /// Gives points to the row with the largest hole for as long as it takes; then says what set each row has, and the
    /// order of the tests.
    fn carry_out(mut self) -> Planned {
        // Volumes are not below 0, and their bits are in their order. Of rows alike the one with the fewest points comes
        // next, then the first.
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
            let Some((set, holes)) = chosen else { continue };
            tests.extend(holes.into_iter().enumerate().map(|(point, hole)| (hole, point as u64, number, rows.len())));
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
    /// The sequence of which every row has a block that no other row touches.
    plain: Arc<dyn Sequence>,
    first: u64,
    block: u64,
    /// How many shifted copies a row has besides.
    copies: u64,
}

impl Sets {
    fn new(strategy: Strategy, request: &Request, family: &Family, first: u64) -> Self {
        let (dims, seed) = (request.space.dims(), request.seed.unwrap_or(0));
        let long = Deal { rows: family.len(), block: LONG, budget: u64::MAX };
        let (plain, deal): (Arc<dyn Sequence>, Deal) = match strategy.sequence(dims, request.seed) {
            Some(sequence) if request.budget == usize::MAX => (sequence.into(), long),
            Some(sequence) => (sequence.into(), Deal::new(family.len(), request.budget as u64)),
            // Greedy points are those of one row, whose number says which.
            None => {
                let rows = GreedyRows::new(dims, seed, family.points_of_rows(request.existing));
                (Arc::new(PerRow::new(long, rows)), long)
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
