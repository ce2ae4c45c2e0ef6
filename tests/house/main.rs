//! The plan of the house, kept by a test.
//!
//! A rule that only a document holds is broken by the first change in a hurry. This test reads the workspace as cargo
//! and the compiler do, its manifests and its syntax trees, and says which line breaks which rule:
//!
//! - [`floors`]: a crate uses crates of lower floors, never one above or beside it.
//! - [`cycles`]: the modules of a crate do not import one another in a circle.
//! - [`sizes`]: a crate has at most 20,000 lines without its tests.
//! - [`texts`]: an error is a type with data; its words are made where it is shown.
//! - [`decisions`]: no decision reads the words of a message.
//! - [`excerpts`]: the page on extending shows code that exists.
//! - [`features`]: the table of features counts the crates that each builds.
//! - [`sentences`]: the documentation of an item begins with a plain statement.

mod cycles;
mod decisions;
mod excerpts;
mod features;
mod floors;
mod imports;
mod sentences;
mod sizes;
mod source;
mod texts;
mod workspace;

/// Fails with all that is wrong, and with what to do about it.
fn expect_none(wrong: &[String], advice: &str) {
    assert!(wrong.is_empty(), "\n\n{}\n\n{advice}\n", wrong.join("\n"));
}
