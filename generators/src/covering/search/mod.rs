//! Finds smaller covering arrays by local search.
//!
//! A row is dropped, and entries of the others are changed until everything is covered again; then the next row is
//! dropped. As in TCA (Lin, Luo, Cai, Su, Hao, Zhang, *TCA: an efficient two-mode meta-heuristic algorithm for
//! combinatorial test generation*, ASE 2015), each step covers one missing combination. It changes an entry that was
//! not changed lately, so that the fewest combinations are missing afterwards. The combinations that a change
//! uncovers are never counted again: every entry knows how many cells only its row covers with it. Two tallies keep
//! that number up to date: a table with a counter for each cell, and the bits of the rows that have each level.

mod bits;
mod cells;
mod having;
mod state;
mod table;
mod tally;

pub(super) use bits::Bits;
pub(super) use cells::{Cells, Orbits};
pub(super) use state::{Annealing, Tenure};
pub(super) use table::Table;
pub(super) use tally::Tally;
