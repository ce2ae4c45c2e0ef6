//! Reads JSON texts, with errors that name the entry.

use crate::Reason;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// The error in a JSON text, with the entry in which it is.
#[derive(Debug, Error)]
#[error("{}{flaw}", in_entry(.entry))]
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
