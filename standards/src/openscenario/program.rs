//! A scenario of a file as a program: the same world, streams and signals as those of any other program.

use super::catalogs::{CatalogFiles, Found};
use super::constraints::{constraint, of_scenario};
use super::director::direct;
use super::distribution::Distribution;
use super::elements::schema;
use super::entity::Entity;
use super::linked;
use super::local::Local;
use super::measure::Measure;
use super::parameters::{DURATION, EGO, Parameters, declared_kinds, declared_values};
use super::play::{Stage, check_goals};
use super::scope::{Node, Scope};
use super::site::Sites;
use super::story::Storyboard;
use super::version;
use super::weather;
use crate::opendrive::{Map, Thing};
use crate::xml::{Document, Flaw, NoEffect, ReadError};
use paracosm_engine::object::{Geometric, InputError, Output, Outputs, Tick};
use paracosm_engine::road::{Path, RoadNetwork};
use paracosm_engine::vehicle::Vehicle;
use paracosm_engine::{AutonomousVehicle, Constraint, Declared, FilesRead, Lead, Monitor, Pose, Program, Scenario};
use paracosm_space::{Domain, Parameter, Values};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path as FilePath, PathBuf};
use std::rc::Rc;
use std::sync::{Arc, Mutex, PoisonError};
use xxhash_rust::xxh3::Xxh3;

/// The usual duration in seconds of a run whose stop trigger does not come.
const USUAL: f64 = 40.0;
/// The seconds that a scenario goes on after the latest time in its stop trigger.
const BEYOND: f64 = 1.0;
/// The greatest duration in seconds of a run: a day.
const LATEST: f64 = 86_400.0;
/// The duration of a tick in seconds.
pub(super) const TICK: f64 = 0.01;
/// The distance in metres for which the way of the ego vehicle goes on beyond its lane.
const ONWARD: f64 = 5000.0;
/// The outermost element of a file.
pub(super) const ROOT: &str = "OpenSCENARIO";

/// A scenario of a file, with its catalogs, its roads, and the distribution of its parameters.
pub struct Xosc {
    name: String,
    folder: PathBuf,
    pub(super) document: Document,
    pub(super) catalogs: CatalogFiles,
    pub(super) parameters: Parameters,
    /// The constraints that the declarations of the parameters state.
    constraints: Vec<Constraint>,
    /// The remarks on the file and on the file of the distribution.
    notes: Vec<String>,
    /// The roads that were read, by the names of their files in the scenario.
    roads: Mutex<BTreeMap<String, Roads>>,
}

/// A map, its road network, and the bodies of its objects and signals.
#[derive(Clone)]
pub(super) struct Roads {
    file: PathBuf,
    pub map: Arc<Map>,
    network: Arc<RoadNetwork>,
    things: Arc<[Thing]>,
    /// The remarks on the file of the map.
    notes: Arc<[String]>,
}

/// The contents of a file with the values of one test.
struct Read {
    board: Storyboard,
    roads: Roads,
    /// The constraints that parts of the scenario state.
    constraints: Vec<Constraint>,
    found: Found,
}

/// An entity as an object of the world, which the storyboard moves.
struct Shown {
    stage: Rc<RefCell<Stage>>,
    index: usize,
    has_body: bool,
    x: Output<f64>,
    y: Output<f64>,
    heading: Output<f64>,
    speed: Output<f64>,
}

impl Xosc {
    /// Reads a scenario, its catalogs and its roads. The file may be that of a distribution of parameters, which names the file
    /// of its scenario.
    ///
    /// # Errors
    /// A file cannot be read, is not valid, or has an element that is not supported.
    pub fn read(file: &FilePath) -> Result<Self, ReadError> {
        let name = file.to_string_lossy().into_owned();
        let document = Document::open(file)?;
        let folder = folder_of(file);
        let none = Scope::default();
        let named = {
            let root = Node { element: document.root(ROOT)?, scope: &none };
            let distribution = root.first("ParameterValueDistribution");
            let named = |node: Node<'_>| {
                version::check(root.element)?;
                let notes = in_file(&schema().check(root.element)?, file);
                let file = linked::file(node.child("ScenarioFile")?, "filepath", &folder)?;
                let scenario = Document::open(&file)?;
                let distribution = {
                    let root = Node { element: scenario.root(ROOT)?, scope: &none };
                    // A distribution may name the file of another distribution, or its own file, by mistake.
                    root.child("Storyboard")?;
                    let declared = declared_kinds(root)?;
                    Distribution::read(node, &declared)?
                };
                Ok((scenario, folder_of(&file), distribution, notes))
            };
            distribution.map(named).transpose()?
        };
        match named {
            None => Self::of(name, document, folder, (Distribution::default(), Vec::new())),
            Some((scenario, folder, distribution, notes)) => Self::of(name, scenario, folder, (distribution, notes)),
        }
    }

    fn of(
        name: String,
        document: Document,
        folder: PathBuf,
        (distribution, mut notes): (Distribution, Vec<String>),
    ) -> Result<Self, ReadError> {
        let (catalogs, parameters) = {
            let root = document.root(ROOT)?;
            version::check(root)?;
            notes.extend(in_file(&schema().check(root)?, root.file()));
            let none = Scope::default();
            let parameters = Parameters::read(Node { element: root, scope: &none }, distribution)?;
            let scope = declared_values(Node { element: root, scope: &none })?;
            let root = Node { element: root, scope: &scope };
            (CatalogFiles::read(root.first("CatalogLocations"), &folder)?, parameters)
        };
        notes.extend(catalogs.notes());
        let constraints = of_scenario(&parameters)?;
        let read = Self { name, folder, document, catalogs, parameters, constraints, notes, roads: Mutex::default() };
        read.board(&mut declared_values, false)?;
        Ok(read)
    }

    /// Makes the program of the scenario. Its name is the path of the file.
    pub fn program(self) -> Program {
        let scenario = Arc::new(self);
        let (name, chosen_by) = (scenario.name.clone(), scenario.roads_chosen_by());
        let reads = scenario.clone();
        Program::of(name, "a scenario of a file", move |s| scenario.build(s))
            .of_files(chosen_by, move |test| Some(reads.files_read(test)))
    }

    /// Returns the names of the parameters of tests that choose the file of the roads.
    fn roads_chosen_by(&self) -> Vec<String> {
        let logic = self.document.root(ROOT).and_then(|root| root.child("RoadNetwork")?.child("LogicFile"));
        let named = logic.and_then(|logic| Ok(self.parameters.behind(logic.required("filepath")?)));
        named.unwrap_or_default()
    }

    /// Returns the paths and the 128-bit XXH3 of the scenario, its catalogs, and the roads of a test. Roads that cannot be read make the test
    /// invalid.
    fn files_read(&self, test: &Values) -> FilesRead {
        let roads = self.roads_of(test).ok();
        let mut paths = vec![PathBuf::from(&self.name), self.document.file().to_owned()];
        paths.extend(self.catalogs.files().map(FilePath::to_owned));
        paths.extend(roads.iter().map(|roads| roads.file.clone()));
        let mut hash = Xxh3::new();
        let map = roads.iter().map(|roads| &*roads.map.text);
        for text in [self.document.text()].into_iter().chain(self.catalogs.texts()).chain(map) {
            hash.update(&(text.len() as u64).to_le_bytes());
            hash.update(text.as_bytes());
        }
        FilesRead { hash: format!("{:032x}", hash.digest128()), paths }
    }

    fn roads_of(&self, test: &Values) -> Result<Roads, ReadError> {
        let none = Scope::default();
        let root = Node { element: self.document.root(ROOT)?, scope: &none };
        let scope = self.parameters.values(root, test)?;
        self.roads_in(Node { scope: &scope, ..root }.child("RoadNetwork")?.child("LogicFile")?)
    }

    fn build(&self, s: &mut Scenario) {
        let Read { board, roads, constraints, found } =
            match self.board(&mut |root| self.parameters.declared(root, s), true) {
                Ok(read) => read,
                Err(error) => return s.refuse(&error.to_string()),
            };
        s.note(|| [&self.notes, &board.remarks(self.document.file()), &found.notes(), &roads.notes[..]].concat());
        for constraint in self.constraints.iter().cloned().chain(constraints) {
            s.constrain(constraint);
        }
        let usual = board.entities[board.usual_ego()].name.clone();
        let names = board.entities.iter().map(|entity| entity.name.as_str().into()).collect();
        let mut parameter = Parameter::new(EGO, Domain::Choice(names));
        parameter.default = Some(usual.as_str().into());
        let chosen = s.parameter(Declared { open: false, ..Declared::open(parameter) }).value();
        let ego = board.entities.iter().position(|entity| chosen == entity.name.as_str().into()).unwrap_or_default();
        s.note(|| board.handover_remarks(ego, self.document.file()));
        if !board.places(ego) {
            let Entity { name, line, .. } = &board.entities[ego];
            return s.refuse(&format!(
                "{}:{line}: the ego vehicle `{name}` has no place at the beginning, expected a TeleportAction of `{name}` in Init",
                self.document.file().display()
            ));
        }
        if let Err(nowhere) = check_goals(&board, &roads.map) {
            return s.refuse(&nowhere.to_string());
        }
        let mut parameter = Parameter::new(DURATION, Domain::Interval { lo: TICK, hi: LATEST });
        (parameter.default, parameter.unit) = (Some(USUAL.into()), Some("s".to_owned()));
        let least = s.parameter(Declared { open: false, ..Declared::open(parameter) }).value();
        let longest = longest(&board, least.number().unwrap_or(USUAL));
        let lead = Lead::new();
        let conditions: Vec<_> = Stage::conditions(&board).cloned().collect();
        let has_stop = board.stop.is_some();
        let weather_changes = board.weather_changes();
        let drawn = s.sketch().is_some().then(|| board.clone());
        let stage = match Stage::new(board, roads.map.clone(), ego, lead.clone()) {
            Ok(stage) => Rc::new(RefCell::new(stage)),
            Err(misplaced) => return s.refuse(&format!("{}:{misplaced}", self.document.file().display())),
        };
        s.place(roads.network.clone());
        let car = s.place(car(&stage.borrow(), ego, &roads.network).led_by(&lead));
        let end = direct(s, &stage, &conditions, drawn.as_ref());
        weather::place(s, &stage, weather_changes);
        let count = stage.borrow().cast.actors.len();
        for index in 0..count {
            self.show(s, &stage, index, index != ego);
        }
        // After the entities, whose signals have the names of the file.
        for thing in roads.things.iter() {
            s.place(*thing);
        }
        s.duration(longest);
        s.end(&end);
        if has_stop {
            s.premise(&end);
        }
        s.monitor(Monitor::no_collision(&car));
    }

    fn show(&self, s: &mut Scenario, stage: &Rc<RefCell<Stage>>, index: usize, has_body: bool) {
        let actor = stage.borrow().cast.actors[index].clone();
        let mut draft = s.object(&actor.entity.name);
        if has_body {
            draft.body(actor.entity.body, actor.middle());
        }
        let shown = Shown {
            stage: stage.clone(),
            index,
            has_body,
            x: draft.signal("x"),
            y: draft.signal("y"),
            heading: draft.signal("heading"),
            speed: draft.signal("speed"),
        };
        draft.geometric(shown);
    }

    /// Reads the storyboard and the roads, with the values of parameters that `values` gives. `with_test` is `true` if these are the
    /// values of a test.
    fn board(
        &self,
        values: &mut dyn FnMut(Node<'_>) -> Result<Scope, ReadError>,
        with_test: bool,
    ) -> Result<Read, ReadError> {
        let root = self.document.root(ROOT)?;
        let catalogs = self.catalogs.catalogs()?;
        let scope = values(Node { element: root, scope: &Scope::default() })?;
        let root = Node { element: root, scope: &scope };
        let logic = root.child("RoadNetwork")?.child("LogicFile")?;
        let roads = self.roads_in(logic)?;
        let board = Storyboard::read(root, &catalogs, Sites { map: &roads.map, with_test })?;
        let found = catalogs.found();
        let stated = |local: &Local| constraint(&self.parameters, &local.scope, local.scope.len() - 1, &local.demand);
        let constraints =
            found.locals.iter().filter_map(|local| stated(local).transpose()).collect::<Result<_, _>>()?;
        Ok(Read { board, roads, constraints, found })
    }

    /// Returns the roads of the file that an element names, which is read once.
    pub(super) fn roads_in(&self, logic: Node<'_>) -> Result<Roads, ReadError> {
        let named = logic.required("filepath")?;
        let mut known = self.roads.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(roads) = known.get(named.as_ref()) {
            return Ok(roads.clone());
        }
        let file = linked::file(logic, "filepath", &self.folder)?;
        let map = Map::read(&file)?;
        let network = map.network().map_err(|error| logic.error(Flaw::Roads(error)))?;
        let notes = map.notes.iter().map(|note| note.in_file(&file)).collect();
        let roads = Roads { file, things: Thing::all(&map, &network), map: Arc::new(map), network, notes };
        known.insert(named.into_owned(), roads.clone());
        Ok(roads)
    }
}

/// Describes parts of a file that have no effect.
fn in_file(parts: &[NoEffect], file: &FilePath) -> Vec<String> {
    parts.iter().map(|part| part.in_file(file)).collect()
}

fn folder_of(file: &FilePath) -> PathBuf {
    file.parent().unwrap_or(FilePath::new(".")).to_owned()
}

/// Returns the duration in seconds of a run in which the stop trigger does not come: `least` and the delay of the trigger, or more if a
/// trigger at a time needs more.
fn longest(board: &Storyboard, least: f64) -> f64 {
    let conditions = board.stop.iter().flatten().flatten();
    let needed = conditions.map(|condition| {
        let at = if condition.check.measures == [Measure::Time] { condition.check.value + BEYOND } else { least };
        (at + condition.delay).max(least)
    });
    needed.fold(least, f64::max).min(LATEST)
}

/// Returns the ego vehicle, with the way along its lane and straight on.
fn car(stage: &Stage, ego: usize, network: &Arc<RoadNetwork>) -> AutonomousVehicle {
    let actor = &stage.cast.actors[ego];
    let Pose { position, heading } = actor.middle();
    let pose = Pose { position, heading };
    let seen = network.project_along(&pose);
    let way = seen.map(|seen| (network.path(&network.onward(seen.lane, ONWARD)), seen.s));
    let car = match way {
        Some((way, at)) => AutonomousVehicle::along(way).starting(at),
        None => AutonomousVehicle::along(Path::straight(position, position + pose.forward())),
    };
    let half = actor.entity.half;
    let vehicle = Vehicle { length: 2.0 * half.x, width: 2.0 * half.y, ..Vehicle::BMW_320I };
    let vehicle = if vehicle.flaw().is_none() { vehicle } else { Vehicle::BMW_320I };
    car.vehicle(vehicle).speed(actor.speed.clamp(0.0, vehicle.max_speed))
}

impl Geometric for Shown {
    fn poses(&self, poses: &mut [Option<Pose>]) {
        if self.has_body {
            let actor = &self.stage.borrow().cast.actors[self.index];
            poses[0] = actor.present.then(|| actor.middle());
        }
    }

    fn begin(&mut self, _: &Tick<'_>, velocities: &mut [nalgebra::Vector2<f64>]) -> Result<(), InputError> {
        if let Some(velocity) = velocities.first_mut() {
            let actor = &self.stage.borrow().cast.actors[self.index];
            *velocity = actor.pose.forward() * actor.speed;
        }
        Ok(())
    }

    fn show(&self, outputs: &mut Outputs<'_>) {
        let stage = self.stage.borrow();
        let actor = &stage.cast.actors[self.index];
        outputs.set(&self.x, actor.pose.position.x);
        outputs.set(&self.y, actor.pose.position.y);
        outputs.set(&self.heading, actor.pose.heading);
        outputs.set(&self.speed, actor.speed);
    }
}
