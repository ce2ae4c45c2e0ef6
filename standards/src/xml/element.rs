//! An element of an XML file, and the values of its attributes.

use super::error::{Flaw, ReadError};
use super::source::Source;
use paracosm_space::nearest;
use roxmltree::Node;
use std::ops::Range;
use std::path::Path;

/// An element with its place in a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Element<'a, 'i> {
    source: &'a Source,
    node: Node<'a, 'i>,
}

/// Elements are the same if they stand at the same place of the same file.
impl PartialEq for Element<'_, '_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.source, other.source) && self.range() == other.range()
    }
}

impl<'a, 'i> Element<'a, 'i> {
    pub(super) fn new(source: &'a Source, node: Node<'a, 'i>) -> Self {
        Self { source, node }
    }

    /// Returns the outermost element of the file.
    pub fn outermost(self) -> Self {
        Self { node: self.node.document().root_element(), ..self }
    }

    /// Returns the name of the element without its namespace.
    pub fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// Returns the name of the element after its namespace, such as `{urn:other}road`.
    pub fn full_name(&self) -> String {
        format!("{{{}}}{}", self.node.tag_name().namespace().unwrap_or_default(), self.name())
    }

    /// Returns `true` if the element has the namespace of another element.
    pub fn is_of_namespace(&self, other: Self) -> bool {
        self.node.tag_name().namespace() == other.node.tag_name().namespace()
    }

    /// Returns the number of the line at which the element begins, from 1.
    pub fn line(&self) -> u32 {
        self.source.line(self.node.range().start)
    }

    /// Returns the path of the file that has the element.
    pub fn file(&self) -> &'a Path {
        self.source.file()
    }

    /// Returns the text of the file.
    pub(super) fn file_text(&self) -> &'a str {
        self.source.text()
    }

    /// Returns the text of the element.
    pub(super) fn source(&self) -> &'a str {
        &self.file_text()[self.range()]
    }

    /// Returns the place of the element in the text of the file.
    pub(super) fn range(&self) -> Range<usize> {
        self.node.range()
    }

    /// Returns the place of the value of an attribute in the text of the file; `None` without the attribute.
    pub(super) fn value_range(&self, attribute: &str) -> Option<Range<usize>> {
        self.node.attribute_node(attribute).map(|attribute| attribute.range_value())
    }

    /// Makes an error at the place of the element.
    pub fn error(&self, flaw: Flaw) -> ReadError {
        ReadError { file: self.file().to_owned(), line: Some(self.line()), flaw: Box::new(flaw) }
    }

    /// Makes an error at a line of the file of the element.
    pub(super) fn error_at(&self, line: u32, flaw: Flaw) -> ReadError {
        ReadError { line: Some(line), ..self.error(flaw) }
    }

    /// Returns the elements of the parent, and this one among them.
    pub fn beside(self) -> impl Iterator<Item = Self> {
        self.node.parent().into_iter().flat_map(move |parent| Self { node: parent, ..self }.elements())
    }

    /// Returns all elements directly within this one, in the order of the file.
    pub fn elements(self) -> impl Iterator<Item = Self> {
        self.node.children().filter(Node::is_element).map(move |node| Self { node, ..self })
    }

    /// Returns the elements with a name directly within this one, in the order of the file.
    pub fn all(self, name: &'static str) -> impl Iterator<Item = Self> {
        self.elements().filter(move |element| element.name() == name)
    }

    /// Returns the first element with a name directly within this one.
    pub fn first(self, name: &'static str) -> Option<Self> {
        self.all(name).next()
    }

    /// Returns the first element with a name directly within this one, which must exist.
    pub fn child(self, name: &'static str) -> Result<Self, ReadError> {
        self.first(name).ok_or_else(|| self.lacks(name))
    }

    /// Makes the error that this element lacks a child.
    pub fn lacks(self, child: &'static str) -> ReadError {
        self.error(Flaw::MissingElement { element: self.name().to_owned(), child })
    }

    /// Returns `true` if the element has no attributes, no elements within and no text.
    pub fn is_empty(self) -> bool {
        let says = |node: Node<'_, '_>| node.is_element() || node.text().is_some_and(|text| !text.trim().is_empty());
        self.attributes().next().is_none() && !self.node.children().any(|node| !node.is_comment() && says(node))
    }

    /// Returns the text directly within the element.
    pub fn content(self) -> String {
        let texts = self.node.children().filter(Node::is_text).filter_map(|node| node.text());
        texts.map(str::trim).filter(|text| !text.is_empty()).collect::<Vec<_>>().join(" ")
    }

    /// Returns the first text directly within the element that is more than white space, with its line.
    pub(super) fn stray_text(self) -> Option<(u32, String)> {
        let texts = self.node.children().filter(Node::is_text);
        let says = |node: &Node<'_, '_>| node.text().is_some_and(|text| !text.trim().is_empty());
        let node = texts.into_iter().find(says)?;
        let text = node.text().unwrap_or_default();
        let before = text.len() - text.trim_start().len();
        Some((self.source.line(node.range().start + before), brief(text.trim())))
    }

    /// Returns `true` if the element has an attribute, which may be empty.
    pub fn has(self, attribute: &str) -> bool {
        self.node.has_attribute(attribute)
    }

    /// Returns the names of all attributes without namespaces; declarations of namespaces are no attributes.
    pub fn attributes(self) -> impl Iterator<Item = &'a str> {
        self.node.attributes().filter(|attribute| attribute.namespace().is_none()).map(|attribute| attribute.name())
    }

    /// Returns the value of an attribute; `None` if the attribute is absent or empty.
    pub fn text(self, attribute: &str) -> Option<&'a str> {
        self.node.attribute(attribute).map(str::trim).filter(|text| !text.is_empty())
    }

    /// Returns the value of an attribute, which must exist.
    pub fn required(self, attribute: &'static str) -> Result<&'a str, ReadError> {
        self.text(attribute).ok_or_else(|| self.missing(attribute))
    }

    /// Makes the error that an attribute is absent or empty.
    pub fn missing(self, attribute: &'static str) -> ReadError {
        match self.node.attribute(attribute) {
            Some(_) => self.unexpected(attribute, "a value"),
            None => self.error(Flaw::MissingAttribute { element: self.name().to_owned(), attribute, similar: None }),
        }
    }

    /// Makes the error that the value of an attribute is not allowed.
    pub fn unexpected(self, attribute: &str, expected: impl Into<String>) -> ReadError {
        self.unexpected_value(attribute, self.text(attribute).unwrap_or_default(), expected, [])
    }

    /// Makes the error that the value `found` of an attribute is not one of the given names.
    pub fn unexpected_value<'n>(
        self,
        attribute: &str,
        found: &str,
        expected: impl Into<String>,
        names: impl IntoIterator<Item = &'n str>,
    ) -> ReadError {
        let nearest = nearest(found, names).map(str::to_owned);
        let (element, attribute) = (self.name().to_owned(), attribute.to_owned());
        self.error(Flaw::Value { element, attribute, found: brief(found), expected: expected.into(), nearest })
    }

    /// Makes the error that an attribute names an element that does not exist. `names` are the existing names.
    pub fn dangling<'n>(
        self,
        attribute: &'static str,
        kind: &'static str,
        names: impl IntoIterator<Item = &'n str>,
    ) -> ReadError {
        self.dangling_value(attribute, self.text(attribute).unwrap_or_default(), kind, names)
    }

    /// Makes the error that the value `found` of an attribute names an element that does not exist.
    pub fn dangling_value<'n>(
        self,
        attribute: &'static str,
        found: &str,
        kind: &'static str,
        names: impl IntoIterator<Item = &'n str>,
    ) -> ReadError {
        let nearest = nearest(found, names).map(str::to_owned);
        self.error(Flaw::Dangling { element: self.name().to_owned(), attribute, found: brief(found), kind, nearest })
    }

    /// Returns the number in an attribute, which must exist and be finite.
    pub fn number(self, attribute: &'static str) -> Result<f64, ReadError> {
        let text = self.required(attribute)?;
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| self.unexpected(attribute, "a finite number"))
    }

    /// Returns the number in an attribute, which must exist and must not be negative.
    pub fn length(self, attribute: &'static str) -> Result<f64, ReadError> {
        let number = self.number(attribute)?;
        if number >= 0.0 { Ok(number) } else { Err(self.unexpected(attribute, "a number that is not negative")) }
    }

    /// Returns the whole number in an attribute, which must exist.
    pub fn whole(self, attribute: &'static str) -> Result<i32, ReadError> {
        self.required(attribute)?.parse().map_err(|_| self.unexpected(attribute, "a whole number"))
    }

    /// Returns the value in an attribute that has one of the given names.
    pub fn one_of<T: Copy>(self, attribute: &'static str, names: &[(&'static str, T)]) -> Result<T, ReadError> {
        self.chosen(attribute, self.required(attribute)?, names)
    }

    /// Returns the value that the text of an attribute names.
    pub fn chosen<T: Copy>(self, attribute: &str, text: &str, names: &[(&'static str, T)]) -> Result<T, ReadError> {
        names.iter().find(|(name, _)| *name == text).map(|(_, value)| *value).ok_or_else(|| {
            let all: Vec<_> = names.iter().map(|(name, _)| *name).collect();
            self.unexpected_value(attribute, text, format!("one of {}", all.join(", ")), all.iter().copied())
        })
    }
}

/// The names of truths in files.
pub(crate) const TRUTHS: [(&str, bool); 4] = [("true", true), ("false", false), ("1", true), ("0", false)];

/// The number of characters of a text of a file that messages show.
const MOST_SHOWN: usize = 80;

/// Returns the beginning of a text of a file for a message.
pub(crate) fn brief(text: &str) -> String {
    match text.char_indices().nth(MOST_SHOWN) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}
