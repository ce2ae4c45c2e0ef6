//! The table of a standard: every element that the standard has, with the way in which it is supported.
//!
//! Files are checked against the table before they are read. So an element is read, or has no effect and is reported, or ends
//! the program; and the pages of what is supported are written from the same table.

use super::element::Element;
use super::error::{Flaw, ReadError};
use super::row::{Row, Support};
use paracosm_space::{did_you_mean, nearest};
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

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

/// The elements of a standard by their parents.
#[derive(Debug)]
pub(crate) struct Schema {
    counts: Counts,
    children: BTreeMap<&'static str, BTreeMap<&'static str, &'static Row>>,
    /// The elements that an element must contain.
    needed: BTreeMap<&'static str, Vec<&'static str>>,
}

/// The part of a file that has no effect.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoEffect {
    /// The name of the element, or of the attribute as `element.attribute`.
    pub name: String,
    /// The reason.
    pub reason: &'static str,
    /// The name in the standard that is most similar to a name that the standard does not have; `None` if no name is similar.
    pub nearest: Option<&'static str>,
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
        let Self { name, reason, nearest, count, .. } = self;
        let times = if *count == 1 { String::new() } else { format!(" ({count} times)") };
        write!(f, "`{name}`{times} has no effect: {reason}{}", did_you_mean(nearest))
    }
}

/// The element that stands for all parents.
const ANYWHERE: &str = "*";
const NOT_IN_STANDARD: &str = "the standard does not have this attribute";

impl Schema {
    /// Makes the table of a standard.
    pub fn new(rows: &'static [Row], counts: Counts) -> Self {
        let (mut children, mut needed): (BTreeMap<_, BTreeMap<_, _>>, BTreeMap<_, Vec<_>>) = Default::default();
        for row in rows {
            for (parent, is_needed) in row.parents() {
                for name in row.names.split('|') {
                    children.entry(parent).or_default().insert(name, row);
                    if is_needed {
                        needed.entry(parent).or_default().push(name);
                    }
                }
            }
        }
        Self { counts, children, needed }
    }

    /// Checks an element and all that it contains. Returns the parts that have no effect. An element that is not supported is reported
    /// before an element that lacks something.
    pub fn check(&self, root: Element<'_, '_>) -> Result<Vec<NoEffect>, ReadError> {
        let mut found = BTreeMap::new();
        let mut lacks = None;
        // A stack of our own: a file may nest elements deeply.
        let mut open = vec![root];
        while let Some(parent) = open.pop() {
            if let Some((line, text)) = parent.stray_text() {
                return Err(parent.error_at(line, Flaw::Text { element: parent.name().to_owned(), text }));
            }
            let mut seen = Seen::default();
            let first = open.len();
            for element in parent.elements() {
                if !element.is_of_namespace(root) {
                    let (element_name, parent) = (element.full_name(), parent.name().to_owned());
                    return Err(element.error(Flaw::UnknownElement { element: element_name, parent, nearest: None }));
                }
                let row = self.row(parent, element)?;
                self.count(parent, element, row, &mut seen)?;
                match row.support {
                    Support::Read => {
                        self.check_attributes(row, element, &mut found)?;
                        lacks = lacks.or_else(|| self.lacks(row, element));
                        open.push(element);
                    }
                    Support::NoEffect(_) if element.is_empty() => (),
                    Support::NoEffect(reason) => note(&mut found, element.name().to_owned(), (reason, None), element),
                    Support::Refused(reason) => {
                        return Err(element.error(Flaw::Refused { element: element.name().to_owned(), reason }));
                    }
                }
            }
            // The first of the elements is checked next.
            open[first..].reverse();
        }
        if let Some(error) = lacks {
            return Err(error);
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

    /// Checks the attributes of an element, and notes the attributes that have no effect.
    fn check_attributes(
        &self,
        row: &Row,
        element: Element<'_, '_>,
        found: &mut BTreeMap<String, NoEffect>,
    ) -> Result<(), ReadError> {
        for attribute in element.attributes() {
            let why = match self.attribute_row(element, attribute) {
                Some(row) if !row.form.check(element, attribute, row.usual)? => continue,
                Some(Row { support: Support::NoEffect(reason), .. }) => (*reason, None),
                Some(Row { support: Support::Refused(reason), usual, .. }) => {
                    return Err(element.unexpected(attribute, format!("{usual}: {reason}")));
                }
                _ if row.knows(attribute) => continue,
                _ => (NOT_IN_STANDARD, nearest(attribute, row.attributes().map(|(name, _)| name))),
            };
            note(found, format!("{}.{attribute}", element.name()), why, element);
        }
        Ok(())
    }

    /// Makes the error that an element lacks an attribute or an element that it must have.
    fn lacks(&self, row: &Row, element: Element<'_, '_>) -> Option<ReadError> {
        let mut needed = row.attributes().filter(|(_, is_needed)| *is_needed);
        if let Some((attribute, _)) = needed.find(|(name, _)| !element.has(name)) {
            let is_strange = |name: &&str| !row.knows(name) && self.attribute_row(element, name).is_none();
            let similar = nearest(attribute, element.attributes().filter(is_strange)).map(str::to_owned);
            let name = element.name().to_owned();
            return Some(element.error(Flaw::MissingAttribute { element: name, attribute, similar }));
        }
        let mut needed = self.needed.get(element.name()).into_iter().flatten();
        needed.find(|name| element.first(name).is_none()).map(|absent| element.lacks(absent))
    }

    /// Returns the row of an attribute that has no effect, or that is refused.
    fn attribute_row(&self, element: Element<'_, '_>, attribute: &str) -> Option<&'static Row> {
        self.children.get(element.name())?.get(format!("@{attribute}").as_str()).copied()
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

/// Adds an element to the parts that have no effect: the first of its name, or one more.
pub(crate) fn note(
    found: &mut BTreeMap<String, NoEffect>,
    name: String,
    (reason, nearest): (&'static str, Option<&'static str>),
    element: Element<'_, '_>,
) {
    let line = element.line();
    let key = name.clone();
    let note = found.entry(key).or_insert(NoEffect { name, reason, nearest, count: 0, line });
    note.count += 1;
    note.line = note.line.min(line);
}
