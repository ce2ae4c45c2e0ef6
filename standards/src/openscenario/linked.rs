//! The files and folders that a scenario names: their paths, and the reasons why they are refused.
//!
//! Suites of scenarios keep roads and catalogs in folders beside those of the scenarios. So a path may lead up from the folder of
//! the scenario, but not to the root of the file system; and an absolute path has to lie within the folder.

use super::scope::Node;
use crate::xml::ReadError;
use std::path::{Component, Path, PathBuf};

/// Returns the path of the file that an attribute names. `folder` is the folder of the scenario.
pub(super) fn file(node: Node<'_>, attribute: &'static str, folder: &Path) -> Result<PathBuf, ReadError> {
    let text = node.required(attribute)?;
    let path = within(node, attribute, folder)?;
    if path.is_file() {
        return Ok(path);
    }
    if path.is_dir() {
        return Err(node.unexpected(
            attribute,
            &text,
            format!("a file that exists, and {} is a folder", path.display()),
        ));
    }
    // The parent of a plain name is an empty path.
    let beside = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(beside).into_iter().flatten().flatten();
    let mut others: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|entry| entry.is_file()).collect();
    // A file of the same kind is meant, unless the mistake is in the ending.
    if others.iter().any(|other| other.extension() == path.extension()) {
        others.retain(|other| other.extension() == path.extension());
    }
    let start = text.rfind('/').map_or("", |at| &text[..=at]);
    let named = |other: &PathBuf| Some(format!("{start}{}", other.file_name()?.to_str()?));
    let mut names: Vec<String> = others.iter().filter_map(named).collect();
    names.sort();
    let expected = format!("a file that exists, and there is no {}", path.display());
    Err(node.element.unexpected_value(attribute, &text, expected, names.iter().map(String::as_str)))
}

/// Returns the path that an attribute names.
pub(super) fn within(node: Node<'_>, attribute: &'static str, folder: &Path) -> Result<PathBuf, ReadError> {
    let text = node.required(attribute)?;
    let path: PathBuf = folder.join(text.as_ref()).components().collect();
    let [whole, base] = [path.as_path(), folder].map(resolved);
    let is_near = if Path::new(text.as_ref()).is_absolute() {
        whole.starts_with(&base)
    } else {
        whole.starts_with(&base) || common(&whole, &base) > 1
    };
    if is_near {
        return Ok(path);
    }
    let expected =
        "a path in the folder of the scenario, or a relative path that does not lead up to the root of the file system";
    Err(node.unexpected(attribute, &text, expected))
}

/// Returns the absolute path without links and without steps up.
fn resolved(path: &Path) -> PathBuf {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    if let Ok(real) = path.canonicalize() {
        return real;
    }
    let mut plain = PathBuf::new();
    for part in std::path::absolute(path).unwrap_or_else(|_| path.to_owned()).components() {
        if part == Component::ParentDir {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}

/// Returns the number of parts at the beginning that two paths share.
fn common(one: &Path, other: &Path) -> usize {
    one.components().zip(other.components()).take_while(|(a, b)| a == b).count()
}
