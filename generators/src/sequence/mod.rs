//! Point sets of the unit cube, by index.
//!
//! A sequence computes its points from their index alone and remembers nothing. So it does not matter in what
//! portions points are asked for, a campaign resumes where it stopped without going through what came before,
//! and every row of a discrete family can be given a stretch of its own. Sets that depend on their size become
//! sequences in `per_row`.

mod corners;
mod fibonacci;
mod halton;
mod halton_scrambled;
mod hammersley;
mod kronecker;
mod lhs;
mod owen;
mod per_row;
mod radical;
mod shift;
mod sobol;
mod uniform;

pub(crate) use self::sobol::{MOST_DIMS as MOST_SOBOL_DIMS, Sobol};
pub(crate) use corners::RandomCorners;
pub(crate) use fibonacci::Fibonacci;
pub(crate) use halton::Halton;
pub(crate) use halton_scrambled::{HaltonScrambled, MOST_DIMS as MOST_HALTON_SCRAMBLED_DIMS};
pub(crate) use hammersley::Hammersley;
pub(crate) use kronecker::Kronecker;
pub(crate) use lhs::{Lhs, Place};
pub(crate) use per_row::{PerRow, RowSet};
pub(crate) use uniform::Uniform;

/// Points of `[0,1)^d`, numbered from 0.
pub(crate) trait Sequence: Send + Sync {
    /// How many points there are.
    fn len(&self) -> u64;

    /// The point at `index`, which is below [`Sequence::len`].
    fn point(&self, index: u64) -> Vec<f64>;
}

/// `word / 2^64`, cut off after the 53 bits that a double has.
fn unit(word: u64) -> f64 {
    (word >> 11) as f64 / (1_u64 << 53) as f64
}
