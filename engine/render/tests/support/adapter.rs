//! Whether tests can draw: the one answer for the tests of all packages, each of which includes this file.

use std::fmt::Display;

/// What was found to draw with; nothing, and a note, where there is nothing and nobody insists.
pub fn unless_missing<A, E: Display>(found: Result<A, E>) -> Option<A> {
    match found {
        Ok(adapter) => Some(adapter),
        Err(error) if std::env::var_os("PARACOSM_REQUIRE_ADAPTER").is_none_or(|required| required != "1") => {
            eprintln!("SKIPPED: {error}");
            None
        }
        Err(error) => panic!("PARACOSM_REQUIRE_ADAPTER=1: {error}"),
    }
}
