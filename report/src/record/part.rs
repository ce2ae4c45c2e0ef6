//! Writes a file or a folder that gets its name only when it is complete. If it is never completed, nothing is left
//! behind.

use paracosm_campaign::Error;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// A file or folder that is being written, under a temporary name that nobody else uses.
#[derive(Debug)]
pub(super) struct Part {
    path: PathBuf,
    to: PathBuf,
}

impl Part {
    /// Creates a temporary file that gets the name `to` when it is complete.
    ///
    /// # Errors
    /// Returns an error if nothing can be written there.
    pub fn file(to: &Path) -> Result<(Self, File), Error> {
        Self::new(to, |path| File::create_new(path))
    }

    /// Creates a temporary folder that gets the name `to` when it is complete.
    ///
    /// # Errors
    /// Returns an error if nothing can be written there.
    pub fn folder(to: &Path) -> Result<Self, Error> {
        if let Some(parent) = to.parent() {
            fs::create_dir_all(parent).map_err(Error::io("create", parent))?;
        }
        Self::new(to, |path| fs::create_dir(path)).map(|(part, ())| part)
    }

    /// Tries temporary names one after another until a name is free.
    fn new<T>(to: &Path, make: impl Fn(&Path) -> io::Result<T>) -> Result<(Self, T), Error> {
        let name = to.file_name().unwrap_or_default().to_string_lossy();
        let mut number = 0_u64;
        loop {
            let path = to.with_file_name(format!(".{name}.{number}.part"));
            match make(&path) {
                Ok(made) => return Ok((Self { path, to: to.to_owned() }, made)),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(Error::io("create", to)(error)),
            }
        }
    }

    /// Returns the temporary path of the file or folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Renames the temporary file or folder to its final name.
    ///
    /// # Errors
    /// Returns an error if the name cannot be given, for example because somebody else has made a folder of this name
    /// meanwhile.
    pub fn finish(self) -> Result<(), Error> {
        fs::rename(&self.path, &self.to).map_err(Error::io("write", &self.to))
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        // After `finish` nothing of the temporary name is left. A failure to remove it does no harm.
        let _ = if self.path.is_dir() { fs::remove_dir_all(&self.path) } else { fs::remove_file(&self.path) };
    }
}
