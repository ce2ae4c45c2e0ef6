//! Nested uniform scrambling (Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995) in base 2.
//!
//! For each value of all bits above it, a coin of its own decides whether a bit of a coordinate is flipped. So the
//! two halves may be exchanged, then the halves of each half, and so on: a tree of coins. Every elementary interval
//! is mapped onto an interval of the same shape, and a net stays a net.
//!
//! The coins are hashed instead of stored, after Burley ("Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
//! His hash treats all bits at once and mixes them imperfectly. This module hashes the bits above with SplitMix64,
//! and so follows the definition exactly. A word of hash is 64 coins, and six levels of the tree need 63.

use crate::seeded::mix;

/// The number of levels of the tree that one hash decides.
const LEVELS: u32 = 6;

/// The number of hashes that decide the 53 bits that a double keeps.
const HASHES: u32 = 9;

/// Scrambles the upper 54 bits of a word and clears its lower bits; `key` selects the tree of random flips.
pub(super) fn scramble(word: u64, key: u64) -> u64 {
    let mut scrambled = 0;
    for hash in 0..HASHES {
        let depth = hash * LEVELS;
        // The bits above, preceded by a bit that marks their number.
        let above = (1 << depth) | word.unbounded_shr(64 - depth);
        let coins = mix(key ^ above);
        // The node of the subtree, numbered as in a heap: the children of k are 2k and 2k+1.
        let mut node = 1_u64;
        for level in 1..=LEVELS {
            let bit = (word >> (64 - depth - level)) & 1;
            scrambled = (scrambled << 1) | (bit ^ ((coins >> node) & 1));
            node = (node << 1) | bit;
        }
    }
    scrambled << (64 - HASHES * LEVELS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_part_at_the_very_bit_at_which_they_did_before() {
        for key in [0, 1, 0x0123_4567_89ab_cdef, u64::MAX] {
            for bit in 0..HASHES * LEVELS {
                let (a, b) = (mix(key ^ 77), mix(key ^ 77) ^ (1 << (63 - bit)));
                assert_eq!((scramble(a, key) ^ scramble(b, key)).leading_zeros(), bit);
            }
        }
    }

    #[test]
    fn what_two_words_have_below_the_bit_at_which_they_part_is_unrelated() {
        let (a, b) = (0, 1 << 63);
        let mut ones = [0; 64];
        for key in 0..4000 {
            let difference = scramble(a, mix(key)) ^ scramble(b, mix(key));
            (0..54).for_each(|bit| ones[bit] += (difference >> (63 - bit)) & 1);
        }
        assert_eq!(ones[0], 4000);
        // Five standard deviations.
        assert!(ones[1..54].iter().all(|ones| ones.abs_diff(2000) < 160), "{ones:?}");
    }
}
