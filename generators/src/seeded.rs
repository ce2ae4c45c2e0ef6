//! Makes independent random numbers for several purposes from one seed.
//!
//! Rows, points and shifts of one generator must be independent of each other, although the user gives a single seed.
//! Hence every purpose, and every number within it, has its own generator, seeded with a hash of all three.
//! Neighbouring seeds, or PCG's own streams, would be simpler, but they are affinely related.

use rand::SeedableRng;
use rand_pcg::Pcg64;

/// The purpose of a generator of random numbers. Never renumber the variants: their numbers are part of the seed.
#[derive(Clone, Copy)]
pub(crate) enum Purpose {
    /// The random numbers make uniformly random points.
    Points = 0,
    /// The random numbers make the shift of a sequence.
    Shift = 1,
    /// The random numbers make the cells and jitters of Latin hypercubes.
    Cells = 2,
    /// The random numbers make the rows of a random family.
    Rows = 3,
    /// The random numbers scramble the digits of a sequence.
    Scramble = 4,
    /// The random numbers make the candidates for greedy points.
    Greedy = 5,
    /// The random numbers make the order of the corners with which adaptive strategies begin.
    Corners = 6,
    /// The random numbers make the random decisions of an adaptive strategy.
    Search = 7,
    /// The random numbers make the draws from a model of failures.
    Draws = 8,
    /// The random numbers make other continuous values for a row of discrete values.
    Redraws = 9,
    /// The random numbers make the swaps that search for an even Latin hypercube.
    Swaps = 10,
}

/// Makes the generator of random numbers for a seed, a purpose and a `number` within the purpose.
pub(crate) fn seeded(seed: u64, purpose: Purpose, number: u64) -> Pcg64 {
    let word = [purpose as u64, number].into_iter().fold(mix(seed), |word, part| mix(word ^ mix(part)));
    Pcg64::seed_from_u64(word)
}

/// Hashes a word by one step of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014). The hash is a bijection, so two seeds
/// never meet.
pub(crate) fn mix(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}
