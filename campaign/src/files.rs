//! Files that are written whole or not at all.

use crate::{Error, Reason};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The error that a file exists already and must not be replaced.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{} exists, and {what} does not replace a file: choose another name", path.display())]
pub struct Exists {
    /// The path of the existing file.
    pub path: PathBuf,
    /// The kind of file that should be written, with an article, for example "a regression file".
    pub what: &'static str,
}

impl Reason for Exists {}

/// Checks that no file exists at a path.
///
/// # Errors
/// The file exists; `what` names the thing that was to be written, with its article.
pub fn is_new(path: &Path, what: &'static str) -> Result<(), Exists> {
    if path.exists() { Err(Exists { path: path.to_owned(), what }) } else { Ok(()) }
}

/// Writes a file completely or not at all, even if the program crashes.
///
/// # Errors
/// The file cannot be written, for example because the disk is full.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), Error> {
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    let part = PathBuf::from(part);
    let write = || {
        let mut file = File::create(&part)?;
        file.write_all(contents)?;
        file.sync_all()?;
        fs::rename(&part, path)
    };
    write().map_err(|source| {
        // The partial file is of no use. If it cannot be removed either, nothing else can be done.
        let _ = fs::remove_file(&part);
        Error::io("write", path)(source)
    })
}
