//! How long something has been so: what evaluation and reaction times are counted with.

/// A condition that is looked at step by step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Held(Option<f64>);

/// Times are sums of steps.
const WHISKER: f64 = 1e-9;

impl Held {
    /// What has not been so yet.
    pub const NEVER: Self = Self(None);

    /// Looks again, `dt` seconds after the last time, and says whether the condition has held for `seconds` without a
    /// break. It begins to hold when it is first seen to.
    pub fn lasts(&mut self, holds: bool, seconds: f64, dt: f64) -> bool {
        self.0 = match self.0 {
            _ if !holds => None,
            None => Some(0.0),
            Some(since) => Some(since + dt),
        };
        self.0.is_some_and(|since| since >= seconds - WHISKER)
    }
}
