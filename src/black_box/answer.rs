//! What a system answers, read and checked.

use crate::json::Number;
use paracosm_coverage::Record;
use paracosm_oracles::Trace;
use serde::de::Visitor;
use serde::{Deserialize, Deserializer};
use std::fmt;

/// The answer to a test.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Answer {
    /// What happened, to its end.
    Trace(Trace),
    /// The robustness of requirements by their ids.
    Robustness(Vec<(String, f64)>),
    /// The system says that it could not do the test, and why.
    Error(String),
}

/// What is expected of an answer, in words.
const EXPECTED: &str = "an answer as JSON, {\"index\": …} with `trace`, `robustness` or `error`";

/// By how much of the sample period a time may be off.
const TOLERANCE: f64 = 1e-3;

/// How much of an answer is quoted, in characters.
const QUOTED: usize = 40;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    index: usize,
    trace: Option<Record<Vec<Sample>>>,
    robustness: Option<Record<Number>>,
    error: Option<String>,
}

/// A sample of a signal: a truth is 1 or 0, and what has no value is NaN.
#[derive(Clone, Copy)]
struct Sample(f64);

impl Answer {
    /// Reads the answer to the test of this index.
    pub fn read(line: &str, index: usize) -> Result<Self, String> {
        let text = line.trim();
        let answer: Line = serde_json::from_str(text).map_err(|error| no_answer(text, &error))?;
        if answer.index != index {
            return Err(format!("found the answer to test {}, expected that to test {index}", answer.index));
        }
        match (answer.trace, answer.robustness, answer.error) {
            (Some(trace), None, None) => read_trace(&trace).map(Self::Trace),
            (None, Some(robustness), None) => read_robustness(&robustness).map(Self::Robustness),
            (None, None, Some(error)) => Ok(Self::Error(error)),
            (None, None, None) => Err(format!("found only an index, expected {EXPECTED}")),
            _ => Err("found several of `trace`, `robustness` and `error`, expected one".into()),
        }
    }
}

/// What is wrong with a line that is no answer: the place, if it is no JSON.
fn no_answer(text: &str, error: &serde_json::Error) -> String {
    let column = if error.is_data() { 1 } else { error.column() };
    // The column counts bytes from 1.
    let at = (0..column.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
    let found: String = text[at..].chars().take(QUOTED).collect();
    let error = error.to_string();
    let why = error.split(" at line ").next().unwrap_or_default();
    format!("found `{found}` in column {} ({why}), expected {EXPECTED}", at + 1)
}

fn read_robustness(robustness: &Record<Number>) -> Result<Vec<(String, f64)>, String> {
    let worth = |(id, number): (&str, &Number)| {
        let number = number.0.filter(|number| !number.is_nan());
        let number = number.ok_or_else(|| format!("the robustness of `{id}` is no number"))?;
        Ok((id.to_owned(), number))
    };
    let all: Vec<_> = robustness.iter().map(worth).collect::<Result<_, String>>()?;
    if all.is_empty() { Err("found the robustness of nothing, expected a requirement".into()) } else { Ok(all) }
}

fn read_trace(answer: &Record<Vec<Sample>>) -> Result<Trace, String> {
    let time = answer.get("time").ok_or("the trace has no `time`")?;
    for (name, samples) in answer.iter() {
        if samples.len() != time.len() {
            return Err(format!("`{name}` has {} samples, expected {} as `time` has", samples.len(), time.len()));
        }
        if let Some(at) = samples.iter().position(|sample| !sample.0.is_finite()) {
            return Err(format!("`{name}` has no finite value at sample {at}"));
        }
    }
    let dt = period(time)?;
    let (names, signals): (Vec<_>, Vec<_>) = answer.iter().filter(|(name, _)| *name != "time").unzip();
    if names.is_empty() {
        return Err("the trace has no signal beside `time`".into());
    }
    let mut trace = Trace::new(dt, names.into_iter().map(str::to_owned).collect());
    trace.reserve(time.len());
    for tick in 0..time.len() {
        trace.record(&signals.iter().map(|samples| samples[tick].0).collect::<Vec<_>>());
    }
    trace.finish();
    Ok(trace)
}

/// The sample period of evenly spaced times from 0 on, in seconds.
fn period(time: &[Sample]) -> Result<f64, String> {
    let [first, .., last] = time else {
        return Err(format!("found {} samples, expected two at least", time.len()));
    };
    if first.0 != 0.0 {
        return Err(format!("the trace begins at {} s, expected 0 s", first.0));
    }
    if let Some(at) = time.windows(2).position(|pair| pair[1].0 <= pair[0].0) {
        let [before, after] = [time[at].0, time[at + 1].0];
        return Err(format!("`time` goes from {before} to {after} at sample {}, expected it to rise", at + 1));
    }
    // Rounded to twelve digits, so that times that were added up give the period that was meant.
    let mean = last.0 / (time.len() - 1) as f64;
    let dt: f64 = format!("{mean:.11e}").parse().expect("a number as it was written");
    let uneven = |(tick, at): (usize, &Sample)| (at.0 - tick as f64 * dt).abs() > TOLERANCE * dt;
    match time.iter().enumerate().position(uneven) {
        None if dt > 0.0 => Ok(dt),
        at => {
            let at = at.unwrap_or(0);
            let (found, expected) = (time[at].0, at as f64 * dt);
            Err(format!("the samples are not evenly spaced: sample {at} is at {found} s, expected {expected} s"))
        }
    }
}

impl<'de> Deserialize<'de> for Sample {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AnySample;
        impl Visitor<'_> for AnySample {
            type Value = Sample;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or a truth")
            }

            fn visit_bool<E>(self, truth: bool) -> Result<Sample, E> {
                Ok(Sample(f64::from(u8::from(truth))))
            }

            fn visit_i64<E>(self, number: i64) -> Result<Sample, E> {
                Ok(Sample(number as f64))
            }

            fn visit_u64<E>(self, number: u64) -> Result<Sample, E> {
                Ok(Sample(number as f64))
            }

            fn visit_f64<E>(self, number: f64) -> Result<Sample, E> {
                Ok(Sample(number))
            }

            fn visit_unit<E>(self) -> Result<Sample, E> {
                Ok(Sample(f64::NAN))
            }
        }
        deserializer.deserialize_any(AnySample)
    }
}
