//! The terms on which a driver in another process is asked.

use std::time::Duration;

/// On what terms a driver is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Terms {
    /// Where its chance comes from, and the noise of its sensors.
    pub seed: u64,
    /// What it is set to.
    pub settings: Vec<(String, f64)>,
    /// How long an answer may take.
    pub timeout: Duration,
}
