//! Writes XML: elements with attributes, indented.

use std::fmt::{Display, Write};

/// The text of an XML file that is being written.
#[derive(Debug)]
pub(crate) struct Writer {
    text: String,
    depth: usize,
}

/// Attributes in their order. Numbers are written with all digits that reading them again needs.
pub(crate) type Attributes<'a> = &'a [(&'a str, &'a dyn Display)];

impl Writer {
    pub fn new() -> Self {
        Self { text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned(), depth: 0 }
    }

    /// Writes an element with the elements that `within` writes.
    pub fn within(&mut self, name: &str, attributes: Attributes<'_>, within: impl FnOnce(&mut Self)) {
        self.begin(name, attributes);
        self.text.push_str(">\n");
        self.depth += 1;
        within(self);
        self.depth -= 1;
        self.indent();
        self.text.push_str("</");
        self.text.push_str(name);
        self.text.push_str(">\n");
    }

    /// Writes an element without elements.
    pub fn empty(&mut self, name: &str, attributes: Attributes<'_>) {
        self.begin(name, attributes);
        self.text.push_str("/>\n");
    }

    pub fn finish(self) -> String {
        self.text
    }

    fn begin(&mut self, name: &str, attributes: Attributes<'_>) {
        self.indent();
        self.text.push('<');
        self.text.push_str(name);
        for (name, value) in attributes {
            let value = value.to_string();
            write!(self.text, " {name}=\"").expect("a text takes any text");
            self.text.push_str(&escaped(&value));
            self.text.push('"');
        }
    }

    fn indent(&mut self) {
        self.text.extend(std::iter::repeat_n("  ", self.depth));
    }
}

/// Returns a text as it stands in an attribute with double quotes. Control characters become spaces.
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '"' => escaped.push_str("&quot;"),
            character if character.is_control() => escaped.push(' '),
            character => escaped.push(character),
        }
    }
    escaped
}
