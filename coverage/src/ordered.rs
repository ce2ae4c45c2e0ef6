//! The least and the greatest of two numbers, for inner loops.
//!
//! `f64::min` and `f64::max` take several instructions, because they ignore a number that is NaN. In these functions no
//! number may be NaN: then one instruction is enough.

/// Returns the least of two numbers.
#[inline(always)]
pub(crate) fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Returns the greatest of two numbers.
#[inline(always)]
pub(crate) fn greatest(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
