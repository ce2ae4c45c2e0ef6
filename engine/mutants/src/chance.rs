//! Chance that depends on nothing but the number of a step: the same in every run, on every machine.

use nalgebra::Vector2;

/// Mixes the bits of a number (the finaliser of SplitMix64; Steele, Lea and Flood, OOPSLA 2014).
pub(crate) fn mixed(number: u64) -> u64 {
    let z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Returns a number in [0, 1), which is another one for another step or another body.
pub(crate) fn unit(step: u64, body: usize) -> f64 {
    number(mixed(mixed(step) ^ body as u64))
}

/// Returns two independent standard normal numbers (Box and Muller 1958) for a step and a body.
pub(crate) fn normal(step: u64, body: usize) -> Vector2<f64> {
    let hash = mixed(mixed(step) ^ body as u64);
    // 1 - u is in (0, 1], where the logarithm is finite.
    let radius = (-2.0 * libm::log(1.0 - number(hash))).sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * number(mixed(hash)));
    Vector2::new(radius * cos, radius * sin)
}

fn number(hash: u64) -> f64 {
    (hash >> 11) as f64 / (1_u64 << 53) as f64
}
