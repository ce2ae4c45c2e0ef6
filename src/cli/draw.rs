//! The files that pictures are written to: `--draw` of `paracosm-fuzz describe` and `replay`, `--out` of `map`.
//!
//! Older pictures and reports are replaced, since they can be made again. Files of a campaign are never replaced.

use super::usage;
use paracosm_campaign::files::write_whole;
use paracosm_campaign::{Error, Failure as Breakdown, Folder};
use paracosm_space::{did_you_mean, nearest};
use std::path::{Path, PathBuf};

/// The format of a picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FileKind {
    Svg,
    Png,
    Gif,
    Csv,
}

impl FileKind {
    fn ending(self) -> &'static str {
        match self {
            FileKind::Svg => "svg",
            FileKind::Png => "png",
            FileKind::Gif => "gif",
            FileKind::Csv => "csv",
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
    /// slow work.
    ///
    /// # Errors
    /// The file belongs to a campaign, or has another ending.
    pub fn new(option: &str, path: &Path, kinds: &[FileKind]) -> Result<Self, Error> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let Some(kind) = kinds.iter().find(|kind| kind.ending() == ending) else {
            let known: Vec<_> = kinds.iter().map(|kind| kind.ending()).collect();
            let found = if ending.is_empty() { "no ending".to_owned() } else { format!("the ending `.{ending}`") };
            let (path, meant) = (path.display(), did_you_mean(&nearest(&ending, known.iter().copied())));
            let known: Vec<_> = known.iter().map(|ending| format!(".{ending}")).collect();
            let message = format!("{option} {path}: found {found}, expected {}{meant}", known.join(" or "));
            return Err(usage(message));
        };
        is_ours_to_write(option, path)?;
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
        let what = if self.kind == FileKind::Csv { "table" } else { "picture" };
        Ok(format!("{what} of {} kB written to {}", contents.len().div_ceil(1000), self.path.display()))
    }
}

/// Checks that the file of an option does not have the name of a campaign's own file, which nothing replaces.
pub(super) fn is_ours_to_write(option: &str, path: &Path) -> Result<(), Error> {
    if path.file_name().is_some_and(Folder::owns) {
        let message = format!(
            "{option} {} has the name of a file that belongs to campaigns; choose another name",
            path.display()
        );
        return Err(usage(message));
    }
    Ok(())
}
