//! What keeps a list of samples from being a trace, whether a system answered with it or it stands in a file.

use crate::Reason;
use thiserror::Error;

/// What keeps samples from being a trace: times in seconds, evenly spaced from 0 on, and a number for every signal at each.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TraceFlaw {
    /// There are no times.
    #[error("found {}, expected `time` among them", found(.signals))]
    NoTime {
        /// What there is.
        signals: Vec<String>,
    },
    /// There is nothing but times.
    #[error("found no signal beside `time`, expected one at least")]
    NoSignal,
    /// Two signals have one name.
    #[error("two signals are called `{signal}`")]
    Twice {
        /// The name.
        signal: String,
    },
    /// There are too few samples to tell the sample period.
    #[error("found {samples} samples, expected two at least")]
    TooShort {
        /// How many there are.
        samples: usize,
    },
    /// A signal has more or fewer samples than there are times.
    #[error("`{signal}` has {found} samples, expected {expected} as `time` has")]
    Length {
        /// The signal.
        signal: String,
        /// How many samples it has.
        found: usize,
        /// How many times there are.
        expected: usize,
    },
    /// A sample is no number.
    #[error("`{signal}` is `{found}` at sample {sample}, expected a number")]
    NoNumber {
        /// The signal.
        signal: String,
        /// What stands there.
        found: String,
        /// Which sample, from 0.
        sample: usize,
    },
    /// A sample is no finite number.
    #[error(
        "`{signal}` has no finite value (NaN, infinity or null) at sample {sample}{}",
        time.map(|time| format!(", {time} s")).unwrap_or_default()
    )]
    NoValue {
        /// The signal.
        signal: String,
        /// Which sample, from 0.
        sample: usize,
        /// Its time, if that is known.
        time: Option<f64>,
    },
    /// The first time is not 0.
    #[error("the trace begins at {at} s, expected 0 s")]
    Begins {
        /// The first time.
        at: f64,
    },
    /// A time is not later than the one before it.
    #[error("`time` goes from {from} to {to} at sample {sample}, expected it to rise")]
    Falls {
        /// The time before.
        from: f64,
        /// The time.
        to: f64,
        /// Which sample, from 0.
        sample: usize,
    },
    /// Two times are further apart than others.
    #[error("the samples are not evenly spaced: sample {sample} is at {found} s, expected {expected} s")]
    Uneven {
        /// Which sample, from 0.
        sample: usize,
        /// Its time.
        found: f64,
        /// The time that even samples have there.
        expected: f64,
    },
}

impl Reason for TraceFlaw {}

fn found(signals: &[String]) -> String {
    if signals.is_empty() { "nothing".to_owned() } else { signals.join(", ") }
}
