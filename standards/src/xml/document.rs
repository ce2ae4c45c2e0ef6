//! An XML file, and the tree of its elements.

use super::element::Element;
use super::encoding;
use super::error::{Flaw, Malformed, ReadError};
use super::source::Source;
use self_cell::self_cell;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The greatest size of a file in bytes.
const MOST_BYTES: u64 = 256 << 20;

type Tree<'t> = roxmltree::Document<'t>;

self_cell! {
    /// A text with the tree of its elements, which borrows the text.
    struct Parsed {
        owner: Source,
        #[covariant]
        dependent: Tree,
    }
    impl { Debug }
}

/// An XML file.
#[derive(Debug)]
pub(crate) struct Document(Parsed);

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
        Self::of(file, encoding::text(bytes).map_err(fails_for)?)
    }

    /// Parses a text. `file` is the name for messages.
    pub fn of(file: &Path, text: String) -> Result<Self, ReadError> {
        Parsed::try_new(Source::new(file, text), parse).map(Self)
    }

    /// Returns the path of the file.
    pub fn file(&self) -> &Path {
        self.0.borrow_owner().file()
    }

    /// Returns the text of the file.
    pub fn text(&self) -> &str {
        self.0.borrow_owner().text()
    }

    /// Returns the outermost element, if the element has the expected name.
    pub fn root(&self, expected: &'static str) -> Result<Element<'_, '_>, ReadError> {
        let root = Element::new(self.0.borrow_owner(), self.0.borrow_dependent().root_element());
        if root.name() == expected {
            Ok(root)
        } else {
            Err(root.error(Flaw::Root { found: root.name().to_owned(), expected }))
        }
    }
}

fn parse(source: &Source) -> Result<Tree<'_>, ReadError> {
    Tree::parse(source.text()).map_err(|error| {
        let line = match error {
            // The file is cut off: its end is the place of the mistake.
            roxmltree::Error::UnexpectedEndOfStream | roxmltree::Error::UnclosedRootNode => {
                source.line(source.text().len())
            }
            _ => error.pos().row,
        };
        let line = Some(line);
        let flaw = match error {
            roxmltree::Error::DtdDetected => Flaw::DocumentType,
            error => Flaw::Malformed(Malformed(error)),
        };
        ReadError { file: source.file().to_owned(), line, flaw: Box::new(flaw) }
    })
}
