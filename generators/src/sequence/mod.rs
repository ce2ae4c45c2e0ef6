//! Sets of points in the unit cube, each point computed from its index.
//!
//! A sequence computes its points from their index alone and remembers nothing. So the sizes of the requests do not
//! matter, a campaign resumes where it stopped without repeating earlier points, and every row of a discrete family
//! can be given its own stretch. `per_row` turns sets that depend on their size into sequences.

mod corners;
mod fibonacci;
mod halton;
mod halton_scrambled;
mod hammersley;
mod kronecker;
mod lattice;
mod lhs;
mod lhs_search;
mod owen;
mod per_row;
mod radical;
mod shift;
mod sobol;
mod uniform;

pub(crate) use self::sobol::MOST_DIMS as MOST_SOBOL_DIMS;
pub(crate) use crate::strategy::Sequence;
pub(crate) use halton::Halton;
pub(crate) use per_row::{PerRow, RowSet};

use crate::strategy::Strategy;

/// The open-loop strategies of this folder, in the order in which lists show the strategies.
pub(crate) const ALL: &[Strategy] = &[
    Strategy::RANDOM,
    Strategy::RANDOM_CORNERS,
    Strategy::HALTON,
    Strategy::HALTON_SCRAMBLED,
    Strategy::SOBOL,
    Strategy::SOBOL_OWEN,
    Strategy::KRONECKER,
    Strategy::HAMMERSLEY,
    Strategy::FIBONACCI,
    Strategy::LATTICE,
    Strategy::LHS,
    Strategy::LHS_CENTRED,
    Strategy::LHS_MAXIMIN,
    Strategy::LHS_DISCREPANCY,
];

/// `word / 2^64`, cut off after the 53 bits that a double has.
fn unit(word: u64) -> f64 {
    (word >> 11) as f64 / (1_u64 << 53) as f64
}
