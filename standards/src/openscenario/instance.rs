//! A file that is a scenario with the values of one test: the values, and the proof that nothing else differs.
//!
//! Suites of tests are folders of such files. Only the values of a file are run, in the scenario, so a file that differs in anything
//! else would be another test than the one that is run.

use super::demand::Breach;
use super::local::declarations;
use super::parameters::Declaration;
use super::program::{ROOT, Xosc};
use super::scope::{Node, Scope};
use crate::xml::{Document, Element, Flaw, ReadError};
use paracosm_space::Value;
use std::fs;
use std::path::Path;

/// The element that says who wrote a file, which does not matter.
const HEADER: &str = "FileHeader";
const DECLARATION: &str = "ParameterDeclaration";
/// The attributes that are paths of files and folders.
const PATHS: [(&str, &str); 3] = [("LogicFile", "filepath"), ("SceneGraphFile", "filepath"), ("Directory", "path")];

impl Xosc {
    /// Reads a file that is this scenario with other values of its parameters. Returns the values of the parameters of tests, each with
    /// its name and its line.
    ///
    /// # Errors
    /// The file cannot be read, differs from the scenario in something else than these values, or has a value that is not of the
    /// type of its parameter.
    pub fn test_in(&self, file: &Path) -> Result<Vec<(String, Value, u32)>, ReadError> {
        let document = Document::open(file)?;
        let (own, other) = (self.document.root(ROOT)?, document.root(ROOT)?);
        compare(own, other)?;
        let declared: Vec<Element<'_, '_>> = declarations(other).collect();
        let texts: Vec<&str> = declared.iter().map(|element| element.text("value").unwrap_or_default()).collect();
        let mut scope = Scope::default();
        for ((element, own), declaration) in declared.iter().zip(declarations(own)).zip(self.parameters.declarations())
        {
            let value = if self.parameters.is_given(declaration) {
                given(*element, declaration)?
            } else {
                following(*element, Node { element: own, scope: &scope })?
            };
            scope.set(&declaration.demand.name, declaration.demand.kind, &value);
        }
        let stated = self.parameters.stated(&texts);
        Ok(stated.into_iter().map(|(name, value, at)| (name, value, declared[at].line())).collect())
    }
}

/// Returns the value in a declaration that gives a parameter of tests its value.
fn given(element: Element<'_, '_>, declaration: &Declaration) -> Result<String, ReadError> {
    let text = element.text("value").unwrap_or_default();
    let kind = declaration.demand.kind;
    if text.starts_with('$') || !kind.takes(text) {
        return Err(Breach::of(kind).error(Node { element, scope: &Scope::default() }, text));
    }
    Ok(text.to_owned())
}

/// Returns the value in a declaration whose value follows from the parameters before. The text is that of the scenario, or the value.
fn following(element: Element<'_, '_>, own: Node<'_>) -> Result<String, ReadError> {
    let text = element.text("value").unwrap_or_default();
    let value = own.text("value")?.unwrap_or_default().into_owned();
    if own.element.text("value") == Some(text) || is_alike(text, &value) {
        return Ok(value);
    }
    let expected = attribute(own.element, "value", Some(&value));
    Err(differs(element, attribute(element, "value", Some(text)), own.element, expected))
}

/// Checks that the elements of two files differ only in their headers and in the values of the parameters that the files declare.
fn compare<'a>(own: Element<'a, 'a>, other: Element<'a, 'a>) -> Result<(), ReadError> {
    // A stack of our own: a file may nest elements deeply.
    let mut open = vec![Ok((own, other, 0))];
    while let Some(next) = open.pop() {
        let (own, other, depth) = next?;
        // A declaration at this depth is one of the whole scenario.
        let varies = if depth == 2 && own.name() == DECLARATION { Some("value") } else { None };
        let names = own.attributes().chain(other.attributes()).filter(|name| Some(*name) != varies);
        names.into_iter().try_for_each(|name| compare_attribute(own, other, name))?;
        if own.content() != other.content() {
            let text = |element: Element<'_, '_>| format!("the text `{}` in <{}>", element.content(), element.name());
            return Err(differs(other, text(other), own, text(own)));
        }
        let matters = |element: &Element<'_, '_>| depth > 0 || element.name() != HEADER;
        let (mut owns, mut others) = (own.elements().filter(matters), other.elements().filter(matters));
        let before = open.len();
        loop {
            match (owns.next(), others.next()) {
                (None, None) => break,
                (Some(one), Some(two)) if one.name() == two.name() => open.push(Ok((one, two, depth + 1))),
                (one, two) => {
                    let named = |element: Option<Element<'_, '_>>| match element {
                        Some(element) => format!("<{}>", element.name()),
                        None => format!("the end of <{}>", own.name()),
                    };
                    // The elements before may differ, too.
                    open.push(Err(differs(two.unwrap_or(other), named(two), one.unwrap_or(own), named(one))));
                    break;
                }
            }
        }
        // The first difference in the order of the file is reported.
        open[before..].reverse();
    }
    Ok(())
}

fn compare_attribute(own: Element<'_, '_>, other: Element<'_, '_>, name: &str) -> Result<(), ReadError> {
    let (one, two) = (own.text(name), other.text(name));
    let is_path = PATHS.contains(&(own.name(), name));
    let is_same = match (one, two) {
        (Some(one), Some(two)) if is_path && !one.starts_with('$') => leads_alike((own, one), (other, two)),
        (Some(one), Some(two)) => is_alike(one, two),
        (one, two) => one == two,
    };
    if is_same {
        return Ok(());
    }
    let of = if one == two { ", with other contents" } else { "" };
    Err(differs(other, format!("{}{of}", attribute(other, name, two)), own, attribute(own, name, one)))
}

/// Returns `true` if two values are the same text or the same number.
fn is_alike(one: &str, two: &str) -> bool {
    let number = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite());
    one == two || number(one).is_some_and(|one| number(two) == Some(one))
}

/// Returns `true` if two paths lead to the same place. A file may have been copied without the files that it names, or with them.
fn leads_alike((own, one): (Element<'_, '_>, &str), (other, two): (Element<'_, '_>, &str)) -> bool {
    let path = |element: Element<'_, '_>, text: &str| element.file().parent().unwrap_or(Path::new("")).join(text);
    let (own, other) = (path(own, one), path(other, two));
    if let (Ok(own), Ok(other)) = (own.canonicalize(), other.canonicalize())
        && own == other
    {
        return true;
    }
    one == two && (!other.exists() || has_same_contents(&own, &other))
}

/// Returns `true` if two files, or the files of two folders, have the same contents.
fn has_same_contents(own: &Path, other: &Path) -> bool {
    let Ok(entries) = fs::read_dir(own) else { return fs::read(own).ok() == fs::read(other).ok() };
    let files = entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file());
    files.filter_map(|file| Some(other.join(file.file_name()?)).map(|copy| (file, copy))).all(|(file, copy)| {
        let contents = fs::read(file).ok();
        contents.is_some() && contents == fs::read(copy).ok()
    })
}

/// Describes an attribute of an element.
fn attribute(element: Element<'_, '_>, name: &str, value: Option<&str>) -> String {
    match value {
        Some(value) => format!("`{name}=\"{value}\"` of <{}>", element.name()),
        None => format!("no attribute `{name}` of <{}>", element.name()),
    }
}

/// Makes the error that a file differs from its scenario.
fn differs(at: Element<'_, '_>, found: String, own: Element<'_, '_>, expected: String) -> ReadError {
    at.error(Flaw::Differs { found, expected, scenario: own.file().to_owned(), line: own.line() })
}
