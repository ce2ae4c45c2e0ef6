//! A file or a folder that gets its name when it is whole, and leaves nothing behind where it does not become so.

use paracosm_campaign::Error;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What is being written, under a name that nobody else has.
#[derive(Debug)]
pub(super) struct Part {
    path: PathBuf,
    to: PathBuf,
}

impl Part {
    /// A new file, which is to become this one.
    ///
    /// # Errors
    /// Nothing can be written there.
    pub fn file(to: &Path) -> Result<(Self, File), Error> {
        Self::new(to, |path| File::create_new(path))
    }

    /// A new folder, which is to become this one.
    ///
    /// # Errors
    /// Nothing can be written there.
    pub fn folder(to: &Path) -> Result<Self, Error> {
        if let Some(parent) = to.parent() {
            fs::create_dir_all(parent).map_err(Error::io("create", parent))?;
        }
        Self::new(to, |path| fs::create_dir(path)).map(|(part, ())| part)
    }

    /// Tries one name after the other until there is nothing of that name yet.
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

    /// Where it is until it is whole.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives it its name.
    ///
    /// # Errors
    /// It cannot have it: somebody else has made a folder of that name meanwhile, say.
    pub fn finish(self) -> Result<(), Error> {
        fs::rename(&self.path, &self.to).map_err(Error::io("write", &self.to))
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        // There is nothing of this name any more where it has become whole; that it cannot be removed changes nothing.
        let _ = if self.path.is_dir() { fs::remove_dir_all(&self.path) } else { fs::remove_file(&self.path) };
    }
}
