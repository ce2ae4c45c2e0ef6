//! Chooses levels for the entries that no combination needs.
//!
//! These entries are free, so they are chosen to make the rows differ: each gets the level that stood least often
//! beside the rest of its row. The beginning of the list of rows then covers more, and the whole covers more
//! combinations of higher strength.

use super::rows::{Columns, OPEN, Rows};
use paracosm_coverage::Deadline;

/// The greatest number of all levels for which pairs of levels are counted; beyond it only single levels are counted.
const MOST_LEVELS: usize = 1 << 11;

/// Gives every open entry of the rows a level that the constraints allow. Stops if the deadline passes.
pub(super) fn fill(columns: &Columns, rows: &mut Rows, deadline: Deadline) {
    let mut seen = Seen::new(&columns.levels);
    for index in 0..rows.len() {
        if deadline.passed() {
            return;
        }
        for column in 0..columns.len() {
            if rows.row(index)[column] != OPEN {
                continue;
            }
            let row = rows.row(index);
            let allowed = columns.allowed(column, row);
            let levels = (0..columns.levels[column]).filter(|&level| allowed.as_ref().is_none_or(|a| a[level]));
            let level = levels.min_by_key(|&level| seen.beside(row, column, level)).expect("a row can be completed");
            rows.row_mut(index)[column] = level as u32;
        }
        seen.add(rows.row(index));
    }
}

/// Counts how often levels, or pairs of levels, have been seen.
struct Seen {
    first: Vec<usize>,
    all: usize,
    pairs: bool,
    counts: Vec<u32>,
}

impl Seen {
    fn new(levels: &[usize]) -> Self {
        let all: usize = levels.iter().sum();
        let pairs = all <= MOST_LEVELS;
        let first = levels.iter().scan(0, |end, levels| {
            *end += levels;
            Some(*end - levels)
        });
        Self { first: first.collect(), all, pairs, counts: vec![0; if pairs { all * all } else { all }] }
    }

    /// The number of times that a level stood beside the fixed entries of a row.
    fn beside(&self, row: &[u32], column: usize, level: usize) -> u64 {
        let entry = self.first[column] + level;
        if !self.pairs {
            return u64::from(self.counts[entry]);
        }
        let counts = &self.counts[entry * self.all..(entry + 1) * self.all];
        let fixed = row.iter().zip(&self.first).filter(|(level, _)| **level != OPEN);
        fixed.map(|(&level, first)| u64::from(counts[first + level as usize])).sum()
    }

    fn add(&mut self, row: &[u32]) {
        let entries: Vec<usize> = row.iter().zip(&self.first).map(|(&level, first)| first + level as usize).collect();
        for &entry in &entries {
            if self.pairs {
                let counts = &mut self.counts[entry * self.all..(entry + 1) * self.all];
                entries.iter().for_each(|&other| counts[other] += 1);
            } else {
                self.counts[entry] += 1;
            }
        }
    }
}
