//! Streams: values that change from tick to tick, as expressions over other streams.
//!
//! The model is synchronous, as in Lustre (Halbwachs, Caspi, Raymond, Pilaud, "The synchronous data flow programming
//! language LUSTRE", Proc. IEEE 79(9), 1991): there is one clock, and at each of its ticks a stream has a value or is
//! absent. A stream that always has a value is a *continuous value*; a stream that is mostly absent is a stream of
//! *events*. A [`Stream`] is a cheap handle on an immutable expression. To build an expression computes nothing. When a
//! run starts, all expressions that something reads are laid out once as a graph, each after its operands. They are
//! evaluated in that order at every tick, each once, however often it is used. The evaluation allocates nothing.
//!
//! # Feedback
//! An expression is made of expressions that exist. If you need a stream before it exists, announce it by
//! [`Scenario::forward`](crate::Scenario::forward) and define it later. The stream may depend on its own values at
//! earlier ticks, by way of a [`pre`](Stream::pre). If it depends on its value at the same tick, the scenario is
//! refused with the names of all streams on the cycle. Physics closes loops too: outputs of objects show the state at
//! the beginning of a tick.
//!
//! # Tick by tick
//! An empty cell is an absent value. A stream is *over* from a tick on if it is known to be absent for ever from then
//! on, which matters to `concat` alone. `x` and `y` are any streams, and `e` is an event: a stream of truths occurs if
//! it is true, any other stream if it has a value.
//!
//! | stream | 0 | 1 | 2 | 3 | 4 | |
//! | --- | --- | --- | --- | --- | --- | --- |
//! | `x` | 1 | 2 | 3 | 4 | 5 | |
//! | `y` | | 7 | | 8 | 9 | |
//! | `e` | | | e | | e | |
//! | `Stream::constant(6.0)` | 6 | 6 | 6 | 6 | 6 | |
//! | `Stream::tick()` | () | () | () | () | () | |
//! | `Stream::time()`, ticks of 0.5 s | 0 | 0.5 | 1 | 1.5 | 2 | |
//! | `x.map(f)` | f(1) | f(2) | f(3) | f(4) | f(5) | over with `x` |
//! | `x.filter(odd)` | 1 | | 3 | | 5 | over with `x` |
//! | `x.when(e)` | | | 3 | | 5 | over with `x` or `e` |
//! | `x.zip(y)` | | (2,7) | | (4,8) | (5,9) | over with `x` or `y` |
//! | `x + y`, and all arithmetic, comparison, logic | | 9 | | 12 | 14 | over with `x` or `y` |
//! | `y.take(2)` | | 7 | | 8 | | over from 4 on |
//! | `y.take(2).concat(x)` | | 7 | | 8 | 5 | over when both are |
//! | `y.sum()` | | 7 | | 15 | 24 | over with `y` |
//! | `y.scan(1, f)` | | f(1,7)=a | | f(a,8)=b | f(b,9) | over with `y` |
//! | `y.merge(x)` | 1 | 7 | 3 | 8 | 9 | over when both are |
//! | `x.take_until(e)` | 1 | 2 | | | | over from 2 on |
//! | `x.skip_until(e)` | | | 3 | 4 | 5 | over with `x` |
//! | `y.pre()` | | | 7 | | 8 | over a tick after `y` |
//! | `y.hold(0)` | 0 | 7 | 7 | 8 | 9 | never over |
//! | `x.pre().initially(0)` | 0 | 1 | 2 | 3 | 4 | over when both are |
//! | `y.for_each(f)` | | f(7) | | f(8) | f(9) | done, not read |
//!
//! Streams with values at different ticks need no conversion: `hold` makes a stream of events continuous, and `when`
//! samples a continuous value. Nothing is ever queued. In the paper's `v.pos.take(1).concat(v.pos)`, the lists are one
//! element apart. Here it is therefore written `v.pos.take(1).concat(v.pos.pre())`, or `v.pos.pre().initially(v.pos)`:
//!
//! ```
//! # use paracosm_engine::{AutonomousVehicle, Program, RoadSegment, Scenario, eventually};
//! # fn build(s: &mut Scenario) {
//! # let road = s.place(RoadSegment::new(300.0));
//! # let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
//! let before = car.position().pre().initially(car.position());
//! let travelled = (car.position() - before).norm().sum().named("way");
//! s.require("progress", eventually(travelled.at_least(50.0)));
//! # }
//! # Program::new("way", "a way", build).declare().unwrap();
//! ```

mod arithmetic;
mod combinators;
mod datum;
mod dot;
mod forward;
mod given_up;
mod graph;
mod node;
mod order;
mod sketch;
#[cfg(test)]
mod tests;

pub use combinators::{Effect, Stream};
pub use datum::Datum;
pub(crate) use datum::{DatumSample, samples};
pub(crate) use dot::dot;
pub use forward::Forward;
pub use given_up::GivenUp;
pub(crate) use graph::{Clock, Graph, Slot};
pub(crate) use node::{Binary, Equation, Node, NodeKind, Source, Unary};
pub use order::GraphFlaw;
pub(crate) use order::order;
pub use sketch::{Form, Part, Reader, Sketch};
