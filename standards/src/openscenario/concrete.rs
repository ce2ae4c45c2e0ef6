//! A scenario of a file with the values of one test, as one file that other simulators play.
//!
//! The text of the scenario stays as it is, with its comments. Parameters get the values of the test, expressions get their
//! values, and the entries of catalogs stand where the scenario refers to them. So the file needs only its roads.

use super::catalogs::Catalogs;
use super::local::{declarations, declare};
use super::parameters::EGO;
use super::program::{ROOT, Xosc};
use super::reference::{CONDITION, ELEMENT, within};
use super::scope::{Node, Scope};
use super::site::Sites;
use super::story::Storyboard;
use super::unique::Renamed;
use super::version::Version;
use crate::opendrive::Map;
use crate::xml::{Edits, Element, ReadError, escaped};
use paracosm_space::Values;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A scenario of a file with the values of one test.
#[derive(Debug, Clone, PartialEq)]
pub struct Concrete {
    /// The text of the scenario.
    pub scenario: String,
    /// The text of the file of its roads.
    pub roads: Arc<str>,
    /// The name of the entity that the system under test drives. It has a controller, which the scenario activates.
    pub ego: String,
    /// The parts of the scenario that are left out, and the references that no catalog resolves.
    pub notes: Vec<String>,
}

/// The elements that can refer to an entry of a catalog, with the elements that the entry can be.
const REFERRING: [(&str, &[&str]); 9] = [
    ("ScenarioObject", &["Vehicle", "Pedestrian", "MiscObject"]),
    ("ObjectController", &["Controller"]),
    ("AssignControllerAction", &["Controller"]),
    ("ManeuverGroup", &["Maneuver"]),
    ("AssignRouteAction", &["Route"]),
    ("RouteRef", &["Route"]),
    ("FollowTrajectoryAction", &["Trajectory"]),
    ("TrajectoryRef", &["Trajectory"]),
    ("EnvironmentAction", &["Environment"]),
];
/// The elements of a storyboard, and their kinds in conditions.
const KINDS: [(&str, &str); 6] = [
    ("Story", "story"),
    ("Act", "act"),
    ("ManeuverGroup", "maneuverGroup"),
    ("Maneuver", "maneuver"),
    ("Event", "event"),
    ("Action", "action"),
];
/// The greatest number of entries of catalogs within each other. In the standard, an entry refers to an entry without references.
const DEEPEST: usize = 8;
/// A controller about which the scenario says nothing: that of the other simulator.
const CONTROLLER: &str =
    "<ObjectController><Controller name=\"system under test\"><Properties/></Controller></ObjectController>";
const ACTIVATION: &str = "<ActivateControllerAction lateral=\"true\" longitudinal=\"true\"/>";

impl Xosc {
    /// Returns the scenario with the values of a test. `roads` is the path of the file of the roads from the folder of the
    /// scenario.
    ///
    /// # Errors
    /// The scenario cannot be read with these values.
    pub fn concrete(&self, test: &Values, roads: &str) -> Result<Concrete, ReadError> {
        self.valued(test, |valued| valued.written(roads))
    }

    /// Reads the scenario with the values of a test, and calls a function with it.
    pub(super) fn valued<T>(
        &self,
        test: &Values,
        then: impl FnOnce(Valued<'_>) -> Result<T, ReadError>,
    ) -> Result<T, ReadError> {
        let root = self.document.root(ROOT)?;
        let catalogs = &self.catalogs.catalogs()?;
        let scope = self.parameters.values(Node { element: root, scope: &Scope::default() }, test)?;
        let root = Node { element: root, scope: &scope };
        let map = self.roads_in(root.child("RoadNetwork")?.child("LogicFile")?)?.map;
        let board = Storyboard::read(root, catalogs, Sites { map: &map, with_test: true })?;
        let chosen = test.get(EGO).map(ToString::to_string);
        let chosen = chosen.and_then(|name| board.entities.iter().position(|entity| entity.name == name));
        let ego = chosen.unwrap_or_else(|| board.usual_ego());
        then(Valued { root, catalogs, map, board, ego })
    }
}

/// A scenario with the values of a test.
pub(super) struct Valued<'v> {
    pub root: Node<'v>,
    pub catalogs: &'v Catalogs<'v>,
    pub map: Arc<Map>,
    pub board: Storyboard,
    /// The index of the ego vehicle.
    pub ego: usize,
}

impl Valued<'_> {
    fn written(self, roads: &str) -> Result<Concrete, ReadError> {
        let Self { root, catalogs, map, board, ego } = self;
        let is_activated = board.activates(ego);
        let ego = board.entities[ego].name.clone();
        let renamed = Renamed::of(&board);
        let notes = renamed.notes().collect();
        let version = Version::usual();
        let mut writing = Writing { catalogs, roads, ego: &ego, renamed: &renamed, depth: 0, version, notes };
        let mut edits = writing.edits(root.element, root.scope, "", &[])?;
        edits.set(root.child("FileHeader")?.element, "revMinor", &writing.version.minor().to_string());
        if !is_activated {
            let ego = escaped(&ego);
            edits.append(
                root.child("Storyboard")?.child("Init")?.child("Actions")?.element,
                &format!(
                    "<Private entityRef=\"{ego}\"><PrivateAction><ControllerAction>{ACTIVATION}</ControllerAction></PrivateAction></Private>"
                ),
            );
        }
        let (scenario, notes) = (edits.finish_file(), writing.notes);
        Ok(Concrete { scenario, roads: map.text.clone(), ego, notes })
    }
}

/// The writing of a scenario.
struct Writing<'w> {
    catalogs: &'w Catalogs<'w>,
    /// The path of the file of the roads.
    roads: &'w str,
    /// The name of the ego vehicle.
    ego: &'w str,
    renamed: &'w Renamed<'w>,
    /// The number of entries of catalogs around the present element.
    depth: usize,
    version: Version,
    notes: Vec<String>,
}

impl Writing<'_> {
    /// Returns the changes of the text of an element: the scenario, or the entry of a catalog with the values that a reference
    /// assigns. `around` has the names of the elements of the storyboard around the element.
    fn edits<'a>(
        &mut self,
        root: Element<'a, 'a>,
        scope: &Scope,
        around: &str,
        assignments: &[Node<'_>],
    ) -> Result<Edits<'a>, ReadError> {
        let mut edits = Edits::new(root);
        // A stack of our own: a file may nest elements deeply.
        let mut open = vec![(root, Arc::new(scope.clone()), Arc::<str>::from(around))];
        while let Some((element, mut scope, around)) = open.pop() {
            self.version.hold(element)?;
            // The parameters of the whole scenario are in the scope already.
            if declarations(element).next().is_some() && element.name() != ROOT {
                let given = if element == root { assignments } else { &[] };
                declare(element, Arc::make_mut(&mut scope), given)?;
            }
            for declaration in declarations(element) {
                // A later parameter hides an earlier one with its name, and all values are written.
                let same = |other: &Element<'_, '_>| other.text("name") == declaration.text("name");
                if declarations(element).filter(same).last() != Some(declaration) {
                    edits.replace(declaration, String::new());
                    continue;
                }
                let value = declaration.text("name").and_then(|name| scope.get(name));
                edits.set(declaration, "value", value.unwrap_or_default());
                open.extend(declaration.elements().map(|group| (group, scope.clone(), around.clone())));
            }
            let expressions = element.attributes().filter_map(|name| Some((name, element.text(name)?)));
            for (name, text) in expressions.filter(|(_, text)| text.starts_with("${")) {
                // An expression that has no value here stands where nothing reads it, such as in the name of a condition. The checker
                // of ASAM wants sound expressions everywhere, so the signs of an expression are left out.
                let plain = || text.replace(['$', '{', '}'], "").into();
                edits.set(element, name, &scope.resolve(text).unwrap_or_else(|_| plain()));
            }
            self.tell_properties_apart(element, &mut edits);
            let node = Node { element, scope: &scope };
            let is_ego = element.name() == "ScenarioObject" && node.text("name")?.as_deref() == Some(self.ego);
            if is_ego && element.first("ObjectController").is_none() {
                edits.append(element, CONTROLLER);
            }
            let around = self.rename(node, &mut edits, element, around)?;
            for child in element.elements().filter(|child| child.name() != "ParameterDeclarations") {
                match self.instead(element, Node { element: child, scope: &scope }, &around)? {
                    Some(text) => edits.replace(child, text),
                    None => open.push((child, scope.clone(), around.clone())),
                }
            }
        }
        Ok(edits)
    }

    /// Gives the second and further properties of a name other names: the checker of ASAM wants different names (rule
    /// `reference_control.unique_element_names_on_same_level`).
    fn tell_properties_apart<'a>(&mut self, element: Element<'a, 'a>, edits: &mut Edits<'a>) {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for property in element.all("Property") {
            let Some(name) = property.text("name") else { continue };
            let count = counts.entry(name).or_default();
            *count += 1;
            if *count > 1 {
                let new = format!("{name} {count}");
                let (file, line) = (property.file().display(), property.line());
                self.notes.push(format!(
                    "{file}:{line}: the property `{name}` is called `{new}`, because another one has its name"
                ));
                edits.set(property, "name", &new);
            }
        }
    }

    /// Writes the new name of an element of the storyboard, or of the element to which a condition refers. Returns the names of the
    /// elements of the storyboard around the elements within.
    fn rename<'a>(
        &self,
        node: Node<'_>,
        edits: &mut Edits<'a>,
        element: Element<'a, 'a>,
        around: Arc<str>,
    ) -> Result<Arc<str>, ReadError> {
        if node.name() == CONDITION {
            let (kind, path) = (node.required("storyboardElementType")?, node.required(ELEMENT)?);
            if let Some(name) = self.renamed.reference(&kind, &path, &around).filter(|name| *name != path) {
                edits.set(element, ELEMENT, name);
            }
        }
        let Some((_, kind)) = KINDS.iter().find(|(name, _)| *name == node.name()) else { return Ok(around) };
        let name = node.text("name")?.unwrap_or_default();
        let path = within(&around, &name);
        if let Some(new) = self.renamed.name(kind, &path) {
            edits.set(element, "name", new);
        }
        Ok(path.into())
    }

    /// Returns the text that replaces an element; `None` if the element stays.
    fn instead(&mut self, parent: Element<'_, '_>, child: Node<'_>, around: &str) -> Result<Option<String>, ReadError> {
        let note = |says: &str| format!("{}:{}: {says}", child.element.file().display(), child.element.line());
        Ok(match child.name() {
            "LogicFile" => Some(format!("<LogicFile filepath=\"{}\"/>", escaped(self.roads))),
            "SceneGraphFile" => {
                self.notes.push(note("`SceneGraphFile` is left out, because models of looks are not exported"));
                Some(String::new())
            }
            "CatalogLocations" => Some("<CatalogLocations/>".to_owned()),
            "CatalogReference" => {
                let kinds =
                    REFERRING.iter().find(|(name, _)| *name == parent.name()).map_or(&[][..], |(_, kinds)| *kinds);
                let entry = if self.depth < DEEPEST { self.catalogs.entry(child, kinds)? } else { None };
                let Some(entry) = entry else {
                    self.notes.push(note("no catalog has the entry of this `CatalogReference`, which stays as it is"));
                    return Ok(None);
                };
                let given: Vec<_> = child.first("ParameterAssignments").into_iter().flat_map(Node::elements).collect();
                self.depth += 1;
                let text = self.edits(entry, child.scope, around, &given)?.finish();
                self.depth -= 1;
                Some(text)
            }
            _ => None,
        })
    }
}
