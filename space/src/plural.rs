//! Numbers of things in messages: "1 test", "2 tests".

/// Returns a count with its noun, such as "1 test" or "2 tests". The plural of the noun has to end in `s`.
///
/// ```
/// assert_eq!(paracosm_space::plural(1, "test"), "1 test");
/// assert_eq!(paracosm_space::plural(0, "test"), "0 tests");
/// ```
pub fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
