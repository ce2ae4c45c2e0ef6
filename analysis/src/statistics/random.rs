//! Draws random numbers from a seed, the same on every machine.

use paracosm_space::distribution::normal_quantile;

/// The generator SplitMix64 with its state (Steele, Lea, Flood, Fast splittable pseudorandom number generators,
/// OOPSLA 2014).
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// Returns the next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let word = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        word ^ (word >> 31)
    }

    /// Returns a random whole number below `n`. All numbers are equally likely, up to a relative difference of n /
    /// 2^64.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// Returns a random number strictly between 0 and 1.
    pub fn unit(&mut self) -> f64 {
        // The middle of one of 2^52 equal parts.
        ((self.bits() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Returns a random number with the standard normal distribution.
    pub fn normal(&mut self) -> f64 {
        normal_quantile(self.unit())
    }
}
