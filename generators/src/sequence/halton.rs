//! The Halton sequence (section 3.2 of the paper), with dispersion O(1/n) and any number of points.
//!
//! Coordinate i of point j is the radical inverse of j in the i-th prime: its digits mirrored at the point.

use super::{
    Sequence,
    radical::{INDICES, primes, radical_inverse},
    shift::Shift,
};
use crate::strategy::{ANY, Descriptor, Endless, Look, MarkShape, Method, MethodKind, Strategy};

impl Strategy {
    /// The strategy "halton", which takes the Halton sequence; a seed shifts the sequence modulo 1 by a random vector.
    /// It is the paper's choice.
    pub const HALTON: Self = Self::of(&Descriptor {
        name: "halton",
        about: "low-dispersion sequence of any length: the default for up to about ten parameters",
        dims: ANY,
        look: Look::filled(0x00_72b2, MarkShape::Circle),
        // Point 0 of the Halton sequence is the corner of the cube.
        method: Method(MethodKind::Sequence(Endless {
            first: Some(1),
            plain: true,
            fills: true,
            build: |dims, seed| Box::new(Halton::new(dims, seed)),
        })),
    });
}

/// The Halton sequence in the first primes, shifted or unshifted.
pub(crate) struct Halton {
    bases: Vec<u64>,
    shift: Shift,
}

impl Halton {
    /// Makes the Halton sequence, which is shifted if a seed is given.
    pub(crate) fn new(dims: usize, seed: Option<u64>) -> Self {
        Self { bases: primes().take(dims).collect(), shift: Shift::of_row(dims, seed, 0) }
    }
}

impl Sequence for Halton {
    fn len(&self) -> u64 {
        INDICES
    }

    fn point(&self, index: u64) -> Vec<f64> {
        self.shift.apply(self.bases.iter().map(|&base| radical_inverse(base, index)))
    }
}
