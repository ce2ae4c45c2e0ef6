//! Files that are written whole or not at all.
//!
//! A file is written beside its target under a random name, and takes the place of the target when it is complete. Its
//! mode and its owner stay. Links are followed. Devices, pipes and the output of this process cannot be replaced: what
//! is meant for them is written to them directly.

mod input;
mod owner;

pub(crate) use input::is_regular;
pub use input::{InputFlaw, Lines, read_bytes, read_text, read_text_here};

use crate::{Error, Reason};
use std::ffi::OsStr;
use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::{TempDir, TempPath};
use thiserror::Error;

/// The greatest number of links in a chain, as on Linux.
const MOST_LINKS: usize = 40;

/// The end of temporary names.
const SUFFIX: &str = ".part";

/// The number of random characters in temporary names.
const RANDOM: usize = 6;

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

/// A file that is being written, and that nobody sees under its final name before it is complete. If it is dropped
/// before, nothing is left behind.
#[derive(Debug)]
pub struct Draft {
    /// The path for messages.
    to: PathBuf,
    /// The temporary file and its final name; `None` for a target that is written directly.
    part: Option<Part>,
}

impl Draft {
    /// Begins a file. What is written to the returned file gets the name `to` when the draft is finished. A device, a
    /// pipe and the output of this process are written at once.
    ///
    /// # Errors
    /// Nothing can be written there, or `to` is a folder.
    pub fn new(to: &Path) -> Result<(Self, File), Error> {
        let (file, part) = begin(to).map_err(Error::io("write", to))?;
        Ok((Self { to: to.to_owned(), part }, file))
    }

    /// Gives the file its final name.
    ///
    /// # Errors
    /// The disk is full, or the name cannot be given.
    pub fn finish(self) -> Result<(), Error> {
        let Some((part, to)) = self.part else { return Ok(()) };
        // A file that keeps its mode may be one that this user may write and not read.
        let sync = File::options().write(true).open(&part).and_then(|file| file.sync_all());
        let named = sync.and_then(|()| part.persist(to).map_err(|error| error.error));
        named.map_err(Error::io("write", &self.to))
    }
}

/// A folder that is being filled, and that gets its final name when it is complete. If it is dropped before, nothing is
/// left behind.
#[derive(Debug)]
pub struct DraftFolder {
    to: PathBuf,
    part: TempDir,
}

impl DraftFolder {
    /// Creates a folder that gets the name `to` when it is complete, and the folders above `to`.
    ///
    /// # Errors
    /// No folder can be created there.
    pub fn new(to: &Path) -> Result<Self, Error> {
        let begin = || {
            fs::create_dir_all(folder_of(to))?;
            let prefix = prefix(to)?;
            let mut builder = tempfile::Builder::new();
            builder.prefix(&prefix).suffix(SUFFIX);
            owner::like_new_folders(&mut builder);
            builder.tempdir_in(folder_of(to))
        };
        let part = begin().map_err(Error::io("create", to))?;
        Ok(Self { to: to.to_owned(), part })
    }

    /// Returns the path of the folder before it is complete.
    pub fn path(&self) -> &Path {
        self.part.path()
    }

    /// Gives the folder its final name.
    ///
    /// # Errors
    /// The name cannot be given, for example because somebody else has made a folder of this name meanwhile.
    pub fn finish(self) -> Result<(), Error> {
        fs::rename(self.part.path(), &self.to).map_err(Error::io("write", &self.to))?;
        // There is nothing to remove under the temporary name.
        let _ = self.part.keep();
        Ok(())
    }
}

/// Writes a file completely or not at all, even if the program crashes.
///
/// # Errors
/// The file cannot be written, for example because the disk is full.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), Error> {
    let (draft, mut file) = Draft::new(path)?;
    file.write_all(contents).map_err(Error::io("write", path))?;
    draft.finish()
}

/// A temporary file, with the final name that it gets.
type Part = (TempPath, PathBuf);

/// Opens the file that is written first: a temporary file, or the target itself.
fn begin(to: &Path) -> io::Result<(File, Option<Part>)> {
    match fs::metadata(to) {
        Ok(there) => instead_of(to, &there),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            beside(&end_of_links(to)?).map(|(file, part)| (file, Some(part)))
        }
        Err(error) => Err(error),
    }
}

/// Opens the file that is written instead of something that exists.
fn instead_of(to: &Path, there: &Metadata) -> io::Result<(File, Option<Part>)> {
    if there.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if let Some(output) = owner::own_output(there)? {
        return Ok((output, None));
    }
    // A file that may not be written may not be replaced either.
    let direct = File::options().append(true).open(to)?;
    if !there.is_file() {
        return Ok((direct, None));
    }
    let (file, part) = beside(&fs::canonicalize(to)?)?;
    if owner::keep(&file, there)? {
        return Ok((file, Some(part)));
    }
    // The file is another user's, and would not be any more if a file of this user took its place.
    direct.set_len(0)?;
    Ok((direct, None))
}

/// Creates a temporary file in the folder of its final name.
fn beside(to: &Path) -> io::Result<(File, Part)> {
    let prefix = prefix(to)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX).rand_bytes(RANDOM);
    let (file, part) = builder.make_in(folder_of(to), |path| File::create_new(path))?.into_parts();
    Ok((file, (part, to.to_owned())))
}

/// Returns the beginning of temporary names of a file or a folder.
fn prefix(to: &Path) -> io::Result<String> {
    let name = to.file_name().ok_or(ErrorKind::InvalidFilename)?.to_string_lossy();
    // A temporary name may be no longer than a file name may be.
    Ok(format!(".{}.", name.chars().take(50).collect::<String>()))
}

/// The error that a file of a campaign is a link, which leads to a place that the user has not named.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{} is a link, and nothing is written through links in the folder of a campaign: remove the link", path.display())]
pub struct IsLink {
    /// The path of the link.
    pub path: PathBuf,
}

impl Reason for IsLink {}

/// Checks that a file that the program names itself is no link. The folder may be that of a stranger.
///
/// # Errors
/// The file is a link.
pub fn is_no_link(path: &Path) -> Result<(), IsLink> {
    if path.is_symlink() { Err(IsLink { path: path.to_owned() }) } else { Ok(()) }
}

/// Writes a file that the program names itself completely or not at all.
///
/// # Errors
/// The file is a link, or cannot be written.
pub fn write_whole_here(path: &Path, contents: &[u8]) -> Result<(), Error> {
    is_no_link(path)?;
    write_whole(path, contents)
}

/// Removes the temporary files that a killed process has left in a folder, if they stand for files that `is_ours`
/// names. The caller ensures that no other process writes these files. A file that cannot be removed stays.
pub(crate) fn remove_leftovers(folder: &Path, is_ours: impl Fn(&OsStr) -> bool) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_str().and_then(|name| name.strip_prefix('.')?.strip_suffix(SUFFIX)?.rsplit_once('.'));
        let Some((name, random)) = name else { continue };
        if random.len() == RANDOM && random.chars().all(|c| c.is_ascii_alphanumeric()) && is_ours(OsStr::new(name)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Returns the folder of a file.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes a folder and the folders above it, unless they exist. A link to a folder that does not exist yet is followed.
///
/// # Errors
/// The folder cannot be made, or the path leads to a file.
pub fn create_folder(path: &Path) -> Result<(), Error> {
    if path.is_dir() {
        return Ok(());
    }
    end_of_links(path).and_then(fs::create_dir_all).map_err(Error::io("create", path))
}

/// Returns the path to which a chain of links leads. Nothing exists there.
fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&path) else { return Ok(path) };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(io::Error::other("the link leads to links without an end"))
}
