//! Writes the names of parameters, and values, in the way in which constraints read them.

use crate::Value;
use std::fmt;

/// The words of the language. A parameter with such a name has to be written in brackets.
pub(super) const KEYWORDS: [&str; 5] = ["in", "not", "and", "or", "implies"];

/// Returns `true` if a name may be written without brackets.
pub(super) fn is_plain(name: &str) -> bool {
    let mut signs = name.chars();
    signs.next().is_some_and(begins_name) && signs.all(continues_name) && !KEYWORDS.contains(&name)
}

pub(super) fn begins_name(sign: char) -> bool {
    sign.is_alphabetic() || sign == '_'
}

pub(super) fn continues_name(sign: char) -> bool {
    sign.is_alphanumeric() || sign == '_' || sign == '.'
}

/// Writes a name as the language does: in brackets if they are necessary.
pub(super) struct Name<'a>(pub &'a str);

impl fmt::Display for Name<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if is_plain(self.0) { f.write_str(self.0) } else { enclosed(f, '[', self.0, ']') }
    }
}

/// Writes a value as the language does: words in quotes.
pub(super) struct Written<'a>(pub &'a Value);

impl fmt::Display for Written<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.0.word(), self.0.number()) {
            (Some(word), _) => enclosed(f, '\'', word, '\''),
            // Constraints compare numbers, however the levels are written.
            (None, Some(number)) => write!(f, "{number}"),
            (None, None) => write!(f, "{}", self.0),
        }
    }
}

fn enclosed(f: &mut fmt::Formatter<'_>, open: char, text: &str, close: char) -> fmt::Result {
    write!(f, "{open}")?;
    for sign in text.chars() {
        if sign == close || sign == '\\' {
            f.write_str("\\")?;
        }
        write!(f, "{sign}")?;
    }
    write!(f, "{close}")
}
