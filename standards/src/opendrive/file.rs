//! Reads a file of OpenDRIVE, and says in notes how the map differs from the file.

use super::elements::schema;
use super::map::Map;
use super::note::Note;
use super::read;
use super::road::Road;
use crate::xml::{Document, ReadError};
use std::path::Path;

/// The distance in metres from which on a gap between two pieces of a reference line is reported.
const GAP: f64 = 0.01;

impl Map {
    /// Reads a file.
    ///
    /// # Errors
    /// The file cannot be read, is not valid, or has an element that is not supported.
    pub fn read(file: &Path) -> Result<Self, ReadError> {
        Self::of(&Document::open(file)?)
    }

    /// Reads a text. `file` is the name for messages.
    ///
    /// # Errors
    /// The text is not valid, or has an element that is not supported.
    pub fn parse(file: &Path, text: String) -> Result<Self, ReadError> {
        Self::of(&Document::of(file, text))
    }

    fn of(document: &Document) -> Result<Self, ReadError> {
        let tree = document.tree()?;
        let root = document.root(&tree, "OpenDRIVE")?;
        let without_effect = schema().check(root)?;
        let (mut map, minor) = read::map(root)?;
        let mut notes = std::mem::take(&mut map.notes);
        if minor < read::OLDEST {
            notes.insert(0, Note::Old { minor });
        }
        notes.extend(map.flattened());
        notes.extend(map.roads.iter().flat_map(jumps));
        notes.extend(without_effect.into_iter().map(Note::NoEffect));
        map.notes = notes;
        Ok(map)
    }

    fn flattened(&self) -> Option<Note> {
        let greatest = |of: fn(&Road) -> f64| self.roads.iter().map(of).fold(0.0, f64::max);
        let height = greatest(|road| road.elevation.greatest(0.0, road.length));
        let roll = greatest(|road| road.superelevation.greatest(0.0, road.length));
        (height > 0.0 || roll > 0.0).then_some(Note::Flat { height, roll })
    }
}

fn jumps(road: &Road) -> impl Iterator<Item = Note> {
    road.line.pieces().windows(2).filter_map(|pair| {
        let gap = (pair[0].at(pair[1].s - pair[0].s).position - pair[1].start.position).norm();
        (gap > GAP).then(|| Note::Jump { road: road.id.clone(), s: pair[1].s, gap })
    })
}
