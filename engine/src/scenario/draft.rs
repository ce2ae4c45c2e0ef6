//! Objects under construction, before they get their behaviour.

use super::Scenario;
use crate::flaw::{ObjectFlaw, WorldFlaw};
use crate::object::{Behaviour, Body, Geometric, Input, ObjectSetup, Output, Physical};
use crate::stream::{Datum, Sketch, Stream};
use paracosm_road::Pose;

/// An object of a scenario, under construction. [`Scenario::object`] begins it, and [`ObjectDraft::geometric`] or
/// [`ObjectDraft::physical`] make it part of the world.
#[must_use = "call `geometric` or `physical`, or the object does not become part of the world"]
pub struct ObjectDraft<'a> {
    scenario: &'a mut Scenario,
    name: String,
    bodies: Vec<(Body, Pose)>,
}

impl<'a> ObjectDraft<'a> {
    pub(crate) fn new(scenario: &'a mut Scenario, name: String) -> Self {
        Self { scenario, name, bodies: Vec::new() }
    }

    /// Returns the name of the object, with a number if an earlier object has the same name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Gives the object a body that stands at `start`. An object may have no body, or several bodies.
    pub fn body(&mut self, body: Body, start: Pose) {
        if let Some([length, width, height]) = body.wrong_measures() {
            self.flaw(ObjectFlaw::Measures { length, width, height });
        }
        if !start.is_finite() {
            let (x, y, heading) = (start.position.x, start.position.y, start.heading);
            self.flaw(ObjectFlaw::Pose { x, y, heading });
        }
        self.bodies.push((body, start));
    }

    /// Adds an input to the object, with the stream to which the input is bound at first.
    pub fn input<T: Datum>(&mut self, name: &str, stream: impl Into<Stream<T>>) -> Input<T> {
        self.scenario.wiring.input(&format!("{}.{name}", self.name), &stream.into())
    }

    /// Adds an output to the object.
    pub fn output<T: Datum>(&mut self, name: &str) -> Output<T> {
        self.scenario.wiring.output(&format!("{}.{name}", self.name))
    }

    /// Adds to the object an output that every trace records.
    pub fn signal(&mut self, name: &str) -> Output<f64> {
        let name = format!("{}.{name}", self.name);
        let output = self.scenario.wiring.output(&name);
        self.scenario.signals.push((name, output.source()));
        output
    }

    /// Returns the drawing of what objects do with their inputs, as [`Scenario::sketch`] does.
    pub fn sketch(&mut self) -> Option<&mut Sketch> {
        self.scenario.sketch()
    }

    /// Refuses the object, so the world cannot be built. `why` gives the reason and follows the object's name.
    pub fn refuse(&mut self, why: &str) {
        self.flaw(ObjectFlaw::Refused { why: why.to_owned() });
    }

    pub(crate) fn flaw(&mut self, flaw: ObjectFlaw) {
        self.scenario.flaw(WorldFlaw::Object { object: self.name.clone(), flaw });
    }

    /// Makes the object part of the world, with a behaviour that moves its bodies.
    pub fn geometric(self, behaviour: impl Geometric) {
        let behaviour = Behaviour::Geometric(Box::new(behaviour));
        self.scenario.objects.push(ObjectSetup { name: self.name, bodies: self.bodies, behaviour });
    }

    /// Makes the object part of the world, as one body of `mass` kg that a behaviour pushes and the physics moves.
    pub fn physical(mut self, mass: f64, behaviour: impl Physical) {
        if self.bodies.len() != 1 {
            return self.flaw(ObjectFlaw::Bodies { found: self.bodies.len() });
        }
        if !(mass > 0.0 && mass.is_finite()) {
            self.flaw(ObjectFlaw::Mass { mass });
        }
        let behaviour = Behaviour::Physical(mass, Box::new(behaviour));
        self.scenario.objects.push(ObjectSetup { name: self.name, bodies: self.bodies, behaviour });
    }
}
