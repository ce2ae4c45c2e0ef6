//! Reads the questions of a page, and says what is wrong with other texts.

use super::Question;
use paracosm_space::{did_you_mean, nearest};
use serde_json::Value;
use thiserror::Error;

/// The names of all questions, each with what belongs to the question.
const QUESTIONS: [(&str, &str); 7] = [
    ("progress", "nothing"),
    ("map", "the positions of two coordinates, such as [0, 1]"),
    ("run", TEST),
    ("shrink", TEST),
    ("blame", TEST),
    ("cameras", "nothing"),
    ("film", "`test` and `camera`: a test as for `run`, and the name of a camera"),
];

/// The form of a test.
const TEST: &str = "the index of a test, or a number for each coordinate of a new test";

/// The error that a text is not a question.
#[derive(Debug, Error)]
pub(super) enum NoQuestion {
    #[error("the question is not JSON: {0}")]
    NoJson(serde_json::Error),
    #[error("found {found}, expected a question: {}", names())]
    NoName { found: String },
    #[error("no question is called `{name}`{}; there are {}", did_you_mean(&nearest(name, QUESTIONS.map(|(name, _)| name))), names())]
    Unknown { name: String },
    #[error("`{name}`: found {found}, expected {expected}")]
    Content { name: String, found: String, expected: &'static str },
}

fn names() -> String {
    QUESTIONS.map(|(name, _)| format!("`{name}`")).join(", ")
}

impl Question {
    /// Reads a question: its name as a text, or an object whose only entry has the name of the question.
    pub(super) fn read(text: &[u8]) -> Result<Self, NoQuestion> {
        let value: Value = serde_json::from_slice(text).map_err(NoQuestion::NoJson)?;
        let (name, content) = match &value {
            Value::String(name) => (name, &Value::Null),
            Value::Object(entries) if entries.len() == 1 => entries.iter().next().expect("it has one"),
            other => return Err(NoQuestion::NoName { found: shown(other) }),
        };
        let Some((_, expected)) = QUESTIONS.into_iter().find(|(known, _)| known == name) else {
            return Err(NoQuestion::Unknown { name: name.chars().take(LONGEST).collect() });
        };
        serde_json::from_value(value.clone()).map_err(|_| NoQuestion::Content {
            name: name.clone(),
            found: shown(content),
            expected,
        })
    }
}

/// The greatest number of characters of a wrong text in a message.
const LONGEST: usize = 60;

fn shown(value: &Value) -> String {
    let text = if value.is_null() { "nothing".to_owned() } else { value.to_string() };
    if text.chars().count() <= LONGEST {
        text
    } else {
        format!("{}...", text.chars().take(LONGEST).collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_question_is_read() {
        for text in [
            r#""progress""#,
            r#"{"map":[0,1]}"#,
            r#"{"run":3}"#,
            r#"{"run":[1.5,2]}"#,
            r#"{"shrink":3}"#,
            r#"{"blame":[1,2]}"#,
            r#""cameras""#,
            r#"{"film":{"test":3,"camera":"front"}}"#,
        ] {
            assert!(Question::read(text.as_bytes()).is_ok(), "{text}");
        }
    }

    #[test]
    fn other_texts_are_told_what_a_question_is() {
        for (text, says) in [
            ("{", "the question is not JSON: EOF while parsing"),
            ("3", "found 3, expected a question: `progress`, `map`, `run`"),
            (r#"{"run":1,"map":2}"#, "found {\"map\":2,\"run\":1}, expected a question"),
            (r#""unknown""#, "no question is called `unknown`; there are `progress`"),
            (r#"{"runs":1}"#, "no question is called `runs` (did you mean `run`?)"),
            (
                r#"{"run":-1}"#,
                "`run`: found -1, expected the index of a test, or a number for each coordinate of a new test",
            ),
            (r#"{"run":{"speed":3}}"#, "`run`: found {\"speed\":3}, expected the index of a test"),
            (r#"{"map":[0]}"#, "`map`: found [0], expected the positions of two coordinates"),
            (r#"{"film":3}"#, "`film`: found 3, expected `test` and `camera`"),
        ] {
            let error = Question::read(text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(says), "{text}: {error}");
        }
    }
}
