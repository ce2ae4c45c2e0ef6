//! Measures how long a condition has held, for evaluation and reaction times.

/// A condition that is looked at step by step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Held(Option<f64>);

/// The tolerance in seconds: times are sums of steps.
const WHISKER: f64 = 1e-9;

impl Held {
    /// A condition that has not held yet.
    pub const NEVER: Self = Self(None);

    /// Looks again, `dt` seconds after the last look, and returns `true` if the condition has held for `seconds`
    /// without a break. The time counts from the first look at which the condition holds.
    pub fn lasts(&mut self, holds: bool, seconds: f64, dt: f64) -> bool {
        self.0 = match self.0 {
            _ if !holds => None,
            None => Some(0.0),
            Some(since) => Some(since + dt),
        };
        self.0.is_some_and(|since| since >= seconds - WHISKER)
    }
}
