//! A file of OpenDRIVE as a whole.

use super::junction::Junction;
use super::note::Note;
use super::object::Object;
use super::road::Road;
use std::sync::Arc;

/// The roads and junctions of a file of OpenDRIVE.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// The roads in the order of the file.
    pub roads: Vec<Road>,
    /// The junctions in the order of the file.
    pub junctions: Vec<Junction>,
    /// The remarks on the file.
    pub notes: Vec<Note>,
    /// The text of the file.
    pub text: Arc<str>,
}

impl Map {
    /// Returns the index of the road with an identifier.
    pub fn road(&self, id: &str) -> Option<usize> {
        self.roads.iter().position(|road| road.id == id)
    }

    /// Returns the objects and signals of all roads, in the order of the file.
    pub fn objects(&self) -> impl Iterator<Item = &Object> {
        self.roads.iter().flat_map(|road| &road.objects)
    }
}
