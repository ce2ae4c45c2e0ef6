//! The table of a standard: every element that the standard has, with the way in which it is supported.
//!
//! Files are checked against the table before they are read. So an element is read, or has no effect and is reported, or ends
//! the program; and the pages of what is supported are written from the same table.

use super::element::Element;
use super::error::{Flaw, ReadError};
use paracosm_space::nearest;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

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
    /// The elements that can contain these elements, with `|` between them. `*` stands for all elements.
    pub parents: &'static str,
    /// The names of the elements, with `|` between them.
    pub names: &'static str,
    /// The names of the attributes of the element, with spaces between them.
    pub attributes: &'static str,
    pub support: Support,
    /// `true` if a parent can contain several of these elements.
    pub repeats: bool,
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
}

/// The numbers of elements that a parent can contain.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Counts {
    /// The elements with these names occur at most once within their parent, all others any number of times.
    Once(&'static [&'static str]),
    /// Elements occur at most once within their parent, unless their row says that they [repeat](Row::several). Of the elements of a
    /// choice, a parent has one in all.
    OnceExcept(&'static [Choice]),
}

/// Elements that contain one of several elements.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Choice {
    /// The names of the elements, with `|` between them.
    pub parents: &'static str,
    /// The names of the elements within that do not belong to the choice, with `|` between them.
    pub beside: &'static str,
}

impl Row {
    /// Returns the same row of elements of which a parent can contain several.
    pub const fn several(self) -> Self {
        Self { repeats: true, ..self }
    }

    /// Returns each element of the row within each of its parents.
    pub fn each(&self) -> impl Iterator<Item = Supported> + use<'_> {
        let Self { names, support, .. } = *self;
        let within = move |parent| names.split('|').map(move |name| Supported { parent, name, support });
        self.parents.split('|').flat_map(within)
    }
}

/// Describes an element that is read.
pub(crate) const fn read(parents: &'static str, names: &'static str, attributes: &'static str) -> Row {
    Row { parents, names, attributes, support: Support::Read, repeats: false }
}

/// Describes an element that has no effect.
pub(crate) const fn no_effect(parents: &'static str, names: &'static str, reason: &'static str) -> Row {
    Row { parents, names, attributes: "", support: Support::NoEffect(reason), repeats: false }
}

/// Describes an element that is refused.
pub(crate) const fn refused(parents: &'static str, names: &'static str, reason: &'static str) -> Row {
    Row { parents, names, attributes: "", support: Support::Refused(reason), repeats: false }
}

/// The elements of a standard by their parents.
#[derive(Debug)]
pub(crate) struct Schema {
    counts: Counts,
    children: BTreeMap<&'static str, BTreeMap<&'static str, &'static Row>>,
}

/// The part of a file that has no effect.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoEffect {
    /// The name of the element, or of the attribute as `element.attribute`.
    pub name: String,
    /// The reason.
    pub reason: &'static str,
    /// The number of times that the file has it.
    pub count: usize,
    /// The line of the first, from 1.
    pub line: u32,
}

impl NoEffect {
    /// Describes the part with the path of its file and its line.
    pub fn in_file(&self, file: &Path) -> String {
        format!("{}:{}: {self}", file.display(), self.line)
    }
}

impl fmt::Display for NoEffect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, reason, count, .. } = self;
        let times = if *count == 1 { String::new() } else { format!(" ({count} times)") };
        write!(f, "`{name}`{times} has no effect: {reason}")
    }
}

/// The element that stands for all parents.
const ANYWHERE: &str = "*";
const NOT_IN_STANDARD: &str = "the standard does not have this attribute";

impl Schema {
    /// Makes the table of a standard.
    pub fn new(rows: &'static [Row], counts: Counts) -> Self {
        let mut children: BTreeMap<_, BTreeMap<_, _>> = BTreeMap::new();
        for row in rows {
            for parent in row.parents.split('|') {
                for name in row.names.split('|') {
                    children.entry(parent).or_default().insert(name, row);
                }
            }
        }
        Self { counts, children }
    }

    /// Checks an element and all that it contains. Returns the parts that have no effect.
    pub fn check(&self, root: Element<'_, '_>) -> Result<Vec<NoEffect>, ReadError> {
        let mut found = BTreeMap::new();
        // A stack of our own: a file may nest elements deeply.
        let mut open = vec![root];
        while let Some(parent) = open.pop() {
            let mut seen = Seen::default();
            for element in parent.elements() {
                let row = self.row(parent, element)?;
                self.count(parent, element, row, &mut seen)?;
                match row.support {
                    Support::Read => {
                        self.check_attributes(row, element, &mut found);
                        open.push(element);
                    }
                    Support::NoEffect(_) if element.is_empty() => (),
                    Support::NoEffect(reason) => note(&mut found, element.name().to_owned(), reason, element),
                    Support::Refused(reason) => {
                        return Err(element.error(Flaw::Refused { element: element.name().to_owned(), reason }));
                    }
                }
            }
        }
        let mut found: Vec<_> = found.into_values().collect();
        found.sort_by_key(|note| note.line);
        Ok(found)
    }

    /// Counts an element within its parent.
    fn count<'a>(
        &self,
        parent: Element<'a, '_>,
        element: Element<'a, '_>,
        row: &Row,
        seen: &mut Seen<'a>,
    ) -> Result<(), ReadError> {
        let name = element.name();
        let (is_single, choice) = match self.counts {
            Counts::Once(names) => (names.contains(&name), None),
            Counts::OnceExcept(choices) => (!row.repeats, choices.iter().find(|choice| choice.is_of(parent, name))),
        };
        let [element_name, parent_name] = [element, parent].map(|of| of.name().to_owned());
        if (is_single || choice.is_some()) && seen.names.contains(&name) {
            return Err(element.error(Flaw::Repeated { element: element_name, parent: parent_name }));
        }
        if let Some(first) = seen.chosen.filter(|_| choice.is_some()) {
            let first = first.to_owned();
            return Err(element.error(Flaw::Chosen { element: element_name, parent: parent_name, first }));
        }
        // Elements that repeat may be very many.
        if is_single || choice.is_some() {
            seen.names.push(name);
        }
        seen.chosen = seen.chosen.or(choice.map(|_| name));
        Ok(())
    }

    /// Notes the attributes of an element that have no effect. In the table, their names begin with `@`.
    fn check_attributes(&self, row: &Row, element: Element<'_, '_>, found: &mut BTreeMap<String, NoEffect>) {
        let known: Vec<&str> = row.attributes.split(' ').collect();
        for attribute in element.attributes().filter(|attribute| !known.contains(attribute)) {
            let row = self.children.get(element.name()).and_then(|rows| rows.get(format!("@{attribute}").as_str()));
            let reason = match row.map(|row| row.support) {
                Some(Support::NoEffect(reason)) => reason,
                _ => NOT_IN_STANDARD,
            };
            note(found, format!("{}.{attribute}", element.name()), reason, element);
        }
    }

    fn row(&self, parent: Element<'_, '_>, element: Element<'_, '_>) -> Result<&'static Row, ReadError> {
        let of = |name: &str| self.children.get(name);
        let found = [parent.name(), ANYWHERE].into_iter().find_map(|name| of(name)?.get(element.name()).copied());
        found.ok_or_else(|| {
            let names = of(parent.name()).into_iter().flat_map(|rows| rows.keys().copied());
            element.error(Flaw::UnknownElement {
                element: element.name().to_owned(),
                parent: parent.name().to_owned(),
                nearest: nearest(element.name(), names),
            })
        })
    }
}

/// The elements of a parent that have been counted.
#[derive(Default)]
struct Seen<'a> {
    /// The names of the elements that must not occur again.
    names: Vec<&'a str>,
    /// The element of the choice.
    chosen: Option<&'a str>,
}

impl Choice {
    /// Returns `true` if an element with a name is one of the choice within its parent.
    fn is_of(&self, parent: Element<'_, '_>, name: &str) -> bool {
        self.parents.split('|').any(|of| of == parent.name()) && !self.beside.split('|').any(|beside| beside == name)
    }
}

fn note(found: &mut BTreeMap<String, NoEffect>, name: String, reason: &'static str, element: Element<'_, '_>) {
    let line = element.line();
    let key = name.clone();
    let note = found.entry(key).or_insert(NoEffect { name, reason, count: 0, line });
    note.count += 1;
    note.line = note.line.min(line);
}
