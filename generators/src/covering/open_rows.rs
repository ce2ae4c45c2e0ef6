//! Finds a row that has room for a combination.
//!
//! For each entry there is a set of the rows that have it, and for each column a set of the rows in which it is open,
//! with a bit for each row. A row has room for a combination if it is in one of the two sets for each entry of the
//! combination.

use super::rows::{Columns, OPEN, Rows};

/// The greatest number of bits of all sets. Older rows beyond it are left out, because they are full or nearly full.
const MOST_BITS: usize = 1 << 26;

/// An index of the rows with open entries that have, or may get, a given level in the newest column.
#[derive(Debug)]
pub(super) struct OpenRows {
    columns: usize,
    first: Vec<usize>,
    /// The positions of the rows.
    rows: Vec<usize>,
    /// For each entry, the rows that have it. Of the newest column there is one entry, that of the given level.
    has: Vec<Vec<u64>>,
    /// For each column, the rows in which it is open.
    open: Vec<Vec<u64>>,
}

impl OpenRows {
    pub(super) fn new(columns: &Columns, rows: &Rows, column: usize, level: u32) -> Self {
        let first: Vec<usize> = std::iter::once(0)
            .chain(columns.levels[..=column].iter().scan(0, |bits, levels| {
                *bits += levels;
                Some(*bits)
            }))
            .collect();
        let entries = first[column + 1];
        let with_room = |row: &[u32]| row[..=column].contains(&OPEN) && (row[column] == OPEN || row[column] == level);
        let newest = (0..rows.len()).rev().filter(|&index| with_room(rows.row(index)));
        let mut found: Vec<usize> = newest.take(MOST_BITS / entries).collect();
        found.reverse();
        let sets = |number: usize| vec![vec![0; found.len().div_ceil(64)]; number];
        let (has, open) = (sets(first[column] + 1), sets(column + 1));
        let mut open = Self { columns: column + 1, first, rows: Vec::new(), has, open };
        found.into_iter().for_each(|index| open.push(index, rows.row(index)));
        open
    }

    fn push(&mut self, index: usize, row: &[u32]) {
        let (word, bit) = (self.rows.len() / 64, 1 << (self.rows.len() % 64));
        if word == self.open[0].len() {
            self.has.iter_mut().chain(&mut self.open).for_each(|set| set.push(0));
        }
        self.rows.push(index);
        for (column, &level) in row[..self.columns].iter().enumerate() {
            let set = match level {
                OPEN => &mut self.open[column],
                level => {
                    let entry = self.entry(column, level);
                    &mut self.has[entry]
                }
            };
            set[word] |= bit;
        }
    }

    /// Puts a combination into the first row that has room for the combination, or into a new row. Returns the row's
    /// position.
    pub(super) fn place(&mut self, columns: &Columns, rows: &mut Rows, combination: &[(usize, u32)]) -> usize {
        if let Some(place) = self.find(columns, rows, combination) {
            let index = self.rows[place];
            for &(column, level) in combination {
                if rows.row(index)[column] == OPEN {
                    rows.row_mut(index)[column] = level;
                    let (word, bit) = (place / 64, 1 << (place % 64));
                    self.open[column][word] &= !bit;
                    let entry = self.entry(column, level);
                    self.has[entry][word] |= bit;
                }
            }
            return index;
        }
        let mut row = vec![OPEN; columns.len()];
        combination.iter().for_each(|&(column, level)| row[column] = level);
        rows.push(&row);
        if row[..self.columns].contains(&OPEN) {
            self.push(rows.len() - 1, &row);
        }
        rows.len() - 1
    }

    /// Returns the position of the set of rows that have a level.
    fn entry(&self, column: usize, level: u32) -> usize {
        self.first[column] + if column + 1 == self.columns { 0 } else { level as usize }
    }

    /// The first row with room for a combination.
    fn find(&self, columns: &Columns, rows: &Rows, combination: &[(usize, u32)]) -> Option<usize> {
        let sets = |&(column, level): &(usize, u32)| (&self.has[self.entry(column, level)], &self.open[column]);
        let sets: Vec<(&Vec<u64>, &Vec<u64>)> = combination.iter().map(sets).collect();
        for word in 0..self.rows.len().div_ceil(64) {
            let mut fits = sets.iter().fold(u64::MAX, |fits, (has, open)| fits & (has[word] | open[word]));
            while fits != 0 {
                let place = word * 64 + fits.trailing_zeros() as usize;
                if keeps(columns, rows.row(self.rows[place]), combination) {
                    return Some(place);
                }
                fits &= fits - 1;
            }
        }
        None
    }
}

/// Returns `true` if a row can still be completed with a combination put into it.
fn keeps(columns: &Columns, row: &[u32], combination: &[(usize, u32)]) -> bool {
    let mut groups: Vec<usize> =
        combination.iter().filter(|pair| row[pair.0] == OPEN).filter_map(|pair| columns.group(pair.0)).collect();
    if groups.is_empty() {
        return true;
    }
    groups.sort_unstable();
    groups.dedup();
    let mut row = row.to_vec();
    combination.iter().for_each(|&(column, level)| row[column] = level);
    groups.into_iter().all(|group| columns.holds(group, &row))
}
