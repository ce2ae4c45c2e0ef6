//! Time bounds of temporal operators, in seconds.

use std::fmt;
use std::ops::{RangeFrom, RangeFull, RangeInclusive};

/// From when to when a temporal operator looks, relative to where it stands: into the future or, for the operators of
/// the past, back.
///
/// Written as ranges in Rust, `0.0..=5.0`, `2.0..` and `..`, and as `[0,5]`, `[2,inf]` and nothing in text. An
/// interval without an end runs to the end of the trace, or back to its beginning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The earlier bound in seconds.
    pub start: f64,
    /// The later bound in seconds; infinite where there is none.
    pub end: f64,
    /// Whether bounds that fall between two samples are moved outward to the next sample (`~[0,0.25]`) rather than
    /// refused.
    pub outward: bool,
}

impl Interval {
    /// The interval without bounds.
    pub const UNBOUNDED: Self = Self { start: 0.0, end: f64::INFINITY, outward: false };

    /// The same interval, widened to whole samples where it is none of them.
    pub fn outward(self) -> Self {
        Self { outward: true, ..self }
    }

    /// Whether the bounds are numbers of seconds from 0 on, the first finite and no later than the second.
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

/// As it is written behind an operator: nothing for the unbounded interval.
impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::UNBOUNDED {
            return Ok(());
        }
        write!(f, "{}[{},{}]", if self.outward { "~" } else { "" }, self.start, self.end)
    }
}
