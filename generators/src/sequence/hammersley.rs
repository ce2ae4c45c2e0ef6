//! The Hammersley set (Hammersley, Ann. New York Acad. Sci. 86, 1960): Halton with one evenly spaced coordinate.
//!
//! Point i of n points has i/n as its first coordinate, and the radical inverses of i in the first primes as the
//! others. One prime fewer means one source of unevenness fewer, but n must be known beforehand.

use super::per_row::PerRow;
use super::{
    per_row::RowSet,
    radical::{primes, radical_inverse, ratio},
    shift::Shift,
};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};

impl Strategy {
    /// The strategy "hammersley", which takes the Hammersley set; a seed shifts the set.
    pub const HAMMERSLEY: Self = Self::of(&Descriptor {
        name: "hammersley",
        about: "halton with one axis evenly spaced: more even than halton, but made for exactly the budget",
        dims: ANY,
        look: Look::filled(0xcc_79a7, MarkShape::Triangle),
        method: Method(MethodKind::Sets {
            plain: true,
            in_a_part: None,
            build: |dims, seed, deal| Ok(Box::new(PerRow::new(deal, Hammersley::new(dims, seed)))),
        }),
    });
}

/// The Hammersley set, with all axes shifted or unshifted.
pub(crate) struct Hammersley {
    dims: usize,
    bases: Vec<u64>,
    seed: Option<u64>,
}

impl Hammersley {
    /// Makes the Hammersley sets of all rows. The set of the first row is unshifted without a seed; all other sets are
    /// shifted.
    pub(crate) fn new(dims: usize, seed: Option<u64>) -> Self {
        Self { dims, bases: primes().take(dims - 1).collect(), seed }
    }
}

impl RowSet for Hammersley {
    fn point(&self, row: u64, size: u64, index: u64) -> Vec<f64> {
        let even = ratio(index.into(), size.into());
        let inverses = self.bases.iter().map(|&base| radical_inverse(base, index));
        Shift::of_row(self.dims, self.seed, row).apply([even].into_iter().chain(inverses))
    }
}
