//! New names for elements of a storyboard that share their name with elements of other kinds.
//!
//! A condition refers to an element by its name and its kind. The checker of ASAM wants the name alone to be enough (rule
//! `reference_control.resolvable_storyboard_element_reference`).

use super::measure::Measure;
use super::play::Stage;
use super::story::Storyboard;

/// The elements with new names: the kind, the name, and the new name of each.
pub(super) struct Renamed(Vec<(&'static str, String, String)>);

impl Renamed {
    /// Finds new names for the elements to which the conditions of a storyboard refer.
    pub fn of(board: &Storyboard) -> Self {
        let mut renamed: Vec<(&'static str, String, String)> = Vec::new();
        let measures = Stage::conditions(board).flat_map(|condition| &condition.check.measures);
        for measure in measures {
            let Measure::State { element, kind, .. } = measure else { continue };
            let named = |name: &str| board.items.iter().filter(|item| item.name == name).count();
            let of_kind = board.items.iter().filter(|item| item.name == *element && item.kind.name() == *kind).count();
            let new = format!("{element} ({kind})");
            let is_known = renamed.iter().any(|(_, name, to)| name == element || *to == new);
            if named(element) > 1 && of_kind == 1 && named(&new) == 0 && !is_known {
                renamed.push((kind, element.clone(), new));
            }
        }
        Self(renamed)
    }

    /// Returns the new name of an element; `None` if it keeps its name.
    pub fn name(&self, kind: &str, name: &str) -> Option<&str> {
        self.0.iter().find(|(of, old, _)| *of == kind && old == name).map(|(.., new)| new.as_str())
    }

    /// Describes the new names.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|(kind, old, new)| {
            format!("the {kind} `{old}` is called `{new}`, because another element has its name")
        })
    }
}
