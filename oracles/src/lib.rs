//! What a run leaves behind, and what is asked of it.
//!
//! A run yields a [`Trace`]: named signals, sampled once per tick. A [`Requirement`] asks a [`Formula`] of it
//! and answers twice: with a [`Truth`], from the Boolean meaning of the formula, and with a robustness, how far
//! the trace is from the other answer, in the unit of the requirement. The crate judges; it simulates nothing
//! and writes no file.

mod formula;
mod requirement;
mod trace;
mod verdict;

pub use formula::{Comparison, Evaluation, Formula, UnknownSignal};
pub use requirement::Requirement;
pub use trace::Trace;
pub use verdict::{Truth, Verdict};
