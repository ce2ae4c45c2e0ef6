//! References of conditions to elements of the storyboard. A condition may stand before the element that it names, so references are
//! resolved once the whole storyboard has been read.

use super::condition::Trigger;
use super::measure::Measure;
use super::scope::Node;
use super::story::Item;
use crate::xml::{Flaw, ReadError};
use paracosm_space::nearest;
use std::cell::RefCell;
use std::path::PathBuf;

/// The separator of the names in a path such as `act::group`.
const SEPARATOR: &str = "::";
/// The condition that refers to an element.
pub(super) const CONDITION: &str = "StoryboardElementStateCondition";
/// The attribute of the condition that names the element.
pub(super) const ELEMENT: &str = "storyboardElementRef";

/// A reference to an element of the storyboard, with its place in a file.
#[derive(Debug)]
pub(super) struct Reference {
    /// The name of the element, which may follow the names of the elements around it.
    path: String,
    kind: &'static str,
    file: PathBuf,
    line: u32,
}

/// The references that have been read.
#[derive(Debug, Default)]
pub(super) struct References(RefCell<Vec<Reference>>);

impl References {
    /// Notes the reference of a condition to an element of a kind. Returns the number of the reference.
    pub fn note(&self, node: Node<'_>, kind: &'static str) -> Result<usize, ReadError> {
        let (path, file, line) =
            (node.required(ELEMENT)?.into_owned(), node.element.file().into(), node.element.line());
        let mut all = self.0.borrow_mut();
        all.push(Reference { path, kind, file, line });
        Ok(all.len() - 1)
    }

    /// Replaces the numbers of references in conditions by the indices of the elements.
    ///
    /// # Errors
    /// No element has the name, or several elements have it.
    pub fn resolve(self, items: &mut [Item], stop: &mut Option<Trigger>) -> Result<(), ReadError> {
        let all = self.0.into_inner();
        for owner in 0..items.len() {
            let item = &mut items[owner];
            let mut triggers = [item.start.take(), item.stop.take()];
            for trigger in &mut triggers {
                resolved(trigger, &all, items, Some(owner))?;
            }
            [items[owner].start, items[owner].stop] = triggers;
        }
        resolved(stop, &all, items, None)
    }
}

/// Resolves the references of a trigger of the element `owner`; `None` stands for the storyboard.
fn resolved(
    trigger: &mut Option<Trigger>,
    all: &[Reference],
    items: &[Item],
    owner: Option<usize>,
) -> Result<(), ReadError> {
    for condition in trigger.iter_mut().flatten().flatten() {
        for measure in &mut condition.check.measures {
            if let Measure::State { element, .. } = measure {
                *element = all[*element].item(items, owner)?;
            }
        }
    }
    Ok(())
}

impl Reference {
    /// Returns the index of the element.
    fn item(&self, items: &[Item], owner: Option<usize>) -> Result<usize, ReadError> {
        let (element, found, kind) = (CONDITION.to_owned(), self.path.clone(), self.kind);
        let flaw = match item(items, kind, &self.path, owner) {
            Ok(index) => return Ok(index),
            Err(Some(two)) => {
                let candidates = two.map(|index| full_path(items, index));
                Flaw::Ambiguous { element, attribute: ELEMENT, found, kind, candidates }
            }
            Err(None) => {
                let names = of_kind(items, kind).map(|index| items[index].name.as_str());
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
pub(super) fn item(items: &[Item], kind: &str, path: &str, owner: Option<usize>) -> Result<usize, Option<[usize; 2]>> {
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
fn ancestry(items: &[Item], from: Option<usize>) -> impl Iterator<Item = usize> {
    std::iter::successors(from, |index| items[*index].parent)
}

fn of_kind<'i>(items: &'i [Item], kind: &'i str) -> impl Iterator<Item = usize> + 'i {
    (0..items.len()).filter(move |index| items[*index].kind.name() == kind)
}

fn is_named(items: &[Item], index: usize, path: &str) -> bool {
    let item = &items[index];
    if item.name == path {
        return true;
    }
    let around = path.strip_suffix(item.name.as_str()).and_then(|rest| rest.strip_suffix(SEPARATOR));
    around.is_some_and(|around| item.parent.is_some_and(|parent| is_named(items, parent, around)))
}

/// Returns the name of an element after the names of all elements around it.
pub(super) fn full_path(items: &[Item], index: usize) -> String {
    let name = &items[index].name;
    items[index].parent.map_or(name.clone(), |parent| within(&full_path(items, parent), name))
}

/// Returns the name of an element after the names of the elements around it, if there are any.
pub(super) fn within(around: &str, name: &str) -> String {
    if around.is_empty() { name.to_owned() } else { format!("{around}{SEPARATOR}{name}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::openscenario::story::Kind;

    /// Returns elements with these names and kinds, each within the element with the given index.
    fn items(all: &[(&str, Kind, Option<usize>)]) -> Vec<Item> {
        let item = |(name, kind, parent): &(&str, Kind, Option<usize>)| {
            let (name, kind, parent) = ((*name).to_owned(), kind.clone(), *parent);
            Item { name, kind, parent, start: None, stop: None, most_runs: 1 }
        };
        all.iter().map(item).collect()
    }

    #[test]
    fn a_name_refers_to_the_nearest_element_and_names_around_it_choose_another() {
        let all = items(&[
            ("story", Kind::Story, None),
            ("first", Kind::Act, Some(0)),
            ("group", Kind::Group, Some(1)),
            ("second", Kind::Act, Some(0)),
            ("group", Kind::Group, Some(3)),
            ("third", Kind::Act, Some(0)),
        ]);
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
