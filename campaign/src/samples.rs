//! Traces from lists of samples, and the errors in a list that should be a trace, whether a system answered with it or it stands in a file.

use crate::Reason;
use paracosm_oracles::Trace;
use paracosm_space::{WordFlaw, plural, some_of, word_flaw};
use std::collections::HashSet;
use thiserror::Error;

/// The reason why a list of samples is not a valid trace. A trace has times in seconds, evenly spaced from 0 on, and a
/// number for every signal at each time.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TraceFlaw {
    /// The samples have no signal `time`.
    #[error("found {}, expected `time` among them", found(.signals))]
    NoTime {
        /// The names of the signals that were found.
        signals: Vec<String>,
    },
    /// The samples have no signal except `time`.
    #[error("found no signal beside `time`, expected at least one signal")]
    NoSignal,
    /// Two signals have the same name.
    #[error("two signals are called `{signal}`")]
    Twice {
        /// The name that two signals share.
        signal: String,
    },
    /// Tables and pictures cannot show the name of a signal.
    #[error("the name of signal {number} {flaw}")]
    Name {
        /// The position of the signal among the signals, from 1.
        number: usize,
        /// The reason why the name cannot be shown.
        flaw: WordFlaw,
    },
    /// The trace has too few samples to determine the sample period.
    #[error("found {}, expected at least 2", plural(*samples, "sample"))]
    TooShort {
        /// The number of samples in the trace.
        samples: usize,
    },
    /// The number of samples of a signal differs from the number of times.
    #[error("`{signal}` has {}, expected {expected}, as many as `time`", plural(*found, "sample"))]
    Length {
        /// The name of the signal with the error.
        signal: String,
        /// The number of samples of the signal.
        found: usize,
        /// The expected number of samples, which is the number of times.
        expected: usize,
    },
    /// A sample is not a number.
    #[error("`{signal}` is `{found}` at sample {sample}, expected a number")]
    NoNumber {
        /// The name of the signal with the error.
        signal: String,
        /// The text that was found in place of a number.
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
        /// The name of the signal with the error.
        signal: String,
        /// The index of the sample, from 0.
        sample: usize,
        /// The time of the sample in seconds, if the time is known.
        time: Option<f64>,
    },
    /// The first time of the trace is not 0.
    #[error("the trace begins at {at} s, expected 0 s")]
    Begins {
        /// The first time of the trace, in seconds.
        at: f64,
    },
    /// A time is not later than the previous time.
    #[error("`time` goes from {from} to {to} at sample {sample}, expected it to rise")]
    Falls {
        /// The time of the previous sample, in seconds.
        from: f64,
        /// The time of the sample, in seconds.
        to: f64,
        /// The index of the sample, from 0.
        sample: usize,
    },
    /// A trace that is sampled again would have too many numbers.
    #[error("the trace would have {samples:.0} samples of {}, which is too much: choose a longer period", plural(*signals, "signal"))]
    TooLong {
        /// The number of samples that the trace would have.
        samples: f64,
        /// The number of signals.
        signals: usize,
    },
    /// The distance between two successive times differs from the sample period.
    #[error("the samples are not evenly spaced: sample {sample} is at {found} s, expected {expected} s")]
    Uneven {
        /// The index of the sample, from 0.
        sample: usize,
        /// The time of the sample, in seconds.
        found: f64,
        /// The expected time of the sample, in seconds.
        expected: f64,
    },
}

impl Reason for TraceFlaw {}

impl TraceFlaw {
    /// Checks the names of the signals of a trace: each occurs once, and tables and pictures can show it.
    pub(crate) fn check_names<'n>(signals: impl Iterator<Item = &'n str>) -> Result<(), Self> {
        let mut seen = HashSet::from(["time"]);
        for (index, signal) in signals.enumerate() {
            if !seen.insert(signal) {
                return Err(Self::Twice { signal: signal.to_owned() });
            }
            if let Some(flaw) = word_flaw(signal) {
                return Err(Self::Name { number: index + 1, flaw });
            }
        }
        Ok(())
    }
}

/// The greatest deviation of a time, as a share of the sample period.
const TOLERANCE: f64 = 1e-3;

/// Makes a complete trace of the samples of its signals. One of the signals is `time`, in seconds, evenly spaced from 0 on.
///
/// # Errors
/// There is no signal `time` or no other signal, a name occurs twice or cannot be shown, the signals differ in length, a sample is not
/// finite, or the times are not evenly spaced from 0 on.
pub fn trace_of(samples: &[(String, Vec<f64>)]) -> Result<Trace, TraceFlaw> {
    let no_time = || TraceFlaw::NoTime { signals: samples.iter().map(|(name, _)| name.clone()).collect() };
    let (_, time) = samples.iter().find(|(name, _)| name == "time").ok_or_else(no_time)?;
    for (name, samples) in samples {
        let signal = name.clone();
        if samples.len() != time.len() {
            return Err(TraceFlaw::Length { signal, found: samples.len(), expected: time.len() });
        }
        if let Some(sample) = samples.iter().position(|sample| !sample.is_finite()) {
            let time = time.get(sample).copied().filter(|time| time.is_finite());
            return Err(TraceFlaw::NoValue { signal, sample, time });
        }
    }
    let dt = period(time)?;
    let signals: Vec<&(String, Vec<f64>)> = samples.iter().filter(|(name, _)| name != "time").collect();
    if signals.is_empty() {
        return Err(TraceFlaw::NoSignal);
    }
    TraceFlaw::check_names(signals.iter().map(|(name, _)| name.as_str()))?;
    let mut trace = Trace::new(dt, signals.iter().map(|(name, _)| name.clone()).collect());
    trace.reserve(time.len());
    for tick in 0..time.len() {
        trace.record(&signals.iter().map(|(_, samples)| samples[tick]).collect::<Vec<_>>());
    }
    trace.finish();
    Ok(trace)
}

/// Returns the sample period of evenly spaced times from 0 on, in seconds.
fn period(time: &[f64]) -> Result<f64, TraceFlaw> {
    let [first, .., last] = time else {
        return Err(TraceFlaw::TooShort { samples: time.len() });
    };
    if *first != 0.0 {
        return Err(TraceFlaw::Begins { at: *first });
    }
    if let Some(at) = time.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(TraceFlaw::Falls { from: time[at], to: time[at + 1], sample: at + 1 });
    }
    // Rounded to twelve digits, so that times from repeated addition give the intended period.
    let mean = last / (time.len() - 1) as f64;
    let dt: f64 = format!("{mean:.11e}").parse().expect("a number as it was written");
    let uneven = |(tick, at): (usize, &f64)| (at - tick as f64 * dt).abs() > TOLERANCE * dt;
    match time.iter().enumerate().position(uneven) {
        None if dt > 0.0 => Ok(dt),
        at => {
            let sample = at.unwrap_or(0);
            Err(TraceFlaw::Uneven { sample, found: time[sample], expected: sample as f64 * dt })
        }
    }
}

/// The greatest number of names in a message.
const MOST_NAMES: usize = 20;

fn found(signals: &[String]) -> String {
    if signals.is_empty() { "nothing".to_owned() } else { some_of(signals, MOST_NAMES) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_period_of_times_that_were_added_up_is_the_one_that_was_meant() {
        let mut time = vec![0.0];
        for tick in 0..3000 {
            time.push(time[tick] + 0.01);
        }
        assert_eq!(period(&time), Ok(0.01));
        let thirds: Vec<f64> = (0..1000).map(|tick| f64::from(tick) / 60.0).collect();
        assert!((period(&thirds).unwrap() * 60.0 - 1.0).abs() < 1e-11);
    }
}
