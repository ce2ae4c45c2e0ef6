//! Reads TOML files of users, with errors that name lines and suggest the nearest keys.

use crate::files::read_text;
use crate::{Error, Reason};
use paracosm_space::{did_you_mean, nearest};
use serde::de::DeserializeOwned;
use std::path::Path;
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text of a file, and its path.
pub(super) struct TomlFile<'p> {
    path: &'p Path,
    text: String,
}

/// The keys that tables may have. A name means the table with this name below the root; `NAME.*` means all tables below
/// that table; the empty name means the root.
pub(super) type Keys<'k> = [(&'k str, &'k [&'static str])];

/// The error in a TOML file.
#[derive(Debug, Error)]
pub enum TomlFlaw {
    /// A table contains an unknown key.
    #[error("unknown field `{key}`, expected one of {}{}", quoted(.expected), did_you_mean(.nearest))]
    Key {
        /// The unknown key.
        key: String,
        /// The keys that the table can have.
        expected: Vec<&'static str>,
        /// The most similar key that the table can have; `None` if no key is similar.
        nearest: Option<&'static str>,
    },
    /// The file is not TOML, or a value has the wrong type.
    #[error("{}", .0.message())]
    Syntax(toml::de::Error),
}

impl Reason for TomlFlaw {}

fn quoted(keys: &[&str]) -> String {
    keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ")
}

impl<'p> TomlFile<'p> {
    pub fn read(path: &'p Path) -> Result<Self, Error> {
        Ok(Self { path, text: read_text(path)? })
    }

    pub fn path(&self) -> &Path {
        self.path
    }

    /// Parses the text of the file as a value of type `T`.
    ///
    /// # Errors
    /// The contents are not TOML or have another form. An unknown key is reported first.
    pub fn parse<T: DeserializeOwned>(&self, keys: &Keys<'_>) -> Result<T, Error> {
        toml::from_str(&self.text).map_err(|error| match self.unknown_key(keys) {
            Some((offset, flaw)) => self.at(offset, flaw),
            None => {
                let line = error.span().map(|span| self.line(span.start));
                Error::in_file(self.path, line, TomlFlaw::Syntax(error))
            }
        })
    }

    /// Makes an error in the line that contains the byte at `offset`.
    pub fn at(&self, offset: usize, flaw: impl Reason) -> Error {
        Error::in_file(self.path, self.line(offset), flaw)
    }

    /// Returns the line, from 1, of a byte.
    fn line(&self, offset: usize) -> usize {
        self.text[..offset.min(self.text.len())].matches('\n').count() + 1
    }

    fn unknown_key(&self, keys: &Keys<'_>) -> Option<(usize, TomlFlaw)> {
        let document = DeTable::parse(&self.text).ok()?;
        let root = document.get_ref();
        keys.iter().find_map(|(place, expected)| {
            let name = place.strip_suffix(".*");
            let found = || root.get(name.unwrap_or(place));
            match (place.is_empty(), name) {
                (true, _) => unknown_in(root, expected),
                (false, None) => tables(found()?).find_map(|table| unknown_in(table, expected)),
                (false, Some(_)) => {
                    let mut below = tables(found()?).flat_map(|table| table.values().flat_map(tables));
                    below.find_map(|table| unknown_in(table, expected))
                }
            }
        })
    }
}

/// Returns a table, or the tables of an array.
fn tables<'d>(value: &'d Spanned<DeValue<'d>>) -> impl Iterator<Item = &'d DeTable<'d>> {
    let array = match value.get_ref() {
        DeValue::Array(array) => array.iter().filter_map(|entry| entry.get_ref().as_table()).collect(),
        value => value.as_table().into_iter().collect::<Vec<_>>(),
    };
    array.into_iter()
}

fn unknown_in(table: &DeTable<'_>, expected: &[&'static str]) -> Option<(usize, TomlFlaw)> {
    let key = table.keys().find(|key| !expected.contains(&key.get_ref().as_ref()))?;
    let (start, key) = (key.span().start, key.get_ref().to_string());
    let nearest = nearest(&key, expected.iter().copied());
    Some((start, TomlFlaw::Key { key, expected: expected.to_vec(), nearest }))
}
