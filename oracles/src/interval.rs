//! Time bounds of temporal operators, in seconds.

use std::fmt;
use std::ops::{RangeFrom, RangeFull, RangeInclusive};

/// The time interval in which a temporal operator looks, in seconds from the instant of the operator. Operators of the
/// past look back, all other operators look into the future.
///
/// In Rust an interval is written as a range: `0.0..=5.0`, `2.0..` or `..`. In text the same intervals are written
/// `[0,5]`, `[2,inf]` and with nothing. An interval without an end runs to the end of the trace, or back to its
/// beginning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The bound of the interval that is nearer to the operator's instant, in seconds.
    pub start: f64,
    /// The bound of the interval that is farther from the operator's instant, in seconds. It is infinite if the
    /// interval has no end.
    pub end: f64,
    /// `true` if the evaluation moves a bound between two samples outward to the next sample (`~[0,0.25]`). Otherwise
    /// the evaluation refuses such a bound.
    pub outward: bool,
}

impl Interval {
    /// The time interval that begins at the operator's instant and has no end.
    pub const UNBOUNDED: Self = Self { start: 0.0, end: f64::INFINITY, outward: false };

    /// Returns the same interval, with permission to move bounds between two samples outward to the next sample.
    pub fn outward(self) -> Self {
        Self { outward: true, ..self }
    }

    /// Returns `true` if the bounds are at least 0, the first bound is finite, and the second bound is not below the
    /// first.
    pub fn is_valid(&self) -> bool {
        self.start >= 0.0 && self.start.is_finite() && self.end >= self.start
    }
}

impl From<RangeInclusive<f64>> for Interval {
    fn from(range: RangeInclusive<f64>) -> Self {
        Self { start: *range.start(), end: *range.end(), outward: false }
    }
}

impl From<RangeFrom<f64>> for Interval {
    fn from(range: RangeFrom<f64>) -> Self {
        Self { start: range.start, ..Self::UNBOUNDED }
    }
}

impl From<RangeFull> for Interval {
    fn from(_: RangeFull) -> Self {
        Self::UNBOUNDED
    }
}

/// Writes the interval as it stands behind an operator. The unbounded interval is written as nothing.
impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::UNBOUNDED {
            return Ok(());
        }
        write!(f, "{}[{},{}]", if self.outward { "~" } else { "" }, self.start, self.end)
    }
}
