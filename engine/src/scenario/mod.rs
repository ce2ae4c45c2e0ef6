//! The builder that a program writes its world into.
//!
//! A scenario is a function from a test to a world: it asks for its parameters by name, places objects, binds their
//! inputs to streams, and states requirements. Mistakes in it (a lane that the road does not have, two ego vehicles)
//! are collected and reported when the function has returned, so programs need no `?` on every line.

mod constraint;
mod declaring;
mod draft;
mod ego;
mod environment;
mod operators;
mod param;
mod reach;
mod requirement;
mod road;

pub use constraint::Constraint;
pub use draft::ObjectDraft;
pub use ego::{AutonomousVehicle, Car, Lead, LedMotion};
pub(crate) use ego::{Ego, EgoSetup};
pub use environment::{Conditions, Environment};
pub use param::Param;
pub use reach::Reach;
pub use requirement::{RequirementDraft, Temporal, always, eventually, never};
pub use road::{Road, Streets};

use crate::flaw::{Flaws, WorldFlaw};
use crate::object::{ObjectSetup, Wiring};
use crate::road::RoadNetwork;
use crate::stream::{Datum, Effect, Equation, Forward, Graph, Node, NodeKind, Sketch, Slot, Source, Stream, dot};
use crate::test::{Declared, Test};
use crate::weather::WeatherPart;
use paracosm_space::{Shape, Value};
use param::Keys;
use std::cell::{Cell, Ref, RefCell};
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// The default duration of a tick in seconds.
pub const DEFAULT_DT: f64 = 0.01;

/// Returns the number of ticks of `dt` seconds in a duration, rounded.
pub(crate) fn ticks(duration: f64, dt: f64) -> usize {
    (duration / dt).round() as usize
}

/// A world under construction, for a test, or for the list of the parameters and requirements of a program.
pub struct Scenario {
    /// The test's values of parameters, by name; empty if the program is only asked for its parameters.
    given: Vec<(String, param::Given)>,
    pub(crate) keys: Rc<Keys>,
    pub(crate) parameters: Rc<RefCell<Vec<Declared>>>,
    /// The uses of the parameters by the program, in the order of the declaration.
    uses: Rc<RefCell<Vec<reach::Use>>>,
    pub(crate) constraints: Vec<Constraint>,
    pub(crate) flaws: Flaws,
    /// The reason why the program failed, if it failed.
    pub(crate) failure: Option<String>,
    /// The networks that were placed; `None` for a network that cannot be built.
    pub(crate) networks: Vec<Option<Arc<RoadNetwork>>>,
    pub(crate) cars: Vec<EgoSetup>,
    pub(crate) objects: Vec<ObjectSetup>,
    /// The objects that only sensors and the physics know of.
    pub(crate) scenery: Vec<ObjectSetup>,
    pub(crate) wiring: Wiring,
    /// The outputs that every trace records, by name.
    pub(crate) signals: Vec<(String, Source)>,
    pub(crate) conditions: Conditions,
    /// The conditions that the program has defined.
    said: Said,
    /// The number of requests for each name by programs. Only looked up, so the order of the names does not matter.
    names: HashMap<String, usize>,
    pub(crate) requirements: Rc<RefCell<Vec<requirement::Stated>>>,
    pub(crate) premise: Option<Stream<bool>>,
    pub(crate) end: Option<Stream<bool>>,
    /// The remarks of the program; `None` if nobody wants them.
    pub(crate) notes: Option<Vec<String>>,
    /// The drawing of what objects do; `None` if nobody wants it.
    pub(crate) sketch: Option<Sketch>,
    pub(crate) duration: f64,
    pub(crate) dt: f64,
    effects: Vec<Rc<Node>>,
    equations: Rc<RefCell<Vec<Equation>>>,
    /// The graph of all streams that are read, laid out once the program has returned.
    pub(crate) graph: Graph,
}

/// The parts of the [`Conditions`] that a program has defined.
#[derive(Debug, Clone, Copy, Default)]
struct Said {
    friction: bool,
    weather: bool,
    rain: bool,
    sun: bool,
}

/// An object that can be placed in a world, such as a road, a car or a pedestrian.
pub trait Place {
    /// The type of the handle by which a program refers to the placed object.
    type Handle;

    /// Adds the object to the world and returns the object's handle.
    fn place(self, scenario: &mut Scenario) -> Self::Handle;
}

impl Place for Effect {
    type Handle = ();

    fn place(self, scenario: &mut Scenario) {
        scenario.effects.push(self.0);
    }
}

/// A scenario without a test and without objects. An interpreter that needs a scenario of its own takes the scenario of a program by
/// [`std::mem::take`], and gives it back before the program returns.
impl Default for Scenario {
    fn default() -> Self {
        Self::new(None)
    }
}

impl Scenario {
    pub(crate) fn new(test: Option<&Test>) -> Self {
        let given = |(name, value): (&str, &Value)| {
            let signal = test.and_then(|test| test.signal(name));
            (name.to_owned(), param::Given { value: Some(value.clone()), signal })
        };
        let key = test.map_or(0, Test::key);
        Self {
            given: test.map(|test| test.values.iter().map(given).collect()).unwrap_or_default(),
            keys: Rc::new(Keys { test: Cell::new(key), scenery: Cell::new(key) }),
            parameters: Rc::default(),
            uses: Rc::default(),
            constraints: Vec::new(),
            flaws: Rc::default(),
            failure: None,
            networks: Vec::new(),
            cars: Vec::new(),
            objects: Vec::new(),
            scenery: Vec::new(),
            wiring: Wiring::default(),
            signals: Vec::new(),
            conditions: Conditions::default(),
            said: Said::default(),
            names: HashMap::new(),
            requirements: Rc::default(),
            premise: None,
            end: None,
            notes: None,
            sketch: None,
            duration: 10.0,
            dt: DEFAULT_DT,
            effects: Vec::new(),
            equations: Rc::default(),
            graph: Graph::default(),
        }
    }

    /// Returns the shape of a signal with one value for each tick, and thus one coordinate for each tick. Set the
    /// [duration](Scenario::duration) and the [tick](Scenario::tick) before you call this.
    pub fn per_tick(&self) -> Shape {
        Shape::PiecewiseConstant { pieces: ticks(self.duration, self.dt) }
    }

    /// Announces a stream that is read before it can be defined. Such a feedback has to go through a [`Stream::pre`].
    ///
    /// ```
    /// # use paracosm_engine::{Scenario, Stream};
    /// fn count(s: &mut Scenario, event: &Stream<bool>) -> Stream<f64> {
    ///     let count = s.forward("count");
    ///     let before = count.pre().initially(0.0);
    ///     count.define((&before + 1.0).when(event).merge(&before));
    ///     count.clone()
    /// }
    /// ```
    pub fn forward<T: Datum>(&mut self, name: &str) -> Forward<T> {
        let mut equations = self.equations.borrow_mut();
        let equation = equations.len();
        equations.push(Equation { name: name.to_owned(), definition: None, is_defined_twice: false });
        Forward {
            stream: Stream::new(NodeKind::Forward { equation, name: name.to_owned() }, []),
            equation,
            equations: self.equations.clone(),
        }
    }

    /// Adds an object to the world and returns the handle by which the program refers to it.
    pub fn place<P: Place>(&mut self, object: P) -> P::Handle {
        object.place(self)
    }

    /// Begins the construction of an object that the program defines; a second object `name` is called `name-2`.
    pub fn object(&mut self, name: &str) -> ObjectDraft<'_> {
        let count = self.names.entry(name.to_owned()).and_modify(|count| *count += 1).or_insert(1);
        let name = if *count == 1 { name.to_owned() } else { format!("{name}-{count}") };
        ObjectDraft::new(self, name)
    }

    fn say_friction(&mut self, friction: Stream<f64>) {
        if std::mem::replace(&mut self.said.friction, true) {
            self.flaw(WorldFlaw::FrictionTwice);
        }
        self.conditions.friction = if self.said.rain { self.conditions.wet(friction) } else { friction };
    }

    /// There is at most one environment, so rain is applied once.
    fn say_rain(&mut self, rain: Stream<f64>) {
        self.conditions.rain = rain;
        self.conditions.friction = self.conditions.wet(self.conditions.friction.clone());
        self.said.rain = true;
    }

    fn say_weather(&mut self, light: Stream<f64>, fog: Stream<f64>, sun: Option<[Stream<f64>; 2]>) {
        if std::mem::replace(&mut self.said.weather, true) {
            self.flaw(WorldFlaw::EnvironmentTwice);
        }
        self.conditions.light = light;
        self.conditions.fog = fog;
        if let Some([elevation, azimuth]) = sun {
            self.said.sun = true;
            self.conditions.sun_elevation = elevation;
            self.conditions.sun_azimuth = azimuth;
        }
    }

    /// States a requirement on every run. The returned draft takes a text, a unit and a scale.
    pub fn require(&mut self, id: &str, asked: Temporal) -> RequirementDraft {
        RequirementDraft::new(self.requirements.clone(), id, asked)
    }

    /// Sets the premise of the test, which is the event that the test is about. If `event` never occurs and nothing is
    /// violated, the verdict is inconclusive rather than pass.
    pub fn premise(&mut self, event: &Stream<bool>) {
        self.premise = Some(event.clone());
    }

    /// Ends every run at the first tick at which `event` occurs, before its duration is over.
    pub fn end(&mut self, event: &Stream<bool>) {
        self.end = Some(event.clone());
    }

    /// States a constraint between parameters, in the language of [`paracosm_space::constraint`]. Strategies propose no test
    /// that breaks the constraint, and measures of coverage count no such test.
    ///
    /// ```
    /// # use paracosm_engine::Scenario;
    /// # use paracosm_space::constraint::Expression;
    /// fn world(s: &mut Scenario) {
    ///     let speed = s.interval("speed", 1.0..=30.0).default(10.0).value();
    ///     let gap = s.interval("gap", 5.0..=100.0).default(50.0).value();
    ///     s.constrain("gap >= 0.5 * speed".parse::<Expression>().expect("a constraint"));
    /// }
    /// ```
    pub fn constrain(&mut self, constraint: impl Into<Constraint>) {
        self.constraints.push(constraint.into());
    }

    /// Remarks on the world, such as the parts of a file that have no effect. The function makes the remarks if somebody wants
    /// them, so they take no time in a test.
    pub fn note<N: IntoIterator<Item = String>>(&mut self, notes: impl FnOnce() -> N) {
        if let Some(all) = &mut self.notes {
            all.extend(notes());
        }
    }

    /// Returns the drawing of what objects do with their inputs, for a graph of the streams; `None` if nobody wants it, so that it
    /// takes no time in a test.
    pub fn sketch(&mut self) -> Option<&mut Sketch> {
        self.sketch.as_mut()
    }

    /// Makes the test invalid for the reason `why`, because the test's world is impossible. Use this for conditions
    /// that the intervals of the parameters cannot express.
    pub fn refuse(&mut self, why: &str) {
        self.flaw(WorldFlaw::Refused { why: why.to_owned() });
    }

    /// Says that the program failed, for example because an interpreter raised an exception. The world cannot be built then, and the test
    /// ends in an error.
    pub fn fail(&mut self, why: &str) {
        self.failure.get_or_insert_with(|| why.to_owned());
    }

    /// Returns the mistakes that have been found so far. Other mistakes are found once the program has returned.
    pub fn flaws(&self) -> Ref<'_, Vec<WorldFlaw>> {
        self.flaws.borrow()
    }

    /// Sets the duration of a run without a contact, in simulated seconds; the default is 10.
    pub fn duration(&mut self, seconds: f64) {
        self.duration = seconds;
    }

    /// Sets the duration of a tick in seconds; the default is [`DEFAULT_DT`].
    pub fn tick(&mut self, seconds: f64) {
        self.dt = seconds;
    }

    /// Returns the streams of the weather that the program defines: light and fog, the rain, the place of the sun.
    pub(crate) fn weather(&self) -> impl Iterator<Item = (WeatherPart, Rc<Node>)> {
        let said = [self.said.weather, self.said.rain, self.said.sun];
        self.conditions.weather().into_iter().zip(said).filter(|(_, said)| *said).flat_map(|(parts, _)| parts)
    }

    /// Returns everything in the world that reads a stream, with its name.
    fn readers(&self) -> Vec<(String, Rc<Node>)> {
        let weather = self.weather().map(|(part, node)| (part.name.to_owned(), node));
        let conditions =
            std::iter::once(("road.friction".to_owned(), self.conditions.friction.node.clone())).chain(weather);
        let premise = self.premise.iter().map(|event| ("premise".to_owned(), event.node.clone()));
        let end = self.end.iter().map(|event| ("end".to_owned(), event.node.clone()));
        let requirements = self.requirements.borrow();
        let read = |stated: &requirement::Stated| {
            let id = stated.requirement.id.clone();
            stated.signals.clone().into_iter().map(move |signal| (id.clone(), signal))
        };
        let requirements = requirements.iter().flat_map(read);
        let effects = self.effects.iter().map(|effect| ("for_each".to_owned(), effect.clone()));
        conditions.chain(self.wiring.readers()).chain(premise).chain(end).chain(requirements).chain(effects).collect()
    }

    /// Lays out all streams that are read or defined. An error in them is a flaw of the scenario.
    pub(crate) fn lay_out(&mut self) {
        let readers = self.readers();
        let equations = self.equations.borrow();
        for equation in equations.iter().filter(|equation| equation.is_defined_twice) {
            self.flaw(WorldFlaw::DefinedTwice { stream: equation.name.clone() });
        }
        let definitions = equations.iter().filter_map(|equation| equation.definition.as_ref());
        match Graph::new(readers.iter().map(|(_, node)| node).chain(definitions), &equations, self.wiring.samples()) {
            Ok(graph) => self.graph = graph,
            Err(flaw) => self.flaw(flaw.into()),
        }
    }

    /// Lays out once more the streams that inputs are bound to, and returns the graph with the slot of the roads'
    /// friction. All streams must have been laid out before.
    pub(crate) fn beginning(&self) -> (Graph, Slot) {
        let equations = self.equations.borrow();
        let definitions = equations.iter().filter_map(|equation| equation.definition.as_ref());
        let readers = self.wiring.readers();
        let friction = &self.conditions.friction.node;
        let roots = readers.iter().map(|(_, node)| node).chain([friction]).chain(definitions);
        let graph =
            Graph::new(roots, &equations, self.wiring.samples()).expect("what has been laid out can be laid out again");
        let slot = graph.slot(friction);
        (graph, slot)
    }

    /// Returns the graph of the streams in the language of Graphviz. All streams must have been laid out before.
    pub(crate) fn dot(&self, title: &str) -> String {
        let none = Sketch::default();
        // The readers begin with the friction and the weather.
        let sketch = (self.sketch.as_ref().unwrap_or(&none), 1 + self.weather().count());
        dot(title, &self.readers(), &self.equations.borrow(), sketch).expect("what has been laid out can be drawn")
    }

    pub(crate) fn flaw(&self, flaw: WorldFlaw) {
        self.flaws.borrow_mut().push(flaw);
    }
}
