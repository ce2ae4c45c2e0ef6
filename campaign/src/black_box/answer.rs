//! Reads and checks the answers of a system.

use crate::json::Number;
use crate::samples::{TraceFlaw, trace_of};
use paracosm_oracles::Trace;
use paracosm_space::{Record, WordFlaw, word_flaw};
use serde::de::Visitor;
use serde::{Deserialize, Deserializer};
use serde_json::error::Category;
use std::fmt;
use thiserror::Error;

/// The answer of an external system to a test.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// The complete trace of the test.
    Trace(Trace),
    /// The id and the robustness of each requirement.
    Robustness(Vec<(String, f64)>),
    /// The system could not run the test.
    NotDone {
        /// The reason why the system could not run the test.
        why: String,
    },
}

/// The description of an expected answer, for messages.
const EXPECTED: &str = "an answer as JSON, {\"index\": …} with `trace`, `robustness` or `error`";

/// The greatest number of requirements in an answer. Tables, reports and searches compare requirements by their ids.
const MOST_REQUIREMENTS: usize = 1000;

/// The number of characters of an answer that a message quotes.
const QUOTED: usize = 40;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    index: usize,
    trace: Option<Record<Vec<Sample>>>,
    robustness: Option<Record<Number>>,
    error: Option<String>,
}

/// A sample of a signal: `true` is 1, `false` is 0, and a missing value is NaN.
#[derive(Clone, Copy)]
struct Sample(f64);

/// The reason why a line of an external system's output is not a valid answer to a test.
#[derive(Debug, Error)]
pub enum AnswerFlaw {
    /// The line is not JSON, or the JSON does not have the form of an answer.
    #[error("found `{found}` in column {column} ({}), expected {EXPECTED}", words(.source))]
    NoAnswer {
        /// The first characters of the invalid text, at most 40.
        found: String,
        /// The position of the error in the line, in bytes from 1.
        column: usize,
        /// The error that the JSON parser reported.
        source: serde_json::Error,
    },
    /// The index in the answer differs from the index of the test.
    #[error("found the answer to test {found}, expected the answer to test {expected}")]
    Index {
        /// The index in the answer.
        found: usize,
        /// The index of the test that the system was asked to run.
        expected: usize,
    },
    /// The answer has an index, but no trace, no robustness and no error.
    #[error("found only an index, expected {EXPECTED}")]
    Empty,
    /// The answer has more than one of the entries `trace`, `robustness` and `error`.
    #[error("found several of `trace`, `robustness` and `error`, expected exactly one of these three")]
    Several,
    /// The robustness of a requirement is not a number.
    #[error("the robustness of `{requirement}` is not a number")]
    Robustness {
        /// The id of the requirement whose robustness is not a number.
        requirement: String,
    },
    /// The answer has the robustness of too many requirements.
    #[error(
        "found the robustness of {found} requirements, expected at most {MOST_REQUIREMENTS}: join requirements by their \
         smallest robustness"
    )]
    TooMany {
        /// The number of requirements in the answer.
        found: usize,
    },
    /// Tables and reports cannot show the id of a requirement.
    #[error("the id of a requirement {flaw}")]
    Id {
        /// The reason why the id cannot be shown.
        flaw: WordFlaw,
    },
    /// The answer contains an empty list of robustness values.
    #[error("`robustness` is empty, expected the robustness of at least one requirement")]
    NoRobustness,
    /// The trace of the answer is invalid.
    #[error(transparent)]
    Trace(#[from] TraceFlaw),
}

impl Answer {
    /// Makes the answer with the robustness of each requirement. A robustness below 0 is a violation.
    ///
    /// # Errors
    /// There is no requirement, there are too many, a robustness is NaN, or an id cannot be shown.
    pub fn of_robustness(robustness: Vec<(String, f64)>) -> Result<Self, AnswerFlaw> {
        let found = robustness.len();
        if found == 0 {
            return Err(AnswerFlaw::NoRobustness);
        }
        if found > MOST_REQUIREMENTS {
            return Err(AnswerFlaw::TooMany { found });
        }
        for (id, number) in &robustness {
            if number.is_nan() {
                return Err(AnswerFlaw::Robustness { requirement: id.clone() });
            }
            word_flaw(id).map_or(Ok(()), |flaw| Err(AnswerFlaw::Id { flaw }))?;
        }
        Ok(Self::Robustness(robustness))
    }

    /// Reads the answer of an external system to the test with the given index.
    ///
    /// # Errors
    /// The line is not a valid answer to this test.
    pub fn read(line: &str, index: usize) -> Result<Self, AnswerFlaw> {
        let text = line.trim();
        let answer: Line = match serde_json::from_str(text) {
            Ok(answer) => answer,
            // Some languages write numbers that JSON does not have. If the rest is not JSON either, the first error
            // names the place.
            Err(error) => serde_json::from_str(&without_nan(text)).map_err(|_| no_answer(text, error))?,
        };
        if answer.index != index {
            return Err(AnswerFlaw::Index { found: answer.index, expected: index });
        }
        match (answer.trace, answer.robustness, answer.error) {
            (Some(trace), None, None) => Ok(Self::Trace(read_trace(&trace)?)),
            (None, Some(robustness), None) => read_robustness(&robustness),
            (None, None, Some(error)) => Ok(Self::NotDone { why: error }),
            (None, None, None) => Err(AnswerFlaw::Empty),
            _ => Err(AnswerFlaw::Several),
        }
    }
}

/// Rewrites infinities in a form that JSON can have, and NaN as `null`, outside of quoted words.
fn without_nan(text: &str) -> String {
    let parts = text.split('"').enumerate().map(|(place, part)| {
        if place % 2 == 1 {
            return part.to_owned();
        }
        let written = [("-Infinity", r#""-inf""#), ("Infinity", r#""inf""#), ("NaN", "null")];
        written.iter().fold(part.to_owned(), |part, (word, other)| part.replace(word, other))
    });
    parts.collect::<Vec<_>>().join("\"")
}

/// Returns the error of a line that is not an answer, with the place if the line is not JSON.
fn no_answer(text: &str, error: serde_json::Error) -> AnswerFlaw {
    let column = if error.is_data() { 1 } else { error.column() };
    // The column counts bytes from 1.
    let at = (0..column.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
    // An error in the contents of parsed JSON has no place.
    let contents = serde_json::from_str(text).ok().and_then(|json| serde_json::from_value::<Line>(json).err());
    AnswerFlaw::NoAnswer {
        found: text[at..].chars().take(QUOTED).collect(),
        column: at + 1,
        source: contents.unwrap_or(error),
    }
}

/// Returns the description of a JSON error without its place, which the message names separately.
fn words(error: &serde_json::Error) -> String {
    match error.classify() {
        Category::Syntax => "it is not JSON".to_owned(),
        Category::Eof => "it ends too early".to_owned(),
        Category::Data | Category::Io => error.to_string(),
    }
}

fn read_robustness(robustness: &Record<Number>) -> Result<Answer, AnswerFlaw> {
    let worth = |(id, number): (&str, &Number)| (id.to_owned(), number.0.unwrap_or(f64::NAN));
    Answer::of_robustness(robustness.iter().map(worth).collect())
}

fn read_trace(answer: &Record<Vec<Sample>>) -> Result<Trace, TraceFlaw> {
    let numbers = |samples: &[Sample]| samples.iter().map(|sample| sample.0).collect::<Vec<f64>>();
    trace_of(&answer.iter().map(|(name, samples)| (name.to_owned(), numbers(samples))).collect::<Vec<_>>())
}

impl<'de> Deserialize<'de> for Sample {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AnySample;
        impl Visitor<'_> for AnySample {
            type Value = Sample;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, true or false")
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

            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<Sample, E> {
                match word {
                    "inf" => Ok(Sample(f64::INFINITY)),
                    "-inf" => Ok(Sample(f64::NEG_INFINITY)),
                    _ => Err(E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                }
            }

            fn visit_unit<E>(self) -> Result<Sample, E> {
                Ok(Sample(f64::NAN))
            }
        }
        deserializer.deserialize_any(AnySample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn refuses(line: &str, says: &str) {
        let message = Answer::read(line, 3).unwrap_err().to_string();
        assert!(message.contains(says), "{message}");
    }

    #[test]
    fn answers_are_traces_robustness_and_errors() {
        let mut trace = Trace::new(0.1, vec!["a".into(), "b".into()]);
        [[1.0, 1.0], [2.0, 0.0], [3.5, 1.0]].iter().for_each(|row| trace.record(row));
        trace.finish();
        // The sum of three tenths is not quite 0.3.
        let line = r#"{"index":3,"trace":{"a":[1,2,3.5],"time":[0,0.1,0.20000000000000001],"b":[true,false,true]}}"#;
        assert_eq!(Answer::read(line, 3).unwrap(), Answer::Trace(trace));
        let line = r#" {"robustness":{"x":-1,"y":"inf"},"index":3} "#;
        let robustness = vec![("x".to_owned(), -1.0), ("y".to_owned(), f64::INFINITY)];
        assert_eq!(Answer::read(line, 3).unwrap(), Answer::Robustness(robustness));
        assert_eq!(Answer::read(r#"{"index":3,"error":"no"}"#, 3).unwrap(), Answer::NotDone { why: "no".into() });
    }

    #[test]
    fn what_is_no_answer_is_quoted() {
        refuses("", "found `` in column 1");
        refuses("é hello", "found `é hello` in column 1");
        refuses(r#"{"index":3,"trace":{"time":[0,wrong]}}"#, "found `wrong]}}` in column 31");
        let infinite = Answer::read(r#"{"index":3,"robustness":{"a":-Infinity,"b":Infinity}}"#, 3).unwrap();
        let expected = [("a".to_owned(), f64::NEG_INFINITY), ("b".to_owned(), f64::INFINITY)];
        assert!(matches!(infinite, Answer::Robustness(all) if all == expected));
        refuses(r#"{"index":3,"robustness":{"a":NaN}}"#, "the robustness of `a` is not a number");
        refuses(r#"{"index":3,"robustness":{"a":"NaN"}}"#, "expected a number");
        refuses(r#"{"trace":{"time":[0,1],"a":[0,1]}}"#, "missing field `index`");
        refuses(r#"{"index":3,"robustnes":{"a":1}}"#, "unknown field `robustnes`, expected one of");
        refuses(r#"{"index":3}"#, "found only an index");
        refuses(r#"{"index":3,"error":"x","robustness":{"a":1}}"#, "several");
        refuses(r#"{"index":3.5,"error":"x"}"#, "invalid type");
        refuses(r#"{"index":4,"error":"x"}"#, "found the answer to test 4, expected the answer to test 3");
        refuses(r#"[1,2]"#, "expected an answer as JSON");
        refuses(r#"{"index":3,"robustness":{}}"#, "`robustness` is empty");
        refuses(r#"{"index":3,"robustness":{"a":null}}"#, "the robustness of `a` is not a number");
        let many: Vec<String> = (0..1001).map(|i| format!("\"r{i}\":1")).collect();
        refuses(
            &format!("{{\"index\":3,\"robustness\":{{{}}}}}", many.join(",")),
            "found the robustness of 1001 requirements, expected at most 1000",
        );
        refuses(r#"{"index":3,"robustness":{"a\u001b":1}}"#, "the id of a requirement has the control character");
        refuses(r#"{"index":3,"trace":{"time":[0,1],"=f(x)":[0,1]}}"#, "the name of signal 1 is a formula");
        refuses(r#"{"index":3,"robustness":{"a":1,"a":2}}"#, "found `a` twice, expected one value per name");
    }

    #[test]
    fn what_is_no_trace_says_where() {
        let trace = |columns: &str| format!(r#"{{"index":3,"trace":{{{columns}}}}}"#);
        refuses(&trace(r#""a":[0,1]"#), "found a, expected `time` among them");
        refuses(&trace(r#""time":[0,1]"#), "found no signal beside `time`");
        refuses(&trace(r#""time":[],"a":[]"#), "found 0 samples, expected at least 2");
        refuses(&trace(r#""time":[0],"a":[1]"#), "found 1 sample, expected at least 2");
        refuses(&trace(r#""time":[0,1],"a":[1,2,3]"#), "`a` has 3 samples, expected 2");
        let nothing = "has no finite value (NaN, infinity or null) at sample 1";
        refuses(&trace(r#""time":[0,0.5],"a":[1,null]"#), &format!("`a` {nothing}, 0.5 s"));
        refuses(&trace(r#""time":[0,0.5],"NaN":[1,NaN]"#), &format!("`NaN` {nothing}, 0.5 s"));
        refuses(&trace(r#""time":[0,0.5],"a":[1,-Infinity]"#), &format!("`a` {nothing}, 0.5 s"));
        refuses(&trace(r#""time":[0,Infinity],"a":[1,2]"#), &format!("`time` {nothing}"));
        refuses(&trace(r#""time":[0,1],"a":[1,"x"]"#), "expected a number, true or false");
        refuses(&trace(r#""time":[1,2],"a":[1,2]"#), "begins at 1 s, expected 0 s");
        refuses(&trace(r#""time":[0,1,1],"a":[1,2,3]"#), "from 1 to 1 at sample 2");
        refuses(&trace(r#""time":[0,1,3],"a":[1,2,3]"#), "not evenly spaced: sample 1 is at 1 s, expected 1.5 s");
    }
}
