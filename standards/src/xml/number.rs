//! Numbers in messages.

/// The decimals of a number in a message, and the magnitude from which on a number has none anyway.
const DECIMALS: f64 = 1e3;
const WITHOUT_DECIMALS: f64 = 1e12;

/// Rounds a computed number to three decimals, so that a message does not show its rounding errors.
pub(crate) fn rounded(number: f64) -> f64 {
    if number.abs() < WITHOUT_DECIMALS { (number * DECIMALS).round() / DECIMALS } else { number }
}

/// The magnitude from which on a number is written as a power of ten.
const LARGE: f64 = 1e6;

/// Writes a number with some decimals, or as a power of ten if it is large.
pub(crate) fn short(number: f64, decimals: usize) -> String {
    if number.abs() < LARGE { format!("{number:.decimals$}") } else { format!("{number:e}") }
}
