//! The Halton sequence with random digits (Owen, "A randomized Halton algorithm in R", arXiv 1706.02808, 2017).
//!
//! In large bases the plain sequence climbs in long parallel stripes: the first 50 points of the axes 31 and 37 lie
//! close to the diagonal. Here every position of every base has its own random permutation, which changes the digit
//! at that position before the digit is mirrored. That breaks up the stripes and makes each point uniformly random.
//! Any b^k consecutive points still fill the b^k intervals of length b^-k, one point each.
//!
//! A number has infinitely many leading zeros, and these are permuted too: otherwise all low digits of point 0 would
//! stay as they are. Digits below 2^-53 make no difference to a double and are left out.

use super::{
    Sequence,
    radical::{INDICES, primes, ratio},
};
use crate::seeded::{Purpose, seeded};
use crate::strategy::{Descriptor, Endless, Look, MarkShape, Method, MethodKind, Strategy};
use rand::seq::SliceRandom;

impl Strategy {
    /// The strategy "halton-scrambled", which takes the Halton sequence with random permutations of its digits.
    pub const HALTON_SCRAMBLED: Self = Self::of(&Descriptor {
        name: "halton-scrambled",
        about: "halton with random digits: avoids halton's stripes in ten parameters and more",
        dims: 1..=MOST_DIMS,
        look: Look::filled(0x56_b4e9, MarkShape::Tip),
        method: Method(MethodKind::Sequence(Endless {
            first: Some(0),
            plain: false,
            fills: true,
            build: |dims, seed| Box::new(HaltonScrambled::new(dims, seed.unwrap_or(0))),
        })),
    });
}

/// The greatest number of dimensions of the scrambled Halton sequence. The permutations take 37 MB, and twice as many
/// dimensions take four times that memory.
pub(crate) const MOST_DIMS: usize = 1000;

/// The scrambled Halton sequence of one seed.
pub(crate) struct HaltonScrambled {
    axes: Vec<Axis>,
}

/// One coordinate of the sequence.
struct Axis {
    base: u64,
    /// The permutations one after the other. The permutation of the last digit, which becomes the first digit, comes
    /// first.
    permutations: Vec<u16>,
    /// The base to the power of the number of digits.
    scale: u128,
}

impl HaltonScrambled {
    /// Makes the scrambled Halton sequence of a seed in at most [`MOST_DIMS`] dimensions.
    pub(crate) fn new(dims: usize, seed: u64) -> Self {
        Self { axes: primes().take(dims).enumerate().map(|(axis, base)| Axis::new(axis, base, seed)).collect() }
    }
}

impl Axis {
    fn new(axis: usize, base: u64, seed: u64) -> Self {
        let mut rng = seeded(seed, Purpose::Scramble, axis as u64);
        let (mut permutations, mut scale) = (Vec::new(), 1);
        // No index has more digits than this.
        while scale < u128::from(INDICES) {
            let start = permutations.len();
            permutations.extend(0..base as u16);
            permutations[start..].shuffle(&mut rng);
            scale *= u128::from(base);
        }
        Self { base, permutations, scale }
    }

    fn coordinate(&self, mut index: u64) -> f64 {
        let mut mirrored = 0;
        for permutation in self.permutations.chunks_exact(self.base as usize) {
            let digit = permutation[(index % self.base) as usize];
            mirrored = mirrored * u128::from(self.base) + u128::from(digit);
            index /= self.base;
        }
        ratio(mirrored, self.scale)
    }
}

impl Sequence for HaltonScrambled {
    fn len(&self) -> u64 {
        INDICES
    }

    fn point(&self, index: u64) -> Vec<f64> {
        self.axes.iter().map(|axis| axis.coordinate(index)).collect()
    }
}
