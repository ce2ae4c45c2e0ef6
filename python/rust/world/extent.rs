//! The extent of streams and statements, which limits how far they nest. A run lays out a graph and writes formulas by recursion, so without a
//! limit a loop of a scenario could take all of the stack or of the memory.

use crate::error::raised;
use pyo3::prelude::*;

/// The most operators one in another.
const MOST_DEPTH: usize = 1_000;

/// The most operators in all, if each operand is written out as often as it is used.
const MOST_PARTS: usize = 10_000;

/// The number of operators of a stream or of a statement: one in another, and in all.
#[derive(Clone, Copy)]
pub struct Extent {
    depth: usize,
    parts: usize,
}

impl Extent {
    /// The extent of a stream or of a statement that is made of no other.
    pub const ONE: Self = Self { depth: 1, parts: 1 };

    /// Returns the extent of something that is made of this alone.
    pub fn next(self) -> Self {
        Self { depth: self.depth + 1, parts: self.parts.saturating_add(1) }
    }

    /// Returns the extent of something that is made of two others.
    pub fn with(self, other: Self) -> Self {
        Self { depth: self.depth.max(other.depth) + 1, parts: self.parts.saturating_add(other.parts).saturating_add(1) }
    }

    /// Returns the extent of the same with a name, which is written in the place of all its operators.
    pub fn named(self) -> Self {
        Self { parts: 1, ..self }
    }

    /// Checks that the extent is within the limits.
    ///
    /// # Errors
    /// There are too many operators.
    pub fn check(self) -> PyResult<()> {
        if self.depth > MOST_DEPTH {
            return Err(raised(format!(
                "more than {MOST_DEPTH} operators stand one in another, expected at most {MOST_DEPTH}"
            )));
        }
        if self.parts > MOST_PARTS {
            return Err(raised(format!(
                "more than {MOST_PARTS} operators in a stream or a statement that is written out: give a stream that is used several times a \
                 name, `stream.named(\"name\")`"
            )));
        }
        Ok(())
    }
}
