//! What a parser has to say to people.

use thiserror::Error;

/// Text that is no formula: where, what stands there, and what was expected instead.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("column {column}: found {found}, expected {expected}{}", remark(.help))]
pub struct ParseError {
    /// The position in the text, counted in characters from 1.
    pub column: usize,
    /// What stands there.
    pub found: String,
    /// What could stand there.
    pub expected: String,
    /// What may have been meant.
    pub help: Option<String>,
}

fn remark(help: &Option<String>) -> String {
    help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default()
}
