//! The cells that rows cover, as a search needs to know them.

use super::cells::{Cells, Chosen, MOST_STRENGTH};
use super::having::Having;

/// All families of cells of a search.
#[derive(Debug, Clone)]
pub(crate) struct Families {
    pub(super) cells: Vec<Cells>,
    /// For each parameter, the families that contain it, and its place in each.
    pub(super) of: Vec<Vec<(usize, usize)>>,
}

impl Families {
    pub(super) fn new(cells: Vec<Cells>, parameters: usize) -> Self {
        let mut of = vec![Vec::new(); parameters];
        for (index, family) in cells.iter().enumerate() {
            for (place, &member) in family.members.iter().enumerate() {
                of[member].push((index, place));
            }
        }
        Self { cells, of }
    }
}

/// A demanded cell that no row covers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Missing {
    pub(super) family: u16,
    pub(super) cell: u32,
    pub(super) chosen: Chosen,
    /// The parameters and levels of a combination of the cell, in the order of the chosen places.
    pub(super) entries: [(u32, u32); MOST_STRENGTH],
}

impl Missing {
    pub(super) fn new(family: usize, cells: &Cells, row: &[usize], cell: usize, chosen: &Chosen) -> Self {
        let mut entries = [(0, 0); MOST_STRENGTH];
        for (entry, &place) in entries.iter_mut().zip(&chosen[..cells.strength]) {
            let parameter = cells.members[place as usize];
            *entry = (parameter as u32, row[parameter] as u32);
        }
        Self { family: family as u16, cell: cell as u32, chosen: *chosen, entries }
    }
}

/// A change of a row, as a tally sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn<'a> {
    pub(super) families: &'a Families,
    /// The rows that have each level. The row of the change has the levels of `row`.
    pub(super) having: &'a Having,
    pub(super) index: usize,
    pub(super) row: &'a [usize],
}

/// The cells that are missing, and the cells that only one row covers, kept up to date from change to change.
pub(crate) trait Tally {
    /// Makes the tally of rows. Cells that they do not cover are not demanded.
    fn new(families: &Families, rows: &[Vec<usize>], having: &Having) -> Self;

    /// Returns the demanded cells that no row covers.
    fn missing(&self) -> &[Missing];

    /// Returns the number of cells that only one row covers.
    fn alone(&self) -> &Alone;

    /// Updates the tally before a row loses its levels of the given parameters.
    fn leave(&mut self, turn: Turn, changed: &[(usize, usize)]);

    /// Updates the tally after a row has got other levels of the given parameters.
    fn enter(&mut self, turn: Turn, changed: &[(usize, usize)]);

    /// Updates the tally before a row is dropped.
    fn leave_all(&mut self, turn: Turn);
}

/// The number of cells that only one row covers, for each row: with each of its entries, and then in all.
#[derive(Debug, Clone)]
pub(crate) struct Alone {
    parameters: usize,
    counts: Vec<u32>,
}

impl Alone {
    pub(super) fn new(rows: usize, parameters: usize) -> Self {
        Self { parameters, counts: vec![0; rows * (parameters + 1)] }
    }

    /// Returns the number of cells that would be missing without an entry of a row.
    #[inline(always)]
    pub(super) fn with(&self, row: usize, parameter: usize) -> u32 {
        self.counts[row * (self.parameters + 1) + parameter]
    }

    /// Returns the number of cells that would be missing without a row.
    pub(super) fn in_all(&self, row: usize) -> u32 {
        self.with(row, self.parameters)
    }

    #[inline(always)]
    fn add(&mut self, row: usize, cells: &Cells, chosen: &Chosen, change: u32) {
        let counts = &mut self.counts[row * (self.parameters + 1)..][..=self.parameters];
        for &place in &chosen[..cells.strength] {
            let count = &mut counts[cells.members[place as usize]];
            *count = count.wrapping_add(change);
        }
        counts[self.parameters] = counts[self.parameters].wrapping_add(change);
    }

    /// Counts a cell that only this row covers from now on.
    #[inline(always)]
    pub(super) fn begin(&mut self, row: usize, cells: &Cells, chosen: &Chosen) {
        self.add(row, cells, chosen, 1);
    }

    /// Removes a cell from the counts of a row that no longer covers it alone.
    #[inline(always)]
    pub(super) fn end(&mut self, row: usize, cells: &Cells, chosen: &Chosen) {
        self.add(row, cells, chosen, 1u32.wrapping_neg());
    }
}
