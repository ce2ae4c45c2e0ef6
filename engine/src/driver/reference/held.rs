//! Measures the time for which a condition has held, for evaluation and reaction times.

/// The duration for which a condition has held, updated step by step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Held(Option<f64>);

/// The tolerance in seconds: times are sums of steps.
const WHISKER: f64 = 1e-9;

impl Held {
    /// The duration for a condition that has not held yet.
    pub const NEVER: Self = Self(None);

    /// Updates the duration after `dt` seconds, and returns `true` if the condition has held for `seconds` without a
    /// break. The time counts from the first call at which the condition holds.
    pub fn lasts(&mut self, holds: bool, seconds: f64, dt: f64) -> bool {
        self.0 = match self.0 {
            _ if !holds => None,
            None => Some(0.0),
            Some(since) => Some(since + dt),
        };
        self.0.is_some_and(|since| since >= seconds - WHISKER)
    }
}
