//! The Owen-scrambled Sobol sequence: more even than Halton in many dimensions, but of limited length.
//!
//! The points are those of the crate `sobol_burley` (Burley, JCGT 9(4), 2020). It always scrambles, with hash
//! functions in place of random bits; it has 24 bits per coordinate; and beyond its limits it returns numbers
//! that look like points and are none. This module is the guard in front of it.

use super::Sequence;
use crate::GeneratorError;

/// How many points the direction numbers reach for.
const LEN: u64 = 1 << 16;

/// The scrambled sequence of one seed.
pub(crate) struct Sobol {
    dims: u32,
    seed: u32,
}

impl Sobol {
    /// The sequence of which the points before index `end` will be used.
    pub(crate) fn new(dims: usize, seed: u64, end: u64) -> Result<Self, GeneratorError> {
        if dims > sobol_burley::NUM_DIMENSIONS as usize || end > LEN {
            return Err(GeneratorError::SobolLimit { points: end, dims });
        }
        // The crate takes 32 bits; fold the others in, so that a seed beyond them is still another seed.
        Ok(Self { dims: dims as u32, seed: (seed ^ (seed >> 32)) as u32 })
    }
}

impl Sequence for Sobol {
    fn len(&self) -> u64 {
        LEN
    }

    fn point(&self, index: u64) -> Vec<f64> {
        debug_assert!(index < LEN);
        (0..self.dims).map(|axis| f64::from(sobol_burley::sample(index as u32, axis, self.seed))).collect()
    }
}
