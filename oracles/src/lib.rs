//! Oracles: formulas that judge the trace of a run, with a truth and a robustness.
//!
//! A run gives a [`Trace`]: named signals, sampled once per tick. A [`Requirement`] has a [`Formula`] that the trace
//! should satisfy. Its judgement has two parts. The [`Truth`] is `Holds`, `Violated` or `Undecided`. The
//! robustness is the distance of the trace from the opposite truth, in the unit of the requirement. The crate judges
//! traces; it runs no simulation and writes no file.
//!
//! # The meaning of formulas
//!
//! The logic is signal temporal logic with operators of the past. Its semantics is that of Donzé and Maler ("Robust
//! satisfaction of temporal logic over real-valued signals", FORMATS 2010) on the samples of the trace. At the tick of
//! time `t`, the robustness is:
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
//! The least of no values is infinity, the greatest of no values is minus infinity. The truth results from the same
//! rules with truths instead of numbers. If the robustness is not 0, its sign gives the truth; a robustness of 0 alone
//! decides nothing.
//!
//! **Where the trace ends.** There is nothing before time 0: operators of the past see only the trace. The samples
//! after the last one are unknown, with one exception. If the trace is complete ([`Trace::finish`]), nothing more
//! happens after its end, and an operator *without* a later bound ends there. So `always p` holds on a complete trace
//! if all samples satisfy `p`, and `eventually p` is violated if no sample satisfies `p`. But one second before the
//! end, `always[0,5] p` is undecided unless it is already violated. The [`Truth`] in an [`Evaluation`], and its bounds
//! of the robustness, are valid for every continuation of the trace. Its robustness considers only the recorded
//! samples: windows are cut off at the end of the trace.
//!
//! **Numbers.** Arithmetic follows IEEE 754. Infinite samples are valid numbers. If a formula depends on a sample that
//! is NaN, or on an expression without a value such as 0 / 0, the evaluation fails with an error.
//!
//! ```
//! use paracosm_oracles::{Formula, Trace, Truth};
//!
//! let formula = Formula::parse("always (speed < 13)", &["speed"])?;
//! let mut trace = Trace::new(0.5, vec!["speed".to_owned()]);
//! [10.0, 12.5, 11.0].iter().for_each(|speed| trace.record(&[*speed]));
//! trace.finish();
//! let evaluation = formula.evaluate(&trace).expect("the trace has the signal");
//! assert_eq!((evaluation.truth, evaluation.robustness), (Truth::Holds, 0.5));
//! # Ok::<(), paracosm_oracles::ParseError>(())
//! ```

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
