//! The rows of the table of a standard: elements with their attributes, and how they are supported.

use super::element::{Element, TRUTHS};
use super::error::ReadError;
use std::fmt;

/// The way in which an element of a standard is supported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// The element is read.
    Read,
    /// The element and all that it contains have no effect, for the given reason. A note reports it.
    NoEffect(&'static str),
    /// A file with the element is refused, for the given reason.
    Refused(&'static str),
}

/// Elements of a standard with the same attributes and the same support.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// The elements that can contain these elements, with `|` between them. `*` stands for all elements. A `!` after a name says that
    /// the element must contain one of each of these elements.
    pub parents: &'static str,
    /// The names of the elements, with `|` between them. A name that begins with `@` is that of an attribute of the parents.
    pub names: &'static str,
    /// The names of the attributes of the element, with spaces between them. A `!` after a name says that the element must have the
    /// attribute.
    pub attributes: &'static str,
    /// The values of an attribute without effect or of a refused attribute.
    pub form: Form,
    /// The value of an attribute without effect that means the same as no attribute, or the only value with which a refused attribute is
    /// read; empty if there is none.
    pub usual: &'static str,
    pub support: Support,
    /// `true` if a parent can contain several of these elements.
    pub repeats: bool,
}

/// The values of an attribute that has no effect or that is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    Any,
    /// A whole number that is not negative.
    Count,
    Number,
    Truth,
    /// One of several names, with `|` between them.
    OneOf(&'static str),
}

/// An element of a standard within another element, and how it is supported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Supported {
    /// The name of the containing element; `*` if any element can contain it.
    pub parent: &'static str,
    /// The name of the element.
    pub name: &'static str,
    /// The way in which the element is supported.
    pub support: Support,
    /// The only value with which a refused attribute is read; empty for everything else.
    pub except: &'static str,
}

impl Supported {
    /// Returns the name of the support, and the reason for it.
    pub fn support(&self) -> (&'static str, Option<&'static str>) {
        match self.support {
            Support::Read => ("read", None),
            Support::NoEffect(reason) => ("no effect", Some(reason)),
            Support::Refused(reason) => ("refused", Some(reason)),
        }
    }
}

impl fmt::Display for Supported {
    /// Writes how the element is supported, such as "refused: the world is flat".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (support, reason) = self.support();
        let except = if self.except.is_empty() { String::new() } else { format!(" except `{}`", self.except) };
        let reason = reason.map_or_else(String::new, |reason| format!(": {reason}"));
        write!(f, "{support}{except}{reason}")
    }
}

impl Row {
    /// Returns the same row of elements of which a parent can contain several.
    pub const fn several(self) -> Self {
        Self { repeats: true, ..self }
    }

    /// Returns the same row of attributes with values of a form, of which one means the same as no attribute.
    pub const fn valued(self, form: Form, usual: &'static str) -> Self {
        Self { form, usual, ..self }
    }

    /// Returns the names of the parents, each with `true` if it must contain the element.
    pub fn parents(&self) -> impl Iterator<Item = (&'static str, bool)> + use<> {
        self.parents.split('|').map(marked)
    }

    /// Returns `true` if the element can have an attribute.
    pub fn knows(&self, attribute: &str) -> bool {
        self.attributes().any(|(name, _)| name == attribute)
    }

    /// Returns the names of the attributes, each with `true` if the element must have it.
    pub fn attributes(&self) -> impl Iterator<Item = (&'static str, bool)> + use<> {
        self.attributes.split_whitespace().map(marked)
    }

    /// Returns each element of the row within each of its parents.
    pub fn each(&self) -> impl Iterator<Item = Supported> + use<'_> {
        let Self { names, support, .. } = *self;
        let except = if matches!(support, Support::Refused(_)) { self.usual } else { "" };
        let within = move |parent| names.split('|').map(move |name| Supported { parent, name, support, except });
        self.parents().map(|(parent, _)| parent).flat_map(within)
    }
}

/// Returns a name, and `true` if it has the mark of something that must be there.
fn marked(name: &'static str) -> (&'static str, bool) {
    name.strip_suffix('!').map_or((name, false), |name| (name, true))
}

const fn row(parents: &'static str, names: &'static str, support: Support) -> Row {
    Row { parents, names, attributes: "", form: Form::Any, usual: "", support, repeats: false }
}

/// Describes an element that is read.
pub(crate) const fn read(parents: &'static str, names: &'static str, attributes: &'static str) -> Row {
    Row { attributes, ..row(parents, names, Support::Read) }
}

/// Describes an element that has no effect.
pub(crate) const fn no_effect(parents: &'static str, names: &'static str, reason: &'static str) -> Row {
    row(parents, names, Support::NoEffect(reason))
}

/// Describes an element that is refused.
pub(crate) const fn refused(parents: &'static str, names: &'static str, reason: &'static str) -> Row {
    row(parents, names, Support::Refused(reason))
}

impl Form {
    /// Checks the value of an attribute. Returns `false` if the value means the same as no attribute. The value of an expression is
    /// unknown here.
    pub(super) fn check(self, element: Element<'_, '_>, attribute: &str, usual: &str) -> Result<bool, ReadError> {
        let Some(text) = element.text(attribute) else { return Ok(false) };
        if text.starts_with('$') {
            return Ok(true);
        }
        match self {
            Self::Any => Ok(text != usual),
            Self::Count => {
                let count: Option<u32> = text.parse().ok();
                count.ok_or_else(|| element.unexpected(attribute, "a whole number that is not negative"))?;
                Ok(text != usual)
            }
            Self::Number => {
                let number = text.parse().ok().filter(|number: &f64| number.is_finite());
                let number = number.ok_or_else(|| element.unexpected(attribute, "a finite number"))?;
                Ok(usual.parse() != Ok(number))
            }
            Self::Truth => Ok(element.chosen(attribute, text, &TRUTHS)? != (usual == "true")),
            Self::OneOf(names) => {
                let names: Vec<_> = names.split('|').map(|name| (name, name)).collect();
                Ok(element.chosen(attribute, text, &names)? != usual)
            }
        }
    }
}
