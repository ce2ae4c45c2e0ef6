//! New names for elements of a storyboard to which conditions refer and whose name alone is not enough.
//!
//! A condition refers to an element by its name, its kind, and the names around it if necessary. The checker of ASAM wants the name
//! alone to be enough (rule `reference_control.resolvable_storyboard_element_reference`).

use super::measure::Measure;
use super::play::Stage;
use super::reference::{Named, full_path, item};
use super::story::{Storyboard, names_of};
use std::collections::BTreeMap;

/// The elements with new names.
pub(super) struct Renamed<'b> {
    items: Vec<Named<'b>>,
    /// The new names of elements, by their indices.
    names: BTreeMap<usize, String>,
}

impl<'b> Renamed<'b> {
    /// Finds new names for the elements to which the conditions of a storyboard refer.
    pub fn of(board: &'b Storyboard) -> Self {
        let mut names: BTreeMap<usize, String> = BTreeMap::new();
        let measures = Stage::conditions(board).flat_map(|condition| &condition.check.measures);
        for measure in measures {
            let Measure::State { element, .. } = measure else { continue };
            let (name, kind) = (&board.items[*element].name, board.items[*element].kind.name());
            let is_shared = board.items.iter().filter(|item| item.name == *name).count() > 1;
            if is_shared && !names.contains_key(element) {
                let numbered = (2..).map(|number| format!("{name} ({kind} {number})"));
                let mut candidates = [format!("{name} ({kind})")].into_iter().chain(numbered);
                let is_taken = |new: &String| names.values().any(|known| known == new);
                let is_free = |new: &String| board.items.iter().all(|item| item.name != *new) && !is_taken(new);
                let new = candidates.find(is_free).expect("there are more numbers than elements");
                names.insert(*element, new);
            }
        }
        Self { items: names_of(&board.items), names }
    }

    /// Returns the new name of the element of a kind whose name follows the names of all elements around it; `None` if it keeps its
    /// name.
    pub fn name(&self, kind: &str, path: &str) -> Option<&str> {
        let is_it = |index: usize| self.items[index].kind == kind && full_path(&self.items, index) == path;
        self.names.iter().find(|(index, _)| is_it(**index)).map(|(_, new)| new.as_str())
    }

    /// Returns the name that is enough to refer to the element of a kind to which a condition refers; `None` if no element is meant.
    /// `around` is the name of the element of the condition, after the names of all elements around it.
    pub fn reference(&self, kind: &str, path: &str, around: &str) -> Option<&str> {
        let owner = (0..self.items.len()).find(|index| full_path(&self.items, *index) == around);
        let index = item(&self.items, kind, path, owner).ok()?;
        Some(self.names.get(&index).map_or(self.items[index].name, String::as_str))
    }

    /// Describes the new names.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.names.iter().map(|(index, new)| {
            let Named { name, kind, .. } = self.items[*index];
            format!("the {kind} `{name}` is called `{new}`, because another element has its name")
        })
    }
}
