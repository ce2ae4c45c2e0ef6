//! The values that a parameter takes: an interval or a finite choice.

use crate::Value;
use std::fmt;

/// What values a parameter takes.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// Any number from `lo` to `hi`: a continuous parameter.
    Interval {
        /// The lower end.
        lo: f64,
        /// The upper end.
        hi: f64,
    },
    /// One of these values: a discrete parameter.
    Choice(Vec<Value>),
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Domain::Interval { lo, hi } => write!(f, "a number in [{lo}, {hi}]"),
            Domain::Choice(levels) => {
                f.write_str("one of ")?;
                for (i, level) in levels.iter().enumerate() {
                    write!(f, "{}{level}", if i == 0 { "" } else { ", " })?;
                }
                Ok(())
            }
        }
    }
}

/// The number at coordinate `u` of `[lo, hi]`: both ends exactly, never outside, and never less where `u` is more,
/// for each step of the sum rounds monotonically ([`coordinate`] relies on that).
pub(crate) fn at(lo: f64, hi: f64, u: f64) -> f64 {
    if u >= 1.0 {
        return hi;
    }
    let width = hi - lo;
    // Halves, where the width overflows.
    let v = if width.is_finite() { lo + u * width } else { 2.0 * (0.5 * lo + u * (0.5 * hi - 0.5 * lo)) };
    v.clamp(lo, hi)
}

/// The coordinate of `v` in `[lo, hi]`.
///
/// Division alone is off by an ulp now and then, so that a logged test would come back as another one. Where it
/// is, the least coordinate that decodes to `v` or more is found by bisection; it decodes to `v`, if any does.
pub(crate) fn coordinate(lo: f64, hi: f64, v: f64) -> f64 {
    // Halves, because hi - lo may overflow.
    let u = ((v * 0.5 - lo * 0.5) / (hi * 0.5 - lo * 0.5)).clamp(0.0, 1.0);
    if at(lo, hi, u) == v {
        return u;
    }
    // Numbers from 0 to 1 are ordered as their bits are.
    let (mut low, mut high) = (0, 1.0f64.to_bits());
    while low < high {
        let middle = low + (high - low) / 2;
        if at(lo, hi, f64::from_bits(middle)) < v {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    f64::from_bits(low)
}
