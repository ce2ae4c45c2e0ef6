//! An XML file, and the tree of its elements.

use super::element::Element;
use super::encoding;
use super::error::{Flaw, Malformed, ReadError};
use super::source::Source;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The greatest size of a file in bytes.
const MOST_BYTES: u64 = 256 << 20;

/// An XML file.
#[derive(Debug)]
pub(crate) struct Document(Source);

impl Document {
    /// Reads a file.
    pub fn open(file: &Path) -> Result<Self, ReadError> {
        let fails_for = |flaw| ReadError { file: file.to_owned(), line: None, flaw };
        let fails = |flaw| fails_for(Box::new(flaw));
        let mut bytes = Vec::new();
        let opened = File::open(file).map_err(|error| fails(Flaw::Unreadable(error)))?;
        opened.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(|error| fails(Flaw::Unreadable(error)))?;
        if bytes.len() as u64 > MOST_BYTES {
            let bytes = std::fs::metadata(file).map_or(bytes.len() as u64, |metadata| metadata.len());
            return Err(fails(Flaw::TooLarge { bytes, limit: MOST_BYTES }));
        }
        Ok(Self::of(file, encoding::text(bytes).map_err(fails_for)?))
    }

    /// Takes a text. `file` is the name for messages.
    pub fn of(file: &Path, text: String) -> Self {
        Self(Source::new(file, text))
    }

    /// Returns the path of the file.
    pub fn file(&self) -> &Path {
        self.0.file()
    }

    /// Returns the text of the file.
    pub fn text(&self) -> &str {
        self.0.text()
    }

    /// Returns the tree of the elements of the text.
    pub fn tree(&self) -> Result<roxmltree::Document<'_>, ReadError> {
        roxmltree::Document::parse(self.0.text()).map_err(|error| {
            let line = match error {
                // The file is cut off: its end is the place of the mistake.
                roxmltree::Error::UnexpectedEndOfStream | roxmltree::Error::UnclosedRootNode => {
                    self.0.line(self.text().len())
                }
                _ => error.pos().row,
            };
            let line = Some(line);
            let flaw = match error {
                roxmltree::Error::DtdDetected => Flaw::DocumentType,
                error => Flaw::Malformed(Malformed(error)),
            };
            ReadError { file: self.0.file().to_owned(), line, flaw: Box::new(flaw) }
        })
    }

    /// Returns the outermost element of a tree of this text, if the element has the expected name.
    pub fn root<'a, 'i>(
        &'a self,
        tree: &'a roxmltree::Document<'i>,
        expected: &'static str,
    ) -> Result<Element<'a, 'i>, ReadError> {
        let root = Element::new(&self.0, tree.root_element());
        if root.name() == expected {
            Ok(root)
        } else {
            Err(root.error(Flaw::Root { found: root.name().to_owned(), expected }))
        }
    }
}
