//! Converts time bounds into ticks of a sampled trace.

use crate::{EvaluationError, Interval};

/// The greatest distance of a time bound from a multiple of the sample period, as a share of the bound. It is a
/// thousand times the uncertainty that the decimal notation of both numbers causes.
const TOLERANCE: f64 = 1e-9;

/// A number of ticks that no trace reaches. Sums of a few hundred such bounds still fit into a `usize`.
pub(crate) const FOREVER: usize = 1 << 48;

impl Interval {
    /// Returns the bounds in ticks of `dt` seconds. The later bound is `None` if the interval has no end.
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
            "the time bound 0.15 s is not a multiple of the sample period 0.1 s; write ~[0.15,0.25] to round outward"
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
