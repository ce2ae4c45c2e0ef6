//! The errors in a list of samples that should be a trace, whether a system answered with it or it stands in a file.

use crate::Reason;
use paracosm_space::plural;
use thiserror::Error;

/// The reason why samples are not a trace. A trace has times in seconds, evenly spaced from 0 on, and a number for
/// every signal at each time.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TraceFlaw {
    /// There are no times.
    #[error("found {}, expected `time` among them", found(.signals))]
    NoTime {
        /// The signals that were found.
        signals: Vec<String>,
    },
    /// There is nothing but times.
    #[error("found no signal beside `time`, expected at least one signal")]
    NoSignal,
    /// Two signals have one name.
    #[error("two signals are called `{signal}`")]
    Twice {
        /// The name of the two signals.
        signal: String,
    },
    /// There are too few samples to tell the sample period.
    #[error("found {}, expected at least 2", plural(*samples, "sample"))]
    TooShort {
        /// The number of samples.
        samples: usize,
    },
    /// A signal has more or fewer samples than there are times.
    #[error("`{signal}` has {}, expected {expected}, as many as `time`", plural(*found, "sample"))]
    Length {
        /// The name of the signal.
        signal: String,
        /// The number of samples of the signal.
        found: usize,
        /// The number of times.
        expected: usize,
    },
    /// A sample is not a number.
    #[error("`{signal}` is `{found}` at sample {sample}, expected a number")]
    NoNumber {
        /// The name of the signal.
        signal: String,
        /// The text that was found.
        found: String,
        /// The index of the sample, from 0.
        sample: usize,
    },
    /// A sample is not finite.
    #[error(
        "`{signal}` has no finite value (NaN, infinity or null) at sample {sample}{}",
        time.map(|time| format!(", {time} s")).unwrap_or_default()
    )]
    NoValue {
        /// The name of the signal.
        signal: String,
        /// The index of the sample, from 0.
        sample: usize,
        /// The time of the sample, if it is known.
        time: Option<f64>,
    },
    /// The first time is not 0.
    #[error("the trace begins at {at} s, expected 0 s")]
    Begins {
        /// The first time.
        at: f64,
    },
    /// A time is not later than the time before it.
    #[error("`time` goes from {from} to {to} at sample {sample}, expected it to rise")]
    Falls {
        /// The time of the sample before.
        from: f64,
        /// The time of the sample.
        to: f64,
        /// The index of the sample, from 0.
        sample: usize,
    },
    /// The distance between two times differs from the sample period.
    #[error("the samples are not evenly spaced: sample {sample} is at {found} s, expected {expected} s")]
    Uneven {
        /// The index of the sample, from 0.
        sample: usize,
        /// The time of the sample.
        found: f64,
        /// The time that the sample should have.
        expected: f64,
    },
}

impl Reason for TraceFlaw {}

fn found(signals: &[String]) -> String {
    if signals.is_empty() { "nothing".to_owned() } else { signals.join(", ") }
}
