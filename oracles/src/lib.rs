//! What a run leaves behind, and what is asked of it.
//!
//! A run yields a [`Trace`]: named signals, sampled once per tick. A [`Requirement`] asks a [`Formula`] of it
//! and answers twice: with a [`Truth`], from the Boolean meaning of the formula, and with a robustness, how far
//! the trace is from the other answer, in the unit of the requirement. The crate judges; it simulates nothing
//! and writes no file.
//!
//! # What formulas mean
//!
//! The logic is signal temporal logic with its past, the semantics that of Donzé and Maler ("Robust satisfaction of
//! temporal logic over real-valued signals", FORMATS 2010) on the samples of the trace. At the tick of time `t`
//!
//! | formula | robustness |
//! | --- | --- |
//! | `x < y`, `x <= y` | `y - x` |
//! | `x > y`, `x >= y` | `x - y` |
//! | `x == y` | `-abs(x - y)`; `!=` the opposite |
//! | `flag`, `true`, `false` | infinite: a truth has no distance to the other |
//! | `not p` | the opposite |
//! | `p and q`, `p or q`, `p -> q` | the lesser, the greater, that of `(not p) or q` |
//! | `always[a,b] p`, `eventually[a,b] p` | the least, the greatest of `p` over `[t+a, t+b]` |
//! | `historically[a,b] p`, `once[a,b] p` | the same over `[t-b, t-a]` |
//! | `p until[a,b] q` | the greatest, over `s` in `[t+a, t+b]`, of the lesser of `q` at `s` and the least of `p` over `[t, s)` |
//! | `p since[a,b] q` | the same back in time: `s` in `[t-b, t-a]`, and `p` over `(s, t]` |
//! | `p release[a,b] q` | that of `not ((not p) until[a,b] (not q))` |
//!
//! The least of nothing is infinity, the greatest minus infinity. The truth is that of the same formula read with
//! truths for numbers. Where the robustness is not 0 its sign is the truth; 0 alone decides nothing.
//!
//! **Where the trace ends.** Before time 0 there was nothing: operators of the past see only what is in the trace. What
//! would have come after the last sample is unknown, with one exception: an operator *without* a later bound runs to
//! the end of a trace that is complete ([`Trace::finish`]), where nothing more will happen. Hence `always p` holds of a
//! complete trace whose samples all satisfy `p`, and `eventually p` is violated by one of which none does, while
//! `always[0,5] p` one second before the end is undecided if it is not violated yet. An [`Evaluation`] says what holds
//! whatever might have followed ([`Truth`], and the bounds of the robustness), and the robustness by what was recorded:
//! there, windows are cut off at the end of the trace.
//!
//! **Numbers.** Arithmetic is that of IEEE 754. Infinite samples are numbers; a sample that is NaN, or an expression
//! without a value such as 0 / 0, is an error if the formula depends on it.

mod atom;
mod comparison;
mod core;
mod dense;
mod error;
mod evaluate;
mod evaluation;
mod fold;
mod formula;
mod interval;
mod offline;
mod online;
mod parse;
mod print;
mod requirement;
mod ticks;
mod trace;
mod verdict;
mod worth;

pub use comparison::Comparison;
pub use error::EvaluationError;
pub use evaluation::{Cause, Evaluation, Semantics};
pub use formula::{Arithmetic, Connective, Expression, Formula, Modality, Sequence, flag, signal};
pub use interval::Interval;
pub use online::Monitor;
pub use parse::ParseError;
pub use requirement::Requirement;
pub use trace::Trace;
pub use verdict::{Truth, Verdict};
