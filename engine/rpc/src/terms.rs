//! The terms on which a driver in another process is asked.

use std::time::Duration;

/// The terms of a session, which are the seed, the driver's settings and the timeout.
#[derive(Debug, Clone, PartialEq)]
pub struct Terms {
    /// The seed of the driver's randomness and of the noise of its sensors.
    pub seed: u64,
    /// The names and values of the driver's settings.
    pub settings: Vec<(String, f64)>,
    /// The longest time that an answer of the driver may take.
    pub timeout: Duration,
}
