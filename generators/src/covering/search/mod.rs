//! Smaller covering arrays by local search.
//!
//! A row is dropped, and entries of the others are changed until everything is covered again; then the next. As
//! in TCA (Lin, Luo, Cai, Su, Hao, Zhang, *TCA: an efficient two-mode meta-heuristic algorithm for combinatorial
//! test generation*, ASE 2015) each step covers one missing combination, by the change of an entry that was not
//! changed lately and after which the fewest are missing. What a change uncovers is never counted anew: every
//! cell knows how many rows cover it and the exclusive or of their numbers, thus the row where it is only one,
//! and every entry knows how many cells its row alone covers with it.

mod cells;
mod state;
mod tally;

pub(super) use cells::{Cells, Orbits};
pub(super) use state::Annealing;
