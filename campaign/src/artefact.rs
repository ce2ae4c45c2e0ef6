//! What is derived from the trials of a campaign and written beside them.

use crate::{Error, Folder};
use serde::Serialize;

/// Something that is known of a campaign, as files of its folder.
pub trait Artefact {
    /// The names of its files. No two artefacts have a file of one name.
    fn files(&self) -> Vec<&'static str>;

    /// The contents of one of its files.
    ///
    /// # Errors
    /// A picture cannot be drawn.
    fn contents(&self, file: &str) -> Result<Vec<u8>, Error>;
}

/// Something that is known of a campaign and written as one JSON file.
pub trait JsonArtefact: Serialize {
    /// The name of the file.
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

/// A value as JSON on lines of its own, as all JSON files of a campaign are written.
pub fn json(value: &impl Serialize) -> Vec<u8> {
    let mut text = serde_json::to_vec_pretty(value).expect("what is known of a campaign is always JSON");
    text.push(b'\n');
    text
}

impl Folder {
    /// Writes the files of an artefact, each whole or not at all.
    ///
    /// # Errors
    /// One cannot be drawn or written.
    pub fn put(&self, artefact: &dyn Artefact) -> Result<(), Error> {
        artefact.files().into_iter().try_for_each(|file| self.write(file, &artefact.contents(file)?))
    }
}
