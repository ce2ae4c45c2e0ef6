//! The random numbers for the noise of sensors.

use nalgebra::Vector2;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// The greatest mean that the Poisson algorithm handles in one round. Up to it, `exp(-mean)` is far from underflow.
const POISSON_AT_ONCE: f64 = 30.0;
/// The greatest mean of a Poisson number. A greater mean is reduced to it.
const POISSON_MOST: f64 = 1e6;

/// The source of the random numbers of one sensor reading.
#[derive(Debug, Clone)]
pub struct Chance {
    random: Pcg64,
    /// The second number of a pair of normal numbers whose first number has been returned.
    spare: Option<f64>,
}

impl Chance {
    /// Makes the source of random numbers from the rig's seed, the sensor's name and the number of the reading.
    pub fn of(seed: u64, name: &str, number: u64) -> Self {
        let key = mixed(mixed(mixed(seed) ^ hashed(name)) ^ number);
        Self { random: Pcg64::seed_from_u64(key), spare: None }
    }

    /// Returns a uniform random number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.random.random()
    }

    /// Returns `true` with the given probability.
    pub fn happens(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Returns a uniform random number from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Returns a normal random number with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        self.spare.take().unwrap_or_else(|| {
            let pair = gaussian([self.unit(), self.unit()]);
            self.spare = Some(pair.y);
            pair.x
        })
    }

    /// Returns an exponential random number with the given mean.
    pub fn exponential(&mut self, mean: f64) -> f64 {
        -mean * libm::log(1.0 - self.unit())
    }

    /// Returns a Poisson random number with the given mean (by multiplying uniform numbers, Knuth 1969). A mean above a
    /// million counts as a million.
    pub fn poisson(&mut self, mean: f64) -> usize {
        let mut count = 0;
        let mut left = mean.min(POISSON_MOST);
        while left > 0.0 {
            let enough = libm::exp(-left.min(POISSON_AT_ONCE));
            left -= POISSON_AT_ONCE;
            let mut product = self.unit();
            while product > enough {
                count += 1;
                product *= self.unit();
            }
        }
        count
    }
}

/// Returns the hash of a text (FNV-1a; Fowler, Noll and Vo).
pub(crate) fn hashed(text: &str) -> u64 {
    text.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Mixes the bits of a number (the finaliser of SplitMix64; Steele, Lea and Flood 2014).
pub(crate) fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// Returns two independent standard normal numbers from two independent numbers that are evenly distributed in [0, 1)
/// (Box and Muller 1958), equal on all machines.
pub(crate) fn gaussian([first, second]: [f64; 2]) -> Vector2<f64> {
    // 1 - u is in (0, 1], where the logarithm is finite.
    let radius = libm::sqrt(-2.0 * libm::log(1.0 - first));
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * second);
    Vector2::new(radius * cos, radius * sin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_and_variance(numbers: &[f64]) -> (f64, f64) {
        let n = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / n;
        (mean, numbers.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0))
    }

    /// The mean of n numbers with variance v has the standard deviation sqrt(v/n); five of them are exceeded in one of
    /// two million seeds. `fourth` is the fourth central moment, by which the variance spreads with sqrt((fourth -
    /// v²)/n).
    fn check(what: &str, numbers: &[f64], mean: f64, variance: f64, fourth: f64) {
        let n = numbers.len() as f64;
        let found = mean_and_variance(numbers);
        assert!((found.0 - mean).abs() < 5.0 * (variance / n).sqrt(), "{what}: mean {} for {mean}", found.0);
        let spread = ((fourth - variance * variance) / n).sqrt();
        assert!((found.1 - variance).abs() < 5.0 * spread, "{what}: variance {} for {variance}", found.1);
    }

    fn drawn(draw: impl Fn(&mut Chance) -> f64) -> Vec<f64> {
        (0..20_000).map(|number| draw(&mut Chance::of(3, "sensor", number))).collect()
    }

    #[test]
    fn the_first_numbers_of_many_readings_are_distributed_as_they_say() {
        check("unit", &drawn(Chance::unit), 0.5, 1.0 / 12.0, 1.0 / 80.0);
        check("normal", &drawn(Chance::normal), 0.0, 1.0, 3.0);
        let second = |chance: &mut Chance| {
            chance.normal();
            chance.normal()
        };
        check("second normal", &drawn(second), 0.0, 1.0, 3.0);
        check("exponential", &drawn(|chance| chance.exponential(2.0)), 2.0, 4.0, 9.0 * 16.0);
        for mean in [0.3, 5.0, 100.0] {
            let counts = drawn(|chance| chance.poisson(mean) as f64);
            check("poisson", &counts, mean, mean, mean + 3.0 * mean * mean);
        }
        check("happens", &drawn(|chance| f64::from(chance.happens(0.2))), 0.2, 0.16, 0.16 * (1.0 - 3.0 * 0.16));
    }

    #[test]
    fn nothing_happens_where_nothing_can() {
        let mut chance = Chance::of(1, "sensor", 1);
        assert_eq!(chance.poisson(0.0), 0);
        assert!((0..1000).all(|_| !chance.happens(0.0) && chance.happens(1.0)));
    }

    #[test]
    fn another_seed_name_or_number_is_another_chance() {
        let keys = [(1, "a", 1), (2, "a", 1), (1, "b", 1), (1, "a", 2), (1, "", 0), (0, "", 1)];
        let mut drawn: Vec<u64> =
            keys.iter().map(|&(seed, name, number)| Chance::of(seed, name, number).unit().to_bits()).collect();
        assert_eq!(drawn[0], Chance::of(1, "a", 1).unit().to_bits());
        drawn.sort_unstable();
        drawn.dedup();
        assert_eq!(drawn.len(), keys.len());
    }
}
