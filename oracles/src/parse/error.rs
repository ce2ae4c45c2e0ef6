//! The error of the parser of formulas.

use thiserror::Error;

/// The reason why a text is not a formula. It has the place, the text found there, and the text that was expected.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("column {column}: found {found}, expected {expected}{}", remark(.help))]
pub struct ParseError {
    /// The position of the error in the text, counted in characters from 1.
    pub column: usize,
    /// The token that was found at the position of the error, in words.
    pub found: String,
    /// The tokens that may stand at the position of the error, in words.
    pub expected: String,
    /// A hint for the author, such as the word that was probably meant.
    pub help: Option<String>,
}

fn remark(help: &Option<String>) -> String {
    help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default()
}
