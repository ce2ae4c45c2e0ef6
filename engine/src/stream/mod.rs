//! Streams: values that change from tick to tick, as expressions over other streams.
//!
//! The model is synchronous, as in Lustre: there is one clock, and at each of its ticks a stream has a value or
//! is absent. A [`Stream`] is a cheap handle on an immutable expression; building one computes nothing. When a
//! run starts, all expressions that anybody reads are laid out once as a graph, operands before what uses
//! them, and evaluated in that order at every tick. Since an expression can only be made of expressions that
//! exist, none can depend on its own value at the same tick: feedback goes through the physics, whose outputs
//! show the state at the beginning of the tick.
//!
//! | stream | tick 0 | 1 | 2 | 3 | 4 |
//! | --- | --- | --- | --- | --- | --- |
//! | `x` | 1 | 2 | 3 | 4 | 5 |
//! | `x.above(2.5)` | no | no | yes | yes | yes |
//! | `x.skip_until(x.above(2.5))` | | | 3 | 4 | 5 |
//! | `x.take_until(x.above(3.5))` | 1 | 2 | 3 | | |
//!
//! An operation with an absent operand is absent; `skip_until` and `take_until` take an absent event for one
//! that does not occur.

mod expression;
mod graph;

pub use expression::{Datum, Stream};
pub(crate) use expression::{Node, Sample, Source};
pub(crate) use graph::{Graph, Slot};
