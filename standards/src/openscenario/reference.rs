//! References of conditions to elements of the storyboard. A condition may stand before the element that it names, so references are
//! resolved once the whole storyboard has been read.

use super::scope::Node;
use crate::xml::{Flaw, ReadError};
use paracosm_space::nearest;
use std::cell::{Cell, RefCell};
use std::path::PathBuf;

/// The separator of the names in a path such as `act::group`.
const SEPARATOR: &str = "::";
/// The condition that refers to an element.
pub(super) const CONDITION: &str = "StoryboardElementStateCondition";
/// The attribute of the condition that names the element.
pub(super) const ELEMENT: &str = "storyboardElementRef";

/// An element of the storyboard by its name, with the index of the element around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Named<'n> {
    pub name: &'n str,
    pub kind: &'static str,
    pub parent: Option<usize>,
}

/// A reference to an element of the storyboard, with its place in a file.
#[derive(Debug)]
struct Reference {
    /// The name of the element, which may follow the names of the elements around it.
    path: String,
    kind: &'static str,
    /// The index of the element whose trigger has the condition; `None` for the trigger of the storyboard.
    owner: Option<usize>,
    file: PathBuf,
    line: u32,
}

/// The references that have been read.
#[derive(Debug, Default)]
pub(super) struct References {
    all: RefCell<Vec<Reference>>,
    owner: Cell<Option<usize>>,
}

impl References {
    /// Says whose triggers are read next: those of the element with an index, or that of the storyboard.
    pub fn now_of(&self, owner: Option<usize>) {
        self.owner.set(owner);
    }

    /// Notes the reference of a condition to an element of a kind. Returns the number of the reference.
    pub fn note(&self, node: Node<'_>, kind: &'static str) -> Result<usize, ReadError> {
        let (path, file, line) =
            (node.required(ELEMENT)?.into_owned(), node.element.file().into(), node.element.line());
        let mut all = self.all.borrow_mut();
        all.push(Reference { path, kind, owner: self.owner.get(), file, line });
        Ok(all.len() - 1)
    }

    /// Returns the index of the element of each reference.
    ///
    /// # Errors
    /// No element has the name, or several elements have it.
    pub fn resolve(self, items: &[Named<'_>]) -> Result<Vec<usize>, ReadError> {
        self.all.into_inner().iter().map(|reference| reference.item(items)).collect()
    }
}

impl Reference {
    /// Returns the index of the element.
    fn item(&self, items: &[Named<'_>]) -> Result<usize, ReadError> {
        let (element, found, kind) = (CONDITION.to_owned(), self.path.clone(), self.kind);
        let flaw = match item(items, kind, &self.path, self.owner) {
            Ok(index) => return Ok(index),
            Err(Some(two)) => {
                let candidates = two.map(|index| full_path(items, index));
                Flaw::Ambiguous { element, attribute: ELEMENT, found, kind, candidates }
            }
            Err(None) => {
                let names = of_kind(items, kind).map(|index| items[index].name);
                let nearest = nearest(&found, names).map(str::to_owned);
                Flaw::Dangling { element, attribute: ELEMENT, found, kind, nearest }
            }
        };
        Err(ReadError { file: self.file.clone(), line: Some(self.line), flaw: Box::new(flaw) })
    }
}

/// Returns the index of the element of a kind to which a path refers. The path is the name of the element, which may follow the names
/// of the elements around it, with `::` between them. If several elements have the name, the path refers to the nearest of them: to
/// the one that is in most of the elements around the condition. So a maneuver of a catalog that is used twice refers to its own
/// events. `owner` is the element of the condition.
///
/// # Errors
/// `None` if no element has the name, and the first two of the nearest elements if there is more than one.
pub(super) fn item(
    items: &[Named<'_>],
    kind: &str,
    path: &str,
    owner: Option<usize>,
) -> Result<usize, Option<[usize; 2]>> {
    let around: Vec<_> = ancestry(items, owner).collect();
    let shared = |index: usize| ancestry(items, Some(index)).filter(|each| around.contains(each)).count();
    let named: Vec<_> = of_kind(items, kind).filter(|index| is_named(items, *index, path)).collect();
    let most = named.iter().map(|index| shared(*index)).max();
    let nearest: Vec<_> = named.into_iter().filter(|index| Some(shared(*index)) == most).collect();
    match nearest[..] {
        [index] => Ok(index),
        [] => Err(None),
        [first, second, ..] => Err(Some([first, second])),
    }
}

/// Returns an element and all elements around it.
fn ancestry(items: &[Named<'_>], from: Option<usize>) -> impl Iterator<Item = usize> {
    std::iter::successors(from, |index| items[*index].parent)
}

fn of_kind<'i>(items: &'i [Named<'i>], kind: &'i str) -> impl Iterator<Item = usize> + 'i {
    (0..items.len()).filter(move |index| items[*index].kind == kind)
}

fn is_named(items: &[Named<'_>], index: usize, path: &str) -> bool {
    let item = items[index];
    if item.name == path {
        return true;
    }
    let around = path.strip_suffix(item.name).and_then(|rest| rest.strip_suffix(SEPARATOR));
    around.is_some_and(|around| item.parent.is_some_and(|parent| is_named(items, parent, around)))
}

/// Returns the name of an element after the names of all elements around it.
pub(super) fn full_path(items: &[Named<'_>], index: usize) -> String {
    let name = items[index].name;
    items[index].parent.map_or(name.to_owned(), |parent| within(&full_path(items, parent), name))
}

/// Returns the name of an element after the names of the elements around it, if there are any.
pub(super) fn within(around: &str, name: &str) -> String {
    if around.is_empty() { name.to_owned() } else { format!("{around}{SEPARATOR}{name}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn items() -> Vec<Named<'static>> {
        [
            ("story", "story", None),
            ("first", "act", Some(0)),
            ("group", "maneuverGroup", Some(1)),
            ("second", "act", Some(0)),
            ("group", "maneuverGroup", Some(3)),
            ("third", "act", Some(0)),
        ]
        .map(|(name, kind, parent)| Named { name, kind, parent })
        .to_vec()
    }

    #[test]
    fn a_name_refers_to_the_nearest_element_and_names_around_it_choose_another() {
        let all = items();
        let found = |path, owner| item(&all, "maneuverGroup", path, owner);
        assert_eq!(found("group", Some(2)), Ok(2));
        assert_eq!(found("group", Some(3)), Ok(4));
        assert_eq!(found("second::group", Some(2)), Ok(4));
        assert_eq!(found("story::first::group", None), Ok(2));
        assert_eq!(found("group", Some(5)), Err(Some([2, 4])));
        assert_eq!(found("group", None), Err(Some([2, 4])));
        assert_eq!(found("third::group", None), Err(None));
        assert_eq!(found("story::group", None), Err(None));
        assert_eq!(item(&all, "act", "group", None), Err(None));
    }
}
