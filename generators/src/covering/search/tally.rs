//! Counts which rows cover which cells.

use super::cells::{Cells, Chosen, MOST_STRENGTH};

#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    /// The number of rows that cover the cell.
    count: u16,
    /// The exclusive or of the numbers of these rows. Without a row, the low bits of the cell's place among the
    /// missing cells.
    rows: u16,
}

/// A demanded cell that no row covers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Missing {
    pub(super) family: u16,
    pub(super) cell: u32,
    pub(super) chosen: Chosen,
    /// The levels of a combination of the cell, in the order of the chosen places.
    pub(super) levels: [u32; MOST_STRENGTH],
}

/// The cells of all families, with the number of rows that cover each cell.
#[derive(Debug, Clone)]
pub(super) struct Tally {
    parameters: usize,
    begin: Vec<usize>,
    cells: Vec<Cell>,
    /// The demanded cells that no row covers.
    pub(super) missing: Vec<Missing>,
    /// The number of cells that only this row covers: with each of its entries, and then in all.
    alone: Vec<u32>,
}

impl Tally {
    /// Makes a tally in which no cell is covered and no cell is demanded.
    pub(super) fn new(families: &[Cells], rows: usize, parameters: usize) -> Self {
        let begin: Vec<usize> = families
            .iter()
            .scan(0, |end, cells| {
                *end += cells.len();
                Some(*end - cells.len())
            })
            .collect();
        let all = families.iter().map(Cells::len).sum();
        Self {
            parameters,
            begin,
            cells: vec![Cell::default(); all],
            missing: Vec::new(),
            alone: vec![0; rows * (parameters + 1)],
        }
    }

    /// Returns the number of cells that would be missing without an entry of a row.
    #[inline(always)]
    pub(super) fn alone(&self, row: usize, parameter: usize) -> u32 {
        self.alone[row * (self.parameters + 1) + parameter]
    }

    /// Returns the number of cells that would be missing without a row.
    pub(super) fn all_alone(&self, row: usize) -> u32 {
        self.alone(row, self.parameters)
    }

    #[inline(always)]
    fn count_alone(&mut self, row: usize, cells: &Cells, chosen: &Chosen, change: u32) {
        let alone = &mut self.alone[row * (self.parameters + 1)..][..=self.parameters];
        for &place in &chosen[..cells.strength] {
            let alone = &mut alone[cells.members[place as usize]];
            *alone = alone.wrapping_add(change);
        }
        alone[self.parameters] = alone[self.parameters].wrapping_add(change);
    }

    /// Counts that a row of the start covers a cell.
    #[inline(always)]
    pub(super) fn count(&mut self, family: usize, row: usize, cell: usize) {
        let cell = &mut self.cells[self.begin[family] + cell];
        cell.count += 1;
        cell.rows ^= row as u16;
    }

    /// Counts a cell for a row of the start, if no other row covers the cell. All rows of the start must have been
    /// counted before.
    #[inline(always)]
    pub(super) fn claim(&mut self, family: usize, cells: &Cells, row: usize, cell: usize, chosen: &Chosen) {
        if self.cells[self.begin[family] + cell].count == 1 {
            self.count_alone(row, cells, chosen, 1);
        }
    }

    /// Updates the counts after a row has begun to cover a cell.
    #[inline(always)]
    pub(super) fn enter(&mut self, family: usize, cells: &Cells, row: usize, cell: usize, chosen: &Chosen) {
        let at = self.begin[family] + cell;
        let state = self.cells[at];
        let rows = match state.count {
            0 => {
                self.remove_missing(family, cell, state.rows as usize);
                self.count_alone(row, cells, chosen, 1);
                row as u16
            }
            1 => {
                self.count_alone(state.rows as usize, cells, chosen, 1u32.wrapping_neg());
                state.rows ^ row as u16
            }
            _ => state.rows ^ row as u16,
        };
        self.cells[at] = Cell { count: state.count + 1, rows };
    }

    /// Updates the counts after a row with the given levels has stopped covering a cell.
    #[inline(always)]
    pub(super) fn leave(
        &mut self,
        family: usize,
        cells: &Cells,
        row: usize,
        levels: &[usize],
        cell: usize,
        chosen: &Chosen,
    ) {
        let at = self.begin[family] + cell;
        let state = &mut self.cells[at];
        state.count -= 1;
        state.rows ^= row as u16;
        match *state {
            Cell { count: 0, .. } => {
                self.count_alone(row, cells, chosen, 1u32.wrapping_neg());
                self.add_missing(family, cells, levels, cell, chosen);
            }
            Cell { count: 1, rows } => self.count_alone(rows as usize, cells, chosen, 1),
            Cell { .. } => {}
        }
    }

    /// Adds a cell that no row covers to the missing cells.
    pub(super) fn add_missing(&mut self, family: usize, cells: &Cells, row: &[usize], cell: usize, chosen: &Chosen) {
        let mut levels = [0; MOST_STRENGTH];
        for (level, &place) in levels.iter_mut().zip(&chosen[..cells.strength]) {
            *level = row[cells.members[place as usize]] as u32;
        }
        self.cells[self.begin[family] + cell].rows = self.missing.len() as u16;
        self.missing.push(Missing { family: family as u16, cell: cell as u32, chosen: *chosen, levels });
    }

    /// Returns `true` if no row covers a cell.
    pub(super) fn is_missing(&self, family: usize, cell: usize) -> bool {
        self.cells[self.begin[family] + cell].count == 0
    }

    fn remove_missing(&mut self, family: usize, cell: usize, low_bits: usize) {
        let is = |missing: &Missing| missing.family as usize == family && missing.cell as usize == cell;
        let places = (low_bits..self.missing.len()).step_by(1 << 16);
        let Some(place) = places.into_iter().find(|&place| is(&self.missing[place])) else { return };
        self.missing.swap_remove(place);
        if let Some(moved) = self.missing.get(place) {
            self.cells[self.begin[moved.family as usize] + moved.cell as usize].rows = place as u16;
        }
    }
}
