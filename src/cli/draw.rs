//! The files that pictures, tables and roads are written to: `--draw` of `paracosm-fuzz describe` and `replay`, `--out` of `map`.
//!
//! Older pictures and reports are replaced, since they can be made again. Files of a campaign are never replaced.

use super::usage;
use paracosm_campaign::files::write_whole;
use paracosm_campaign::{Error, Failure as Breakdown, Folder};
use paracosm_space::{did_you_mean, nearest};
use same_file::is_same_file;
use std::fs;
use std::path::{Path, PathBuf};

/// The format of a picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FileKind {
    Svg,
    Png,
    Gif,
    Csv,
    Xodr,
}

impl FileKind {
    fn ending(self) -> &'static str {
        match self {
            FileKind::Svg => "svg",
            FileKind::Png => "png",
            FileKind::Gif => "gif",
            FileKind::Csv => "csv",
            FileKind::Xodr => "xodr",
        }
    }
}

/// A file for a picture or for its numbers.
#[derive(Debug)]
pub(super) struct Target {
    path: PathBuf,
    pub kind: FileKind,
}

impl Target {
    /// Checks that a picture of one of these kinds can be written to the file of an option. This check comes before all
    /// slow work. `inputs` are the files that the command reads.
    ///
    /// # Errors
    /// The file belongs to a campaign, is read by the command, or has another ending; or its folder does not exist.
    pub fn new(option: &str, path: &Path, kinds: &[FileKind], inputs: &[&Path]) -> Result<Self, Error> {
        is_ours_to_write(option, path, inputs)?;
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        // A device or a pipe has no ending, and gets the first of the formats.
        let is_special = fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir());
        let usual = kinds.first().filter(|_| is_special);
        let Some(kind) = kinds.iter().find(|kind| kind.ending() == ending).or(usual) else {
            let known: Vec<_> = kinds.iter().map(|kind| kind.ending()).collect();
            let found = if ending.is_empty() { "no ending".to_owned() } else { format!("the ending `.{ending}`") };
            let (path, meant) = (path.display(), did_you_mean(&nearest(&ending, known.iter().copied())));
            let known: Vec<_> = known.iter().map(|ending| format!(".{ending}")).collect();
            let message = format!("{option} {path}: found {found}, expected {}{meant}", known.join(" or "));
            return Err(usage(message));
        };
        has_folder(option, path)?;
        Ok(Self { path: path.to_owned(), kind: *kind })
    }

    /// Draws a picture and writes the picture to its file. Returns its size in words.
    ///
    /// # Errors
    /// The picture cannot be drawn or written.
    pub fn write(
        &self,
        drawn: impl FnOnce(FileKind) -> Result<Vec<u8>, Box<dyn std::error::Error + Send + Sync>>,
    ) -> Result<String, Error> {
        let contents = drawn(self.kind).map_err(|source| Breakdown::Drawing { path: self.path.clone(), source })?;
        write_whole(&self.path, &contents)?;
        let what = match self.kind {
            FileKind::Csv => "table",
            FileKind::Xodr => "road network",
            FileKind::Gif => "film",
            FileKind::Svg | FileKind::Png => "picture",
        };
        Ok(format!("{what} of {} kB written to {}", contents.len().div_ceil(1000), self.path.display()))
    }
}

/// Checks that the folder of an option's file exists. This check comes before all slow work.
///
/// # Errors
/// The folder does not exist.
pub(super) fn has_folder(option: &str, path: &Path) -> Result<(), Error> {
    match path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
        Some(folder) => {
            Err(usage(format!("{option} {}: the folder {} does not exist", path.display(), folder.display())))
        }
        None => Ok(()),
    }
}

/// Checks that an option's file may be written: it is no file of a campaign, which nothing replaces, and none of the
/// files that the command reads. Links are followed.
///
/// # Errors
/// The file is one of these.
pub(super) fn is_ours_to_write(option: &str, path: &Path, inputs: &[&Path]) -> Result<(), Error> {
    // The end of a link may be a file of a campaign, even if the link has another name.
    let end = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if [path, &end].into_iter().any(|path| path.file_name().is_some_and(Folder::owns)) {
        let message = format!(
            "{option} {} has the name of a file that belongs to campaigns; choose another name",
            path.display()
        );
        return Err(usage(message));
    }
    match inputs.iter().find(|input| is_same_file(path, input).unwrap_or(false)) {
        Some(input) if *input == path => {
            Err(usage(format!("{option} {}: this command reads the file, choose another file", path.display())))
        }
        Some(input) => {
            let (path, input) = (path.display(), input.display());
            Err(usage(format!(
                "{option} {path} is the same file as {input}, which this command reads: choose another file"
            )))
        }
        None => Ok(()),
    }
}
