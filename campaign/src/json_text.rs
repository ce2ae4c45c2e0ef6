//! Reads JSON texts, with errors that name the entry.

use crate::Reason;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// The error in a JSON text, with the entry in which it is.
#[derive(Debug, Error)]
#[error("{}{}", in_entry(.entry), in_words(.flaw))]
pub struct JsonFlaw {
    /// The name of the entry, with the names of the entries around it; `.` if the text is no JSON.
    pub entry: String,
    /// The error, with its line and its column.
    pub flaw: serde_json::Error,
}

impl Reason for JsonFlaw {}

fn in_entry(entry: &str) -> String {
    if entry == "." { String::new() } else { format!("`{entry}`: ") }
}

/// The names of Rust types in messages of the JSON reader, and words for them.
const WORDS: [(&str, &str); 8] = [
    ("expected usize", "expected a whole number"),
    ("expected u64", "expected a whole number"),
    ("expected u32", "expected a whole number"),
    ("expected f64", "expected a number"),
    ("expected a sequence", "expected a list"),
    ("expected a map", "expected an object"),
    ("expected a boolean", "expected true or false"),
    ("unit value", "nothing"),
];

/// Returns the message of an error with its column, but without the line, which the message about the file has.
fn in_words(flaw: &serde_json::Error) -> String {
    let (line, column) = (flaw.line(), flaw.column());
    let message = flaw.to_string().replace(&format!(" at line {line} column {column}"), "");
    let message = WORDS.iter().fold(message, |message, (theirs, ours)| message.replace(theirs, ours));
    if column > 0 { format!("{message} (column {column})") } else { message }
}

impl JsonFlaw {
    /// Returns the line number of the error, from 1.
    pub fn line(&self) -> usize {
        self.flaw.line()
    }
}

/// Reads a value from a JSON text.
///
/// # Errors
/// The text is not JSON, or the JSON does not describe the value.
pub fn read_json<T: DeserializeOwned>(text: &str) -> Result<T, JsonFlaw> {
    let mut json = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut json)
        .map_err(|error| JsonFlaw { entry: error.path().to_string(), flaw: error.into_inner() })?;
    json.end().map_err(|flaw| JsonFlaw { entry: ".".to_owned(), flaw })?;
    Ok(value)
}
