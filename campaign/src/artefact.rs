//! Artefacts: results that are derived from the trials of a campaign and written beside them.

use crate::{Error, Folder};
use serde::Serialize;

/// A result of a campaign that is written to files in the campaign's folder.
pub trait Artefact {
    /// Returns the names of the artefact's files. No two artefacts share a file name.
    fn files(&self) -> Vec<&'static str>;

    /// Returns the contents of the artefact's file with the given name.
    ///
    /// # Errors
    /// A picture cannot be drawn.
    fn contents(&self, file: &str) -> Result<Vec<u8>, Error>;
}

/// A result of a campaign that is written to a single JSON file.
pub trait JsonArtefact: Serialize {
    /// The name of the JSON file to which the result is written.
    const FILE: &'static str;
}

impl<T: JsonArtefact> Artefact for T {
    fn files(&self) -> Vec<&'static str> {
        vec![T::FILE]
    }

    fn contents(&self, _: &str) -> Result<Vec<u8>, Error> {
        Ok(json(self))
    }
}

/// Formats a value as indented JSON with a final line break. All JSON files of a campaign have this format.
pub fn json(value: &impl Serialize) -> Vec<u8> {
    let mut text = serde_json::to_vec_pretty(value).expect("what is known of a campaign is always JSON");
    text.push(b'\n');
    text
}

impl Folder {
    /// Writes each file of an artefact to the campaign's folder, completely or not at all.
    ///
    /// # Errors
    /// A file cannot be drawn or written.
    pub fn put(&self, artefact: &dyn Artefact) -> Result<(), Error> {
        artefact.files().into_iter().try_for_each(|file| self.write(file, &artefact.contents(file)?))
    }
}
