//! Artefacts: results that are derived from the trials of a campaign and written beside them.

use crate::json_text::read_json;
use crate::{Error, Folder};
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::ErrorKind;
use std::path::Path;

/// A result of a campaign that is written to files in the campaign's folder.
pub trait Artefact: Sync {
    /// Returns the names of the artefact's files. No two artefacts share a file name.
    fn files(&self) -> Vec<&'static str>;

    /// Returns the contents of the artefact's file with the given name.
    ///
    /// # Errors
    /// A picture cannot be drawn.
    fn contents(&self, file: &str) -> Result<Vec<u8>, Error>;
}

/// A result of a campaign that is written to a single JSON file.
pub trait JsonArtefact: Serialize + Sync {
    /// The name of the JSON file to which the result is written.
    const FILE: &'static str;

    /// Reads the result from the folder of a campaign; `None` if the folder does not have it, because the campaign did not end, or
    /// an earlier version of the software ran it.
    ///
    /// # Errors
    /// The file cannot be read.
    fn read(folder: &Path) -> Result<Option<Self>, Error>
    where
        Self: DeserializeOwned,
    {
        let file = folder.join(Self::FILE);
        match std::fs::read_to_string(&file) {
            Ok(text) => read_json(&text).map(Some).map_err(|flaw| Error::in_file(&file, flaw.line(), flaw)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(Error::io("read", &file)(error)),
        }
    }
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
        // A picture takes long to draw.
        let contents: Vec<_> = artefact.files().into_par_iter().map(|file| (file, artefact.contents(file))).collect();
        contents.into_iter().try_for_each(|(file, contents)| self.write(file, &contents?))
    }
}
