//! The values that a parameter takes: an interval or a finite choice.

use crate::Value;
use std::fmt;

/// The set of values that a parameter can take.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// An interval of numbers, from `lo` to `hi`. The parameter is continuous.
    Interval {
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
    /// A finite list of numbers and words. The parameter is discrete.
    Choice(Vec<Value>),
}

/// The greatest number of values that a message shows.
const MOST_SHOWN: usize = 50;

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Domain::Interval { lo, hi } => write!(f, "a number in [{lo}, {hi}]"),
            Domain::Choice(levels) => {
                f.write_str("one of ")?;
                for (i, level) in levels.iter().take(MOST_SHOWN).enumerate() {
                    write!(f, "{}{level}", if i == 0 { "" } else { ", " })?;
                }
                match levels.len().saturating_sub(MOST_SHOWN) {
                    0 => Ok(()),
                    others => write!(f, " and {others} other values"),
                }
            }
        }
    }
}

/// Returns the number at the coordinate `u` of `[lo, hi]`.
///
/// Both ends are exact, and the result is never outside the interval. The result never falls when `u` grows, since
/// each step of the sum rounds monotonically. [`coordinate`] relies on that.
pub(crate) fn at(lo: f64, hi: f64, u: f64) -> f64 {
    if u >= 1.0 {
        return hi;
    }
    let width = hi - lo;
    // Compute with halves if the width overflows.
    let v = if width.is_finite() { lo + u * width } else { 2.0 * (0.5 * lo + u * (0.5 * hi - 0.5 * lo)) };
    v.clamp(lo, hi)
}

/// Returns the coordinate of `v` in `[lo, hi]`.
///
/// Division alone is sometimes wrong by one ulp. A logged test would then be read back as another test. In this case
/// bisection finds the least coordinate that decodes to `v` or more. It decodes to `v` exactly if any coordinate does.
pub(crate) fn coordinate(lo: f64, hi: f64, v: f64) -> f64 {
    // Compute with halves, because hi - lo may overflow.
    let u = ((v * 0.5 - lo * 0.5) / (hi * 0.5 - lo * 0.5)).clamp(0.0, 1.0);
    if at(lo, hi, u) == v {
        return u;
    }
    // The bit patterns of floats from 0 to 1 have the same order as the numbers.
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
