//! Grows an array by IPOG, a column at a time, first to the right, then downwards.
//!
//! Lei, Kacker, Kuhn, Okun, Lawrence, *IPOG/IPOG-D: efficient test generation for multi-way combinatorial testing*,
//! Software Testing, Verification and Reliability 18, 2008. Each row gets the level of the newest column with which
//! it covers most. The combinations that are left are put into entries that are still open, and into new rows. An
//! entry that would cover nothing new stays open.

use super::front::{Bits, Family, Front, Position};
use super::open_rows::OpenRows;
use super::rows::{Columns, OPEN, Rows};
use crate::seeded::mix;
use paracosm_coverage::Deadline;
use paracosm_space::rules::Companions;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The number of rows beyond which a row may come next if it covers half as much as another seems to. Rows are then
/// examined some five times less often, for 4 % more rows.
const HURRY: usize = 4000;

/// The number of rows from which on all cores examine the rows first.
const ROWS_FOR_ALL_CORES: usize = 5000;

/// The level that a row gets, and the number of combinations that it then covers.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Choice {
    gain: u32,
    row: Reverse<usize>,
    level: u32,
}

impl Choice {
    fn index(&self) -> usize {
        self.row.0
    }
}

/// A procedure that grows rows column by column until all families are covered. The first columns may already be
/// covered.
pub(super) struct Growth<'a> {
    pub(super) columns: &'a Columns<'a>,
    pub(super) families: &'a [Family],
    pub(super) seed: u64,
    pub(super) deadline: Deadline,
}

impl Growth<'_> {
    /// Grows the rows by the columns from `begin` on. If the deadline passes, the rows are incomplete and must not be
    /// used.
    pub(super) fn grow(&self, rows: &mut Rows, companions: &mut Companions, begin: usize) {
        for column in begin..self.columns.len() {
            let with_column = self.families.iter().filter(|family| family.members.contains(&column));
            let front = |family| Front::new(self.columns, companions, family, column, self.deadline);
            let mut fronts: Vec<Front> = with_column.filter_map(front).collect();
            if self.deadline.passed() {
                return;
            }
            pulp::Arch::new().dispatch(|| self.grow_right(rows, &mut fronts, column));
            self.grow_down(rows, &mut fronts, column);
        }
    }

    /// Gives rows the levels with which they cover most. The next row is always the row that then covers most.
    ///
    /// The gain of a row never grows while others are chosen. So the rows wait in the order of the gains that they
    /// had when last examined, and only the first is examined again (Minoux, *Accelerated greedy algorithms*, 1978).
    #[inline(always)]
    fn grow_right(&self, rows: &mut Rows, fronts: &mut [Front], column: usize) {
        let mut bits: Vec<Bits> = vec![Vec::new(); fronts.len()];
        let mut gains = vec![0u32; self.columns.levels[column]];
        for index in (0..rows.len()).filter(|&index| rows.row(index)[column] != OPEN) {
            for front in fronts.iter_mut() {
                front.bits_of(rows.row(index), &mut bits[0]);
                front.cover(self.columns, rows.row(index), &bits[0]);
            }
        }
        let first_choice = |bits: &mut [Bits], gains: &mut [u32], index: usize| {
            let row = rows.row(index);
            (row[column] == OPEN && !self.deadline.passed())
                .then(|| self.choice(row, index, fronts, bits, gains, column))
                .flatten()
        };
        let mut waiting: BinaryHeap<Choice> = if rows.len() < ROWS_FOR_ALL_CORES {
            (0..rows.len()).filter_map(|index| first_choice(&mut bits, &mut gains, index)).collect()
        } else {
            let own = || (bits.clone(), gains.clone());
            let choices = (0..rows.len())
                .into_par_iter()
                .map_init(own, |(bits, gains), index| pulp::Arch::new().dispatch(|| first_choice(bits, gains, index)));
            choices.collect::<Vec<_>>().into_iter().flatten().collect()
        };
        let patience = if rows.len() > HURRY { 2 } else { 1 };
        while let Some(choice) = waiting.pop().filter(|_| !self.deadline.passed()) {
            let index = choice.index();
            let Some(choice) = self.choice(rows.row(index), index, fronts, &mut bits, &mut gains, column) else {
                continue;
            };
            if waiting.peek().is_some_and(|next| next.gain > patience * choice.gain) {
                waiting.push(choice);
                continue;
            }
            rows.row_mut(index)[column] = choice.level;
            for (front, bits) in fronts.iter_mut().zip(&bits) {
                front.cover(self.columns, rows.row(index), bits);
            }
        }
    }

    /// The level with which a row covers most; `None` if it covers nothing.
    #[inline(always)]
    fn choice(
        &self,
        row: &[u32],
        index: usize,
        fronts: &[Front],
        bits: &mut [Bits],
        gains: &mut [u32],
        column: usize,
    ) -> Option<Choice> {
        gains.fill(0);
        for (front, bits) in fronts.iter().zip(bits) {
            front.bits_of(row, bits);
            front.gains(self.columns, row, bits, gains);
        }
        if let Some(allowed) = self.columns.allowed(column, row) {
            gains.iter_mut().zip(allowed).filter(|(_, allowed)| !allowed).for_each(|(gain, _)| *gain = 0);
        }
        let gain = gains.iter().copied().max().filter(|&most| most > 0)?;
        let rank = |&level: &usize| {
            let left: u64 = fronts.iter().map(|front| front.left_of(level)).sum();
            (left, mix(self.seed ^ mix((index * gains.len() + level) as u64)))
        };
        let level = (0..gains.len()).filter(|&level| gains[level] == gain).max_by_key(rank)? as u32;
        Some(Choice { gain, row: Reverse(index), level })
    }

    /// Puts the combinations that are left into open entries and new rows.
    fn grow_down(&self, rows: &mut Rows, fronts: &mut [Front], column: usize) {
        let mut bits = Vec::new();
        let mut entries = Vec::new();
        for level in 0..self.columns.levels[column] {
            if fronts.iter().all(|front| front.left_of(level) == 0) {
                continue;
            }
            let mut open = OpenRows::new(self.columns, rows, column, level as u32);
            for leader in 0..fronts.len() {
                let mut position = Position::default();
                while let Some(found) = fronts[leader].next_left(self.columns, level, position, &mut entries) {
                    if self.deadline.passed() {
                        return;
                    }
                    position = found;
                    entries.push((column, level as u32));
                    let index = open.place(self.columns, rows, &entries);
                    let row = rows.row(index);
                    for front in fronts.iter_mut() {
                        front.bits_of(row, &mut bits);
                        front.cover(self.columns, row, &bits);
                    }
                }
            }
        }
    }
}
