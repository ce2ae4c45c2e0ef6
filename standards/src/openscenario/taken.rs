//! Names that elements of the same kind have taken.

use super::scope::Node;
use crate::xml::{Flaw, ReadError};
use std::collections::BTreeMap;

/// The names that elements have taken, with the lines of the elements.
#[derive(Debug, Default)]
pub(super) struct Taken(BTreeMap<String, u32>);

impl Taken {
    /// Takes the name of an element.
    ///
    /// # Errors
    /// Another element has taken the name.
    pub fn claim(&mut self, node: Node<'_>, name: &str) -> Result<(), ReadError> {
        self.claim_in(node, "name", name)
    }

    /// Takes the name in an attribute of an element.
    ///
    /// # Errors
    /// Another element has taken the name.
    pub fn claim_in(&mut self, node: Node<'_>, attribute: &'static str, name: &str) -> Result<(), ReadError> {
        match self.0.insert(name.to_owned(), node.element.line()) {
            None => Ok(()),
            Some(first) => {
                let (element, found) = (node.name().to_owned(), name.to_owned());
                Err(node.error(Flaw::Taken { element, attribute, found, first }))
            }
        }
    }
}
