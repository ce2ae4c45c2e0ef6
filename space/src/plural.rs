//! Numbers and lists of things in messages: "1 test", "2 tests", "a, b and 3 more", "speed 2.5, lanes 4".

use crate::{Value, Values};

/// Returns a count with its noun, such as "1 test" or "2 tests". The plural of the noun has to end in `s`.
///
/// ```
/// assert_eq!(paracosm_space::plural(1, "test"), "1 test");
/// assert_eq!(paracosm_space::plural(0, "test"), "0 tests");
/// ```
pub fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Joins texts with commas. Of more than `most` texts, the first `most` and the number of the others are named.
///
/// ```
/// let texts = ["a", "b", "c"].map(str::to_owned);
/// assert_eq!(paracosm_space::some_of(&texts, 3), "a, b, c");
/// assert_eq!(paracosm_space::some_of(&texts, 2), "a, b and 1 more");
/// ```
pub fn some_of(texts: &[String], most: usize) -> String {
    let (first, others) = texts.split_at(texts.len().min(most));
    let more = if others.is_empty() { String::new() } else { format!(" and {} more", others.len()) };
    first.join(", ") + &more
}

/// Returns a number with five significant digits. Very small and large numbers have an exponent.
///
/// ```
/// assert_eq!(paracosm_space::digits(2.0 / 3.0), "0.66667");
/// assert_eq!(paracosm_space::digits(-16.5), "-16.5");
/// assert_eq!(paracosm_space::digits(1.5e-9), "1.5000e-9");
/// ```
pub fn digits(number: f64) -> String {
    let scientific = format!("{number:.4e}");
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if number == 0.0 || !number.is_finite() {
        return format!("{number}");
    }
    if !(-5..7).contains(&exponent) {
        return scientific;
    }
    let decimals = (4 - exponent).max(0) as usize;
    let text = format!("{number:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Returns values with their names, such as "speed 2.5, lanes 4".
pub fn values_in_words(values: &Values) -> String {
    let value = |value: &Value| value.number().map_or_else(|| value.to_string(), digits);
    values.iter().map(|(name, of)| format!("{name} {}", value(of))).collect::<Vec<_>>().join(", ")
}
