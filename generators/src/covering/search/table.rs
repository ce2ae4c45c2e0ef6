//! A tally with a counter for each cell: the number of rows that cover the cell, and the exclusive or of their
//! numbers, which is the row itself if there is only one. A visit of a cell is a visit of the table, so that this
//! tally is fast as long as the table is small.

use super::cells::{Cells, Chosen};
use super::having::Having;
use super::tally::{Alone, Families, Missing, Tally, Turn};

#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    /// The number of rows that cover the cell.
    count: u16,
    /// The exclusive or of the numbers of these rows. Without a row, the low bits of the cell's place among the
    /// missing cells.
    rows: u16,
}

/// The number of rows that cover each cell of all families.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    begin: Vec<usize>,
    cells: Vec<Cell>,
    missing: Vec<Missing>,
    alone: Alone,
}

impl Tally for Table {
    fn new(families: &Families, rows: &[Vec<usize>], _: &Having) -> Self {
        let begin = families.cells.iter().scan(0, |end, cells| {
            *end += cells.len();
            Some(*end - cells.len())
        });
        let all = families.cells.iter().map(Cells::len).sum();
        let mut table = Self {
            begin: begin.collect(),
            cells: vec![Cell::default(); all],
            missing: Vec::new(),
            alone: Alone::new(rows.len(), families.of.len()),
        };
        for (index, row) in rows.iter().enumerate() {
            for (family, cells) in families.cells.iter().enumerate() {
                cells.each(row, None, &mut |cell, _| {
                    let cell = &mut table.cells[table.begin[family] + cell];
                    cell.count += 1;
                    cell.rows ^= index as u16;
                });
            }
        }
        for (index, row) in rows.iter().enumerate() {
            for (family, cells) in families.cells.iter().enumerate() {
                cells.each(row, None, &mut |cell, chosen| {
                    if table.cells[table.begin[family] + cell].count == 1 {
                        table.alone.begin(index, cells, chosen);
                    }
                });
            }
        }
        table
    }

    fn missing(&self) -> &[Missing] {
        &self.missing
    }

    fn alone(&self) -> &Alone {
        &self.alone
    }

    fn leave(&mut self, turn: Turn, changed: &[(usize, usize)]) {
        each_changed(turn, changed, &mut |family, cells, cell, chosen| {
            self.leave_cell(family, cells, turn, cell, chosen);
        });
    }

    fn enter(&mut self, turn: Turn, changed: &[(usize, usize)]) {
        each_changed(turn, changed, &mut |family, cells, cell, chosen| {
            self.enter_cell(family, cells, turn.index, cell, chosen);
        });
    }

    fn leave_all(&mut self, turn: Turn) {
        for (family, cells) in turn.families.cells.iter().enumerate() {
            cells.each(turn.row, None, &mut |cell, chosen| self.leave_cell(family, cells, turn, cell, chosen));
        }
    }
}

/// Calls `call` with each cell of a row that has one of the changed entries.
#[inline(always)]
fn each_changed(turn: Turn, changed: &[(usize, usize)], call: &mut impl FnMut(usize, &Cells, usize, &Chosen)) {
    // A cell with several of the entries is visited only for the first of them.
    let is_first = |cells: &Cells, chosen: &Chosen, i: usize| {
        i == 0 || {
            let mut members = chosen[..cells.strength].iter().map(|&place| cells.members[place as usize]);
            !members.any(|member| changed[..i].iter().any(|change| change.0 == member))
        }
    };
    for (i, &(parameter, _)) in changed.iter().enumerate() {
        for &(family, place) in &turn.families.of[parameter] {
            let cells = &turn.families.cells[family];
            cells.each(turn.row, Some(place), &mut |cell, chosen| {
                if is_first(cells, chosen, i) {
                    call(family, cells, cell, chosen);
                }
            });
        }
    }
}

impl Table {
    #[inline(always)]
    fn enter_cell(&mut self, family: usize, cells: &Cells, row: usize, cell: usize, chosen: &Chosen) {
        let at = self.begin[family] + cell;
        let state = self.cells[at];
        let rows = match state.count {
            0 => {
                self.remove_missing(family, cell, state.rows as usize);
                self.alone.begin(row, cells, chosen);
                row as u16
            }
            1 => {
                self.alone.end(state.rows as usize, cells, chosen);
                state.rows ^ row as u16
            }
            _ => state.rows ^ row as u16,
        };
        self.cells[at] = Cell { count: state.count + 1, rows };
    }

    #[inline(always)]
    fn leave_cell(&mut self, family: usize, cells: &Cells, turn: Turn, cell: usize, chosen: &Chosen) {
        let at = self.begin[family] + cell;
        let state = &mut self.cells[at];
        state.count -= 1;
        state.rows ^= turn.index as u16;
        match *state {
            Cell { count: 0, .. } => {
                self.alone.end(turn.index, cells, chosen);
                self.add_missing(Missing::new(family, cells, turn.row, cell, chosen));
            }
            Cell { count: 1, rows } => self.alone.begin(rows as usize, cells, chosen),
            Cell { .. } => {}
        }
    }

    /// Demands that the rows cover all cells.
    pub(super) fn demand_all(&mut self, families: &Families, levels: &[usize]) {
        for (family, cells) in families.cells.iter().enumerate() {
            cells.each_cell(levels, &mut |row, cell, chosen| {
                if self.cells[self.begin[family] + cell].count == 0 {
                    self.add_missing(Missing::new(family, cells, row, cell, chosen));
                }
            });
        }
    }

    fn add_missing(&mut self, missing: Missing) {
        self.cells[self.begin[missing.family as usize] + missing.cell as usize].rows = self.missing.len() as u16;
        self.missing.push(missing);
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
