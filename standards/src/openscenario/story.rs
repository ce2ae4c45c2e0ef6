//! The storyboard of a scenario: initial actions, and stories of acts, maneuver groups, maneuvers, events and actions.

use super::action::Action;
use super::catalogs::Catalogs;
use super::condition::{Trigger, trigger};
use super::entity::Entity;
use super::environment::{Environment, Surroundings};
use super::measure::Measure;
use super::names::Names;
use super::position::Position;
use super::reference::{Named, References};
use super::scope::Node;
use super::site::Sites;
use super::taken::Taken;
use super::variable::{Change, Variable};
use crate::xml::{Flaw, ReadError};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The names of objects of the world that come before the entities, with what they are.
const BEFORE: [(&str, &str); 2] = [("car", "the ego vehicle"), ("storyboard", "the storyboard")];
/// The storyboard of a scenario, with the entities that act in it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Storyboard {
    pub entities: Vec<Entity>,
    pub variables: Vec<Variable>,
    /// The environment at the beginning.
    pub surroundings: Surroundings,
    /// The initial actions, each with its entity and its line in the file.
    pub init: Vec<(usize, Action, u32)>,
    /// All elements of all stories. An element comes before the elements within it.
    pub items: Vec<Item>,
    /// The trigger that ends the scenario; `None` if there is none.
    pub stop: Option<Trigger>,
}

/// An element of the storyboard.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Item {
    pub name: String,
    /// The path of the file and the line of the element.
    pub origin: (PathBuf, u32),
    pub kind: Kind,
    /// The index of the element that contains this one; `None` for a story.
    pub parent: Option<usize>,
    /// The trigger that starts the element; `None` if the element starts with its parent.
    pub start: Option<Trigger>,
    /// The trigger that stops the element; `None` if there is none.
    pub stop: Option<Trigger>,
    /// The number of times that the element runs at most.
    pub most_runs: u32,
}

/// The kind of an element of the storyboard.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    Story,
    Act,
    Group,
    Maneuver,
    Event(Priority),
    /// An action, with the entities that carry it out. Each entity has its own copy.
    Action(Vec<usize>, Action),
    /// A change of the variable with this index.
    Change(usize, Change),
    /// A change of the environment.
    Environment(Environment),
}

/// The effect of an event on the other running events of its maneuver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Priority {
    /// The event stops the other events.
    Override,
    /// The event does not start while another event runs.
    Skip,
    /// The event runs beside the other events.
    Parallel,
}

const PRIORITIES: [(&str, Priority); 4] = [
    ("override", Priority::Override),
    ("overwrite", Priority::Override),
    ("skip", Priority::Skip),
    ("parallel", Priority::Parallel),
];

impl Kind {
    /// Returns the name of the kind in conditions.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Story => "story",
            Self::Act => "act",
            Self::Group => "maneuverGroup",
            Self::Maneuver => "maneuver",
            Self::Event(_) => "event",
            Self::Action(..) | Self::Change(..) | Self::Environment(_) => "action",
        }
    }
}

/// The reader of a storyboard.
struct Reader<'a> {
    names: Names<'a>,
    items: Vec<Item>,
    /// The names of the elements within each element, and of the stories.
    taken: BTreeMap<Option<usize>, Taken>,
}

impl Storyboard {
    /// Reads the entities and the storyboard of a scenario on a map.
    pub fn read(root: Node<'_>, catalogs: &Catalogs<'_>, sites: Sites<'_>) -> Result<Self, ReadError> {
        let (entities, selections) = Entity::all(root.child("Entities")?, catalogs)?;
        let mut variables = Variable::all(root)?;
        let entity_names: Vec<_> = entities.iter().map(|entity| entity.name.clone()).collect();
        let variable_names: Vec<_> = variables.iter().map(|variable| variable.name.clone()).collect();
        let kinds: Vec<_> = variables.iter().map(|variable| variable.kind).collect();
        let declared = variables.len() - root.scope.names().count();
        let types: Vec<_> = entities.iter().map(Entity::object_type).collect();
        let references = References::default();
        let names = Names {
            entities: &entity_names,
            types: &types,
            selections: &selections,
            variables: &variable_names,
            kinds: &kinds,
            declared,
            catalogs,
            sites,
            references: &references,
        };
        let board = root.child("Storyboard")?;
        let mut init = Vec::new();
        let mut surroundings = Surroundings::default();
        let actions = board.child("Init")?.child("Actions")?;
        for actor in actions.elements() {
            match actor.name() {
                "Private" => {
                    let group = names.group(actor, "entityRef")?;
                    for node in actor.all("PrivateAction") {
                        let action = Action::private(node, names)?;
                        init.extend(group.iter().map(|entity| (*entity, action.clone(), node.element.line())));
                    }
                }
                "GlobalAction" => match global(actor, names)? {
                    Kind::Environment(change) => surroundings.change(&change, 0.0),
                    Kind::Change(variable, change) => {
                        variables[variable].change(&change).map_err(|misfit| actor.error(Flaw::Misfit(misfit)))?;
                    }
                    Kind::Action(group, action) => {
                        init.extend(group.iter().map(|entity| (*entity, action.clone(), actor.element.line())));
                    }
                    _ => (),
                },
                _ => return Err(actor.refused("use a Private or a GlobalAction")),
            }
        }
        let mut reader = Reader { names, items: Vec::new(), taken: BTreeMap::new() };
        for story in board.all("Story") {
            reader.story(story)?;
        }
        let mut items = reader.items;
        references.now_of(None);
        let stop = board.first("StopTrigger").map(|stop| trigger(stop, names)).transpose()?;
        let mut stop = stop.filter(|stop| !stop.is_empty());
        let elements = references.resolve(&names_of(&items))?;
        let triggers = items.iter_mut().flat_map(|item| [&mut item.start, &mut item.stop]).chain([&mut stop]);
        let conditions = triggers.flatten().flatten().flatten();
        for measure in conditions.flat_map(|condition| &mut condition.check.measures) {
            if let Measure::State { element, .. } = measure {
                *element = elements[*element];
            }
        }
        Ok(Self { surroundings, init, items, stop, entities, variables })
    }
}

impl Storyboard {
    /// Returns `true` if an initial action gives an entity a place.
    pub fn places(&self, entity: usize) -> bool {
        let puts = |action: &Action| matches!(action, Action::Teleport(_) | Action::Add(_) | Action::Trajectory(_));
        self.init.iter().any(|(of, action, _)| *of == entity && puts(action))
    }

    /// Returns the entities that are in the world from the beginning on although no initial action gives them a place.
    fn unplaced(&self) -> impl Iterator<Item = &Entity> {
        let is_added = |entity: usize| {
            let adds = |item: &Item| matches!(&item.kind, Kind::Action(of, Action::Add(_)) if of.contains(&entity));
            self.items.iter().any(adds)
        };
        let unplaced = (0..self.entities.len()).filter(move |entity| !self.places(*entity) && !is_added(*entity));
        unplaced.map(|entity| &self.entities[entity])
    }

    /// Describes entities whose place or whose signals may surprise.
    pub fn remarks(&self, file: &Path) -> Vec<String> {
        let file = file.display();
        let unplaced = self.unplaced().map(|Entity { name, line, .. }| {
            format!("{file}:{line}: `{name}` begins at the place (0, 0), because no initial action gives it a place")
        });
        let named = self.entities.iter().filter_map(|Entity { name, line, .. }| {
            let (_, other) = BEFORE.iter().find(|(taken, _)| taken == name)?;
            Some(format!(
                "{file}:{line}: the signals of the entity `{name}` are `{name}-2.*`, because `{name}` is {other}"
            ))
        });
        unplaced.chain(named).collect()
    }

    /// Returns `true` if the weather can change during a run.
    pub fn weather_changes(&self) -> bool {
        self.surroundings.moves() || self.items.iter().any(|item| matches!(item.kind, Kind::Environment(_)))
    }
}

/// Returns the names of elements, to which conditions refer.
pub(super) fn names_of(items: &[Item]) -> Vec<Named<'_>> {
    items.iter().map(|Item { name, kind, parent, .. }| Named { name, kind: kind.name(), parent: *parent }).collect()
}

/// Reads an action that concerns no entity.
fn global(node: Node<'_>, names: Names<'_>) -> Result<Kind, ReadError> {
    let kind = node.choice("a kind of action such as VariableAction")?;
    match kind.name() {
        "EnvironmentAction" => Environment::read(kind, names).map(Kind::Environment),
        "VariableAction" | "ParameterAction" => {
            Change::read(kind, names).map(|(variable, change)| Kind::Change(variable, change))
        }
        "EntityAction" => {
            let entity = names.entity(kind, "entityRef")?;
            let action = kind.choice("AddEntityAction or DeleteEntityAction")?;
            let action = match action.name() {
                "AddEntityAction" => Action::Add(Position::read(action.child("Position")?, names)?),
                _ => Action::Delete,
            };
            Ok(Kind::Action(vec![entity], action))
        }
        _ => Err(kind.refused("use a VariableAction, an EntityAction or an EnvironmentAction")),
    }
}

impl Reader<'_> {
    fn push(&mut self, node: Node<'_>, kind: Kind, parent: Option<usize>) -> Result<usize, ReadError> {
        let name = node.label()?.unwrap_or_default().into_owned();
        // The name of a maneuver may be that of the entry of a catalog.
        if !matches!(kind, Kind::Maneuver) {
            self.claim(node, "name", parent)?;
        }
        let most_runs = match node.element.text("maximumExecutionCount") {
            None => 1,
            Some(_) => node.positive_count("maximumExecutionCount")?,
        };
        self.names.references.now_of(Some(self.items.len()));
        let read = |name| node.first(name).map(|found| trigger(found, self.names)).transpose();
        let (start, stop) = (read("StartTrigger")?, read("StopTrigger")?);
        // Without conditions, an element starts at once, and nothing stops it.
        let start = start.filter(|start| !start.is_empty());
        let origin = (node.element.file().to_owned(), node.element.line());
        self.items.push(Item { name, origin, kind, parent, start, stop, most_runs });
        Ok(self.items.len() - 1)
    }

    /// Takes the name in an attribute of an element within the element `parent`. Conditions could not tell two elements with the same
    /// name there.
    fn claim(&mut self, node: Node<'_>, attribute: &'static str, parent: Option<usize>) -> Result<(), ReadError> {
        let Some(name) = node.text(attribute)? else { return Ok(()) };
        self.taken.entry(parent).or_default().claim_in(node, attribute, &name)
    }

    fn story(&mut self, node: Node<'_>) -> Result<(), ReadError> {
        self.names.catalogs.declaring(node, &[], |node| {
            let story = self.push(node, Kind::Story, None)?;
            for act in node.all("Act") {
                let index = self.push(act, Kind::Act, Some(story))?;
                for group in act.all("ManeuverGroup") {
                    self.group(group, index)?;
                }
            }
            Ok(())
        })
    }

    fn group(&mut self, node: Node<'_>, act: usize) -> Result<(), ReadError> {
        let group = self.push(node, Kind::Group, Some(act))?;
        let actors = node.child("Actors")?;
        let actors = actors.all("EntityRef").map(|actor| self.names.group(actor, "entityRef"));
        let actors = actors.collect::<Result<Vec<_>, _>>()?.concat();
        let catalogs = self.names.catalogs;
        for maneuver in node.elements().filter(|node| ["Maneuver", "CatalogReference"].contains(&node.name())) {
            let attribute = if maneuver.name() == "Maneuver" { "name" } else { "entryName" };
            self.claim(maneuver, attribute, Some(group))?;
            catalogs.resolved(maneuver, &["Maneuver"], |node| self.maneuver(node, group, &actors))?;
        }
        Ok(())
    }

    fn maneuver(&mut self, node: Node<'_>, group: usize, actors: &[usize]) -> Result<(), ReadError> {
        let maneuver = self.push(node, Kind::Maneuver, Some(group))?;
        for event in node.all("Event") {
            let priority = event.one_of("priority", &PRIORITIES)?;
            let index = self.push(event, Kind::Event(priority), Some(maneuver))?;
            for action in event.all("Action") {
                let inner = action.choice("PrivateAction or GlobalAction")?;
                let kind = match inner.name() {
                    "PrivateAction" => Kind::Action(actors.to_vec(), Action::private(inner, self.names)?),
                    "GlobalAction" => global(inner, self.names)?,
                    _ => return Err(inner.refused("use a PrivateAction or a GlobalAction")),
                };
                self.push(action, kind, Some(index))?;
            }
        }
        Ok(())
    }
}
