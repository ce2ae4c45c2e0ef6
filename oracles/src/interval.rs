//! Time bounds of temporal operators, in seconds, and the ticks that they stand for on a sampled trace.

use crate::EvaluationError;
use std::fmt;
use std::ops::{RangeFrom, RangeFull, RangeInclusive};

/// How far from a multiple of the sample period a time bound may be, relative to itself: what the decimal notation of
/// both leaves uncertain, a thousandfold.
const TOLERANCE: f64 = 1e-9;

/// No trace has so many ticks; sums of a few hundred such bounds still fit into a `usize`.
pub(crate) const FOREVER: usize = 1 << 48;

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

    /// The bounds in ticks of `dt` seconds, the later one absent where there is none.
    pub(crate) fn ticks(&self, dt: f64) -> Result<(usize, Option<usize>), EvaluationError> {
        if !self.is_valid() {
            return Err(EvaluationError::Interval(*self));
        }
        let start = self.tick(self.start, dt, f64::floor)?;
        let end = if self.end.is_finite() { Some(self.tick(self.end, dt, f64::ceil)?) } else { None };
        Ok((start, end))
    }

    fn tick(&self, bound: f64, dt: f64, outward: fn(f64) -> f64) -> Result<usize, EvaluationError> {
        let ticks = bound / dt;
        let nearest = ticks.round();
        let whole = (ticks - nearest).abs() <= TOLERANCE * nearest.max(1.0);
        if !whole && !self.outward {
            return Err(EvaluationError::TimeBound { bound, dt, widened: Self { outward: true, ..*self } });
        }
        let ticks = if whole { nearest } else { outward(ticks) };
        Ok((ticks as usize).min(FOREVER))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_bounds_are_whole_ticks_of_decimal_periods() {
        for (bound, dt, ticks) in [(0.3, 0.1, 3), (5.0, 0.01, 500), (0.07, 0.01, 7), (1e6, 1e-3, 1_000_000_000)] {
            assert_eq!(Interval::from(0.0..=bound).ticks(dt), Ok((0, Some(ticks))));
        }
    }

    #[test]
    fn a_bound_between_two_samples_is_refused_unless_the_formula_widens_it() {
        let interval = Interval::from(0.15..=0.25);
        assert_eq!(
            interval.ticks(0.1).unwrap_err().to_string(),
            "a time bound of 0.15 s is no multiple of the sample period of 0.1 s; ~[0.15,0.25] would round it outward"
        );
        assert_eq!(interval.outward().ticks(0.1), Ok((1, Some(3))));
    }

    #[test]
    fn what_is_no_interval_is_refused() {
        for (start, end) in [(-1.0, 2.0), (3.0, 2.0), (f64::NAN, 2.0), (0.0, f64::NAN), (f64::INFINITY, f64::INFINITY)]
        {
            let interval = Interval { start, end, outward: true };
            assert!(matches!(interval.ticks(0.1), Err(EvaluationError::Interval(_))), "[{start},{end}]");
        }
    }
}
