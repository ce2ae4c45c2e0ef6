//! Counts time in a unit. The sample period and the time bounds of a formula are whole multiples of the unit.
//!
//! A robustness jumps at sums of sample times and time bounds. In seconds, such sums are rounded, so that two jumps at the same instant could
//! be parted: 0.1 + 0.2 is not 0.3 for a computer. Whole numbers are added exactly.

use crate::{Formula, Interval, Trace};

/// The greatest distance of a time bound from a fraction of the sample period that counts as this fraction, as a share of the bound. It is far
/// more than the rounding of two decimal numbers, and far less than any duration that matters.
const ROUNDING: f64 = 1e-12;

/// The greatest number of units in a trace. Crossings of lines are no whole numbers of units, and in longer traces their times would be rounded
/// by too much.
const MOST_UNITS: u64 = 10_000_000;

/// The number of units in a short trace, at least half of it. A crossing near an instant is moved by a share of a unit, so that small units keep
/// the values of a function exact. In a trace of this length, rounded sums of times are off by less than a hundredth of the move.
const FINE_UNITS: u64 = 1 << 20;

/// A unit of time, which is the sample period or a whole part of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unit {
    /// The sample period in seconds.
    dt: f64,
    /// The number of units in a sample period.
    per_period: u64,
}

impl Unit {
    /// Chooses the unit for a formula and a trace. A bound that is no fraction of the sample period with a small enough denominator keeps its
    /// rounding.
    pub fn of(formula: &Formula, trace: &Trace) -> Self {
        let mut bounds = Vec::new();
        formula.for_each_interval(&mut |interval| bounds.extend([interval.start, interval.end]));
        let most = MOST_UNITS / trace.len().max(1) as u64;
        let mut parts: Vec<u64> = bounds.into_iter().filter_map(|bound| parts(bound / trace.dt(), most)).collect();
        parts.sort_unstable();
        let per_period = parts.into_iter().fold(1, |all, parts| {
            let common = all / divisor(all, parts) * parts;
            if common <= most { common } else { all }
        });
        // A power of two changes no rounding.
        let finer = FINE_UNITS / (per_period * trace.len().max(1) as u64);
        Self { dt: trace.dt(), per_period: per_period << finer.max(1).ilog2() }
    }

    /// Returns the number of units in a number of sample periods.
    pub fn of_ticks(self, ticks: usize) -> f64 {
        (ticks as u64 * self.per_period) as f64
    }

    /// Returns a time bound in units, which is a whole number wherever possible.
    pub fn of_seconds(self, seconds: f64) -> f64 {
        // A finite bound stays finite.
        let most = if seconds.is_finite() { f64::MAX } else { f64::INFINITY };
        let units = (seconds / self.dt * self.per_period as f64).min(most);
        if is_near(units, units.round()) { units.round() } else { units }
    }

    /// Returns the bounds of an interval in units.
    pub fn of_interval(self, interval: Interval) -> Interval {
        let [start, end] = [interval.start, interval.end].map(|bound| self.of_seconds(bound));
        Interval { start, end, ..interval }
    }

    /// Returns a number of units in seconds. The time of a sample is exactly the time that it has elsewhere.
    pub fn to_seconds(self, units: f64) -> f64 {
        units / self.per_period as f64 * self.dt
    }

    /// Returns the time of the sample that is nearest to a time, both in units.
    pub fn nearest_sample(self, units: f64) -> f64 {
        (units / self.per_period as f64).round() * self.per_period as f64
    }
}

/// Returns the denominator of the simplest fraction that a positive number is up to rounding, which the continued fraction of the number finds;
/// `None` if it is above `most`.
fn parts(number: f64, most: u64) -> Option<u64> {
    let (mut before, mut denominator) = (0, 1_u64);
    let mut rest = number;
    while rest.is_finite() && denominator <= most {
        let whole = number * denominator as f64;
        if is_near(whole, whole.round()) {
            return Some(denominator);
        }
        rest = (rest - rest.floor()).recip();
        (before, denominator) = (denominator, before + denominator * (rest.floor() as u64).min(most + 1));
    }
    None
}

fn is_near(number: f64, whole: f64) -> bool {
    (number - whole).abs() <= ROUNDING * whole.max(1.0)
}

fn divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(formula: &str, dt: f64, samples: usize) -> Unit {
        let mut trace = Trace::new(dt, vec!["x".to_owned()]);
        (0..samples).for_each(|_| trace.record(&[0.0]));
        Unit::of(&formula.parse().unwrap(), &trace)
    }

    #[test]
    fn the_period_and_all_bounds_are_whole_numbers_of_units() {
        for (formula, dt, samples, per_period) in [
            ("always[0,0.3] (x > 0)", 0.1, 100, 1),
            ("always[0.05,0.3] eventually[0,0.25] (x > 0)", 0.1, 100, 2),
            ("always[0,0.001] (x > 0)", 0.01, 2500, 10),
            ("always[0,0.1] ((x > 0) until[0.2,inf] (x < 1))", 1.0 / 30.0, 900, 1),
            ("always[0.1,7] (x > 0)", 0.3, 100, 3),
            ("always[0,0.123] once[0,0.07] (x > 0)", 0.01, 100, 10),
            // A bound that would need too many units keeps its rounding, and the other bounds do not suffer.
            ("always[0,3.14159265358979] (x > 0) and eventually[0,0.25] (x > 1)", 0.1, 100_000, 2),
            // The bound with the small denominator counts, whatever stands first.
            ("always[0,0.00039] (x > 0) and eventually[0,0.1] (x > 1)", 0.3, 1000, 3),
            ("always (x > 0)", 0.1, 100, 1),
        ] {
            let unit = unit(formula, dt, samples);
            let finer = unit.per_period / per_period;
            assert_eq!(unit.per_period, finer * per_period, "{formula}");
            assert!(finer.is_power_of_two(), "{formula}");
            assert_eq!(unit.to_seconds(unit.of_ticks(7)), 7.0 * dt);
            let units = unit.per_period * samples as u64;
            assert!((FINE_UNITS / 2..=MOST_UNITS).contains(&units), "{formula}: {units}");
        }
        let unit = unit("always[0.05,0.3] (x > 0)", 0.1, 10);
        let half = unit.of_ticks(1) / 2.0;
        assert_eq!(unit.of_interval(Interval::from(0.05..=0.3)), Interval::from(half..=6.0 * half));
        assert_eq!(unit.of_interval(Interval::from(0.15..)), Interval::from(3.0 * half..));
    }
}
