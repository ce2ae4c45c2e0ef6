//! Which tests of a discrete space make sense: what constraints allow.

mod clause;

pub use clause::{Clause, Literal};
