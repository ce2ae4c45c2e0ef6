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

/// A cell that no row covers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Missing {
    pub(super) family: u16,
    pub(super) cell: u32,
    pub(super) chosen: Chosen,
    /// A combination of the cell, by the chosen places.
    pub(super) levels: [u32; MOST_STRENGTH],
}

/// The cells of all families, one family after the other, with the counts that follow from them.
#[derive(Debug, Clone)]
pub(super) struct Tally {
    parameters: usize,
    begin: Vec<usize>,
    cells: Vec<Cell>,
    /// The cells without a row that are demanded.
    pub(super) missing: Vec<Missing>,
    /// The number of cells that only this row covers: with each of its entries, and then in all.
    alone: Vec<u32>,
}

impl Tally {
    /// Makes a tally in which nothing is covered and nothing is demanded.
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

    /// The number of cells that would be missing without an entry.
    #[inline(always)]
    pub(super) fn alone(&self, row: usize, parameter: usize) -> u32 {
        self.alone[row * (self.parameters + 1) + parameter]
    }

    /// The number of cells that would be missing without a row.
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

    /// Counts a row of the start for a cell.
    #[inline(always)]
    pub(super) fn count(&mut self, family: usize, row: usize, cell: usize) {
        let cell = &mut self.cells[self.begin[family] + cell];
        cell.count += 1;
        cell.rows ^= row as u16;
    }

    /// Counts a row as alone at a cell, if it is. All rows of the start must have been counted before.
    #[inline(always)]
    pub(super) fn claim(&mut self, family: usize, cells: &Cells, row: usize, cell: usize, chosen: &Chosen) {
        if self.cells[self.begin[family] + cell].count == 1 {
            self.count_alone(row, cells, chosen, 1);
        }
    }

    /// Notes that a row now covers a cell.
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

    /// Notes that a row with these levels no longer covers a cell.
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

    /// Demands a cell that no row covers.
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
