//! Finds smaller covering arrays by local search.
//!
//! A row is dropped, and entries of the others are changed until everything is covered again; then the next row is
//! dropped. As in TCA (Lin, Luo, Cai, Su, Hao, Zhang, *TCA: an efficient two-mode meta-heuristic algorithm for
//! combinatorial test generation*, ASE 2015), each step covers one missing combination. It changes an entry that was
//! not changed lately, so that the fewest combinations are missing afterwards. The combinations that a change
//! uncovers are never counted again. Every cell knows the number of rows that cover it and the exclusive or of their
//! numbers, which is the row itself if there is only one. Every entry knows how many cells only its row covers with
//! it.

mod cells;
mod state;
mod tally;

pub(super) use cells::{Cells, Orbits};
pub(super) use state::Annealing;
