//! The scene of a run: everything in a world, as it moves from tick to tick.

use super::Setup;
use crate::contact::{Contact, Face};
use crate::object::{Behaviour, BodyState, ObjectSetup, Outputs, Tick, Wiring};
use crate::outcome::Invalid;
use crate::road::{Path, RoadNetwork};
use crate::scenario::Ego;
use crate::scenario::Scenario;
use crate::stream::{Clock, DatumSample, Graph, Slot};
use crate::upset::Upset;
use crate::vehicle::GRAVITY;
use crate::weather::{Weather, WeatherPart};
use crate::world::{World, overlapping};
use nalgebra::Vector2;
use paracosm_road::Pose;
use std::sync::Arc;

/// The least missing braking distance in metres that counts for a contact.
const LEAST_MISSING: f64 = 0.001;

/// An object with its bodies: the index of its first body, and the index after its last.
struct Object {
    name: String,
    own: (usize, usize),
    behaviour: Behaviour,
}

/// The ego vehicle, the objects around it, and the states of all bodies.
pub(super) struct Scene {
    pub ego: Ego,
    /// `true` if the driver gets the car when the scenario hands it over.
    takes_over: bool,
    pub network: Arc<RoadNetwork>,
    objects: Vec<Object>,
    /// The states of the bodies of the car, of the objects and of the scenery, in this order.
    pub bodies: Vec<BodyState>,
    /// The number of bodies that are no scenery. Only sensors and the physics know of the scenery.
    told: usize,
    wiring: Wiring,
    /// The graph's slots of the values of the objects' inputs.
    inputs: Vec<Slot>,
    friction: Slot,
    /// Light, fog, rain and the sun, as far as the program defines them.
    weather: Vec<(WeatherPart, Slot)>,
    /// The parts of the weather whose values have to be checked at the next tick: all at first, then those that change.
    unchecked: Vec<(WeatherPart, Slot)>,
    world: World,
    /// The index of the body that the car touches; `None` without a contact.
    pub contact: Option<usize>,
    /// The first contact of the car after the beginning.
    pub touched: Option<Box<Contact>>,
    /// The value of `car.clearance` at this tick.
    clearance: f64,
    /// The poses of one object's bodies at the end of a tick.
    poses: Vec<Option<Pose>>,
    /// The states of all bodies at the previous tick. During a tick, the states at its end are written here.
    previous: Vec<BodyState>,
    pushes: Vec<Vector2<f64>>,
    velocities: Vec<Vector2<f64>>,
}

impl Scene {
    /// Makes the scene of a program that has been built and laid out, with the given setup of the run.
    pub fn new(mut scenario: Scenario, graph: &Graph, setup: Setup) -> Self {
        let network = scenario.networks.swap_remove(0).expect("a network that cannot be built is a problem");
        let weather: Vec<_> = scenario.weather().map(|(part, node)| (part, graph.slot(&node))).collect();
        let ego = Ego::new(&scenario.cars[0], setup.vehicle);
        let mut bodies = vec![ego.body()];
        let mut masses = Vec::new();
        let mut objects = Vec::new();
        let mut poses = Vec::new();
        let told = 1 + scenario.objects.iter().map(|object| object.bodies.len()).sum::<usize>();
        for ObjectSetup { name, bodies: own, behaviour } in scenario.objects.into_iter().chain(scenario.scenery) {
            let first = bodies.len();
            if let Behaviour::Physical(mass, _) = &behaviour {
                masses.push((first, *mass));
            }
            bodies.extend(own.iter().map(|(body, start)| BodyState::at_rest(*body, *start)));
            if let Behaviour::Geometric(behaviour) = &behaviour {
                poses.clear();
                poses.extend(own.iter().map(|(_, start)| Some(*start)));
                behaviour.poses(&mut poses);
                for (state, pose) in bodies[first..].iter_mut().zip(&poses) {
                    state.present = pose.is_some();
                }
            }
            objects.push(Object { name, own: (first, bodies.len()), behaviour });
        }
        let mut world = World::new(&bodies, &masses);
        Self {
            contact: {
                let clearance = world.clearance(&bodies);
                world.contact(&bodies, clearance)
            },
            touched: None,
            clearance: world.clearance(&bodies[..told]),
            told,
            world,
            ego,
            takes_over: setup.takes_over,
            network,
            inputs: scenario.wiring.slots(graph),
            wiring: scenario.wiring,
            friction: graph.slot(&scenario.conditions.friction.node),
            unchecked: weather.clone(),
            weather,
            previous: bodies.clone(),
            poses,
            pushes: Vec::with_capacity(masses.len()),
            velocities: Vec::new(),
            bodies,
            objects,
        }
    }

    /// Sets the velocities of all objects at the start of the run, from the objects' inputs at the first tick. `graph`
    /// is a copy of the run's graph that is used for nothing else.
    pub fn begin(&mut self, (mut graph, friction): (Graph, Slot), clock: Clock) -> Result<(), Upset> {
        self.show(graph.outputs());
        graph.tick(clock);
        let inputs = self.wiring.slots(&graph);
        let friction = graph.value(friction).unwrap_or(f64::NAN);
        let mut has_moved = false;
        for object in &mut self.objects {
            let (first, end) = object.own;
            let tick = Tick {
                dt: clock.dt,
                friction,
                graph: &graph,
                inputs: &inputs,
                bodies: &self.bodies[..self.told],
                own: object.own,
            };
            if let Behaviour::Geometric(behaviour) = &mut object.behaviour {
                self.velocities.clear();
                self.velocities.resize(end - first, Vector2::zeros());
                let declared = vec![None; end - first];
                let (mut before, mut after) = (declared.clone(), declared);
                behaviour.poses(&mut before);
                behaviour.begin(&tick, &mut self.velocities)?;
                behaviour.poses(&mut after);
                for (state, (before, after)) in self.previous[first..end].iter_mut().zip(before.iter().zip(&after)) {
                    if let Some(pose) = after.filter(|_| before != after) {
                        if !pose.is_finite() {
                            return Err(Upset::Place { object: object.name.clone(), pose });
                        }
                        state.pose = pose;
                        has_moved = true;
                    }
                }
                for (state, velocity) in self.previous[first..end].iter_mut().zip(&self.velocities) {
                    if !velocity.iter().all(|speed| speed.is_finite()) {
                        return Err(Upset::Velocity { object: object.name.clone(), velocity: *velocity });
                    }
                    state.velocity = *velocity;
                }
            }
        }
        self.bodies.copy_from_slice(&self.previous);
        if has_moved {
            let mass = |object: &Object| match &object.behaviour {
                Behaviour::Physical(mass, _) => Some((object.own.0, *mass)),
                Behaviour::Geometric(_) => None,
            };
            let masses: Vec<(usize, f64)> = self.objects.iter().filter_map(mass).collect();
            self.world = World::new(&self.bodies, &masses);
            let clearance = self.world.clearance(&self.bodies);
            self.contact = self.world.contact(&self.bodies, clearance);
            self.clearance = self.world.clearance(&self.bodies[..self.told]);
        }
        Ok(())
    }

    /// Returns the states of all bodies at the previous tick.
    pub fn before(&self) -> &[BodyState] {
        &self.previous
    }

    /// Returns the states of all bodies except the scenery.
    pub fn told(&self) -> &[BodyState] {
        &self.bodies[..self.told]
    }

    /// Returns the error for two bodies that overlap; `None` if no bodies overlap.
    pub fn overlapping(&self) -> Option<Invalid> {
        let mut joined = vec![false; self.bodies.len()];
        for object in &self.objects {
            let is_joined = matches!(&object.behaviour, Behaviour::Geometric(of) if of.is_joined());
            joined[object.own.0..object.own.1].fill(is_joined);
        }
        let (a, b) = overlapping(&self.bodies, self.told, &joined)?;
        Some(Invalid::Overlap { first: self.name(a).to_owned(), second: self.name(b).to_owned() })
    }

    /// Returns the name of the object that a body belongs to.
    pub fn name(&self, body: usize) -> &str {
        let object = self.objects.iter().find(|object| (object.own.0..object.own.1).contains(&body));
        object.map_or("car", |object| &object.name)
    }

    /// Writes the outputs of all objects in their present states.
    pub fn show(&self, outputs: &mut [DatumSample]) {
        outputs.fill(DatumSample::Absent);
        let mut outputs = Outputs { samples: outputs };
        self.ego.show(self.clearance, &self.bodies[..self.told], &self.network, &mut outputs);
        for object in &self.objects {
            match &object.behaviour {
                Behaviour::Geometric(behaviour) => behaviour.show(&mut outputs),
                Behaviour::Physical(_, behaviour) => behaviour.show(&self.bodies[object.own.0], &mut outputs),
            }
        }
    }

    /// Moves all bodies on by a tick of `dt` seconds, with the evaluated streams as inputs.
    ///
    /// Inputs are checked before they are used: a minimum or maximum would hide a NaN, and a road whose friction is no
    /// number would limit nothing.
    pub fn step(&mut self, graph: &Graph, dt: f64) -> Result<(), Upset> {
        for (part, slot) in &self.unchecked {
            let value: f64 = graph.value(*slot).unwrap_or(f64::NAN);
            if !part.range.contains(&value) {
                return Err(Upset::Condition { what: part.name, value, expected: part.expected });
            }
        }
        self.unchecked.retain(|(_, slot)| !graph.is_constant(*slot));
        let friction: f64 = graph.value(self.friction).unwrap_or(f64::NAN);
        if !(0.0..f64::INFINITY).contains(&friction) {
            let what = "friction of the road";
            return Err(Upset::Condition { what, value: friction, expected: "a number from 0 on" });
        }
        self.pushes.clear();
        for object in &mut self.objects {
            let (first, end) = object.own;
            let tick =
                Tick { dt, friction, graph, inputs: &self.inputs, bodies: &self.bodies[..self.told], own: object.own };
            match &mut object.behaviour {
                Behaviour::Geometric(behaviour) => {
                    behaviour.step(&tick)?;
                    self.poses.clear();
                    self.poses.extend(self.bodies[first..end].iter().map(|body| Some(body.pose)));
                    behaviour.poses(&mut self.poses);
                    let states = self.previous[first..end].iter_mut().zip(&self.bodies[first..end]);
                    for ((state, before), pose) in states.zip(&self.poses) {
                        if let Some(pose) = pose.filter(|pose| !pose.is_finite()) {
                            return Err(Upset::Place { object: object.name.clone(), pose });
                        }
                        state.follow(before, *pose, dt);
                    }
                }
                Behaviour::Physical(_, behaviour) => {
                    self.pushes.push(behaviour.push(&self.bodies[first], &tick)?);
                    self.previous[first] = self.bodies[first];
                }
            }
        }
        // An object may lead the car, so the car moves last.
        self.ego.step(friction, dt, self.takes_over)?;
        self.previous[0].follow(&self.bodies[0], Some(self.ego.pose()), dt);
        self.previous[0].velocity = self.ego.velocity();
        std::mem::swap(&mut self.bodies, &mut self.previous);
        self.world.advance(&mut self.bodies, &self.pushes, friction, dt);
        let clearance = self.world.clearance(&self.bodies);
        self.contact = self.world.contact(&self.bodies, clearance);
        self.clearance = match self.contact {
            None if self.told == self.bodies.len() => clearance,
            None => self.world.clearance(self.told()),
            Some(contact) => {
                if self.touched.is_none() {
                    self.touched = self.touch().map(Box::new);
                }
                -self.missing_distance(contact, friction)
            }
        };
        Ok(())
    }

    /// Returns the side of the car that a body touched within the last tick.
    pub fn face(&self, body: usize) -> Face {
        self.world.face(&self.previous, &self.bodies, body)
    }

    /// Returns the weather at this tick, with the default for each stream that is absent or out of range.
    pub fn weather(&self, graph: &Graph) -> Weather {
        let mut weather = Weather::default();
        for (part, slot) in &self.weather {
            if let Some(value) = graph.value(*slot).filter(|value| part.range.contains(value)) {
                *(part.of)(&mut weather) = value;
            }
        }
        weather
    }

    /// Returns the planned ways of objects, each with the index of the first body of its object.
    pub fn plans(&self) -> Vec<(usize, Path)> {
        let plan = |object: &Object| match &object.behaviour {
            Behaviour::Geometric(behaviour) if object.own.0 < object.own.1 => Some((object.own.0, behaviour.plan()?)),
            _ => None,
        };
        let own = self.ego.plan().map(|way| (0, way));
        own.into_iter().chain(self.objects.iter().filter_map(plan)).collect()
    }

    /// Returns the braking distance in metres that was missing at a contact. Brakes take away only the speed at which
    /// the car and the body close along the heading of the car.
    fn missing_distance(&self, touching: usize, friction: f64) -> f64 {
        let car = &self.bodies[0];
        let closing = car.pose.turn_to_local(car.velocity - self.bodies[touching].velocity).x.max(0.0);
        (closing * closing / (2.0 * friction * GRAVITY)).max(LEAST_MISSING)
    }
}
