//! The text of a file, with its lines.

use std::path::{Path, PathBuf};

/// The text of a file.
#[derive(Debug)]
pub(super) struct Source {
    file: PathBuf,
    text: String,
    /// The positions in `text` at which lines begin.
    lines: Vec<usize>,
}

impl Source {
    /// Takes a text. `file` is the name for messages.
    pub fn new(file: &Path, mut text: String) -> Self {
        if text.starts_with('\u{feff}') {
            text.remove(0);
        }
        let lines = [0].into_iter().chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { file: file.to_owned(), text, lines }
    }

    /// Returns the text without a mark of the byte order.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the number of the line with a position in the text, from 1.
    pub fn line(&self, at: usize) -> u32 {
        self.lines.partition_point(|start| *start <= at) as u32
    }

    /// Returns the path of the file.
    pub fn file(&self) -> &Path {
        &self.file
    }
}
