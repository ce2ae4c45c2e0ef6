//! Spaces as text: reads and writes SPACE.toml, the file that people write and programs exchange.

use super::{Declaration, Space};
use crate::constraint::Constraint;
use crate::parameter::Entry;
use crate::{Domain, Position, SpaceError, Value};
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use toml::Spanned;

impl Space {
    /// Reads a space from the text of a SPACE.toml. A table `[odd]`, which describes the tested operational design
    /// domain, is ignored.
    ///
    /// ```
    /// let space = paracosm_space::Space::from_toml(r#"
    ///     constraints = ["lanes == 2 implies weather != 'fog'"]
    ///
    ///     [[parameter]]
    ///     name = "speed"
    ///     interval = [0.5, 10.0]
    ///     unit = "m/s"
    ///     default = 1.4
    ///     distribution = { beta = [2.0, 5.0] }
    ///
    ///     [[parameter]]
    ///     name = "lanes"
    ///     choice = [2, 4, 6]
    ///
    ///     [[parameter]]
    ///     name = "weather"
    ///     choice = ["clear", "rain", "fog"]
    ///
    ///     [[parameter]]
    ///     name = "leader_speed"
    ///     interval = [0.0, 20.0]
    ///     signal = { shape = "polynomial", degree = 2 }
    /// "#)?;
    /// assert_eq!((space.dims(), space.levels(), space.constraints().len()), (4, vec![3, 3], 1));
    /// # Ok::<(), paracosm_space::SpaceError>(())
    /// ```
    ///
    /// # Errors
    /// The text is not TOML, or does not describe a valid space. [`SpaceError`] says where and why. The position of an
    /// error in a constraint refers to the lines of the file.
    pub fn from_toml(text: &str) -> Result<Self, SpaceError> {
        let declaration: Declaration = toml::from_str(text).map_err(|error| {
            let at = error.span().map(|span| Position::of(text, span.start));
            SpaceError::Toml { error: Box::new(error), at }
        })?;
        let space = Self::try_from(declaration).map(|space| space.written_as_in(text));
        space.map_err(|mut error| {
            if let SpaceError::Constraint { index, error, at, .. } = &mut error {
                let span = constraint_spans(text).into_iter().nth(*index);
                *at = span.map(|span| Position::of(text, within(text, span, error.offset)));
            }
            error
        })
    }

    /// Returns the line, from 1, at which each constraint of a SPACE.toml begins. If the text is not TOML, the list is
    /// empty.
    pub fn constraint_lines(text: &str) -> Vec<usize> {
        constraint_spans(text).into_iter().map(|span| Position::of(text, span.start).line).collect()
    }

    /// Writes the space as the text of a SPACE.toml. [`Space::from_toml`] reads the same space from this text.
    pub fn to_toml(&self) -> String {
        #[derive(Serialize)]
        struct SpelledOut<'a> {
            #[serde(skip_serializing_if = "Vec::is_empty")]
            constraints: Vec<&'a str>,
            parameter: Vec<Entry>,
        }
        let constraints = self.constraints.iter().map(Constraint::text).collect();
        let parameter = self.parameters.iter().cloned().map(Entry::spelled_out).collect();
        toml::to_string(&SpelledOut { constraints, parameter }).expect("names, numbers and words are always TOML")
    }

    /// Returns the same space, with the levels that are numbers written as in the text that the space was read from.
    fn written_as_in(mut self, text: &str) -> Self {
        for (parameter, spans) in self.parameters.iter_mut().zip(choice_spans(text)) {
            let Domain::Choice(levels) = &mut parameter.domain else { continue };
            let taken: Vec<String> = levels.iter().filter_map(Value::word).map(str::to_owned).collect();
            for (level, span) in levels.iter_mut().zip(spans) {
                let written = Value::written(&text[span.clone()]);
                // Only TOML writes numbers like `1_000` and `0x10`, so such a level stays a number. A level that could
                // not be told apart from a word stays a number, too.
                let is_level = matches!(level, Value::Number(_)) && written.means(level);
                if is_level && !taken.iter().any(|word| word == &text[span.clone()]) {
                    *level = written;
                }
            }
        }
        self
    }
}

/// Finds the places of the values of each parameter's choice in the file. If a parameter has the key `written`, its
/// list is empty, since that key gives the texts.
fn choice_spans(text: &str) -> Vec<Vec<Range<usize>>> {
    #[derive(Deserialize)]
    struct Choices {
        parameter: Vec<Choice>,
    }
    #[derive(Deserialize)]
    struct Choice {
        #[serde(default)]
        choice: Vec<Spanned<toml::Value>>,
        written: Option<IgnoredAny>,
    }
    let found = toml::from_str::<Choices>(text).map_or(Vec::new(), |found| found.parameter);
    let spans = |Choice { choice, written }: Choice| match written {
        Some(_) => Vec::new(),
        None => choice.iter().map(Spanned::span).collect(),
    };
    found.into_iter().map(spans).collect()
}

/// Finds the places of the constraints in the file, including their quotes.
fn constraint_spans(text: &str) -> Vec<Range<usize>> {
    #[derive(Deserialize)]
    struct Constraints {
        #[serde(default)]
        constraints: Vec<Spanned<String>>,
    }
    let found = toml::from_str::<Constraints>(text).map_or(Vec::new(), |found| found.constraints);
    found.iter().map(Spanned::span).collect()
}

/// Returns the offset in the file of the byte at `offset` in the string at `span`. If the string has several lines,
/// returns its start, since continued and trimmed lines make the exact place hard to find.
fn within(text: &str, span: Range<usize>, offset: usize) -> usize {
    let quoted = &text[span.clone()];
    if quoted.contains('\n') {
        return span.start;
    }
    let quotes = if quoted.starts_with("\"\"\"") || quoted.starts_with("'''") { 3 } else { 1 };
    let escapes = quoted.starts_with('"');
    let (mut at, mut read) = (quotes, 0);
    while read < offset {
        let rest = &quoted[at..];
        let Some(sign) = rest.chars().next() else { break };
        let hexadecimals = match rest.get(1..2) {
            _ if !escapes || sign != '\\' => None,
            Some("x") => Some(2),
            Some("u") => Some(4),
            Some("U") => Some(8),
            _ => Some(0),
        };
        let Some(digits) = hexadecimals else {
            at += sign.len_utf8();
            read += sign.len_utf8();
            continue;
        };
        let code = rest.get(2..2 + digits).and_then(|code| u32::from_str_radix(code, 16).ok()).and_then(char::from_u32);
        at += 2 + digits;
        read += code.map_or(1, char::len_utf8);
    }
    span.start + at
}
