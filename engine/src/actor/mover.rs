//! Vehicles of all kinds and people that move along a path, at the speed of their input.
//!
//! They do not react to others: the scenario says what they do. For traffic that drives itself see
//! [`traffic`](crate::traffic).

use crate::flaw::ObjectFlaw;
use crate::object::{Body, Geometric, Input, InputError, Output, Outputs, Tick};
use crate::road::Path;
use crate::scenario::{Place, Scenario};
use crate::stream::Stream;
use nalgebra::Vector2;
use paracosm_road::Pose;

/// An object that moves along a path. It is not placed yet, and stands still until its [speed](Mover::speed) is set.
#[derive(Debug, Clone)]
pub struct Mover {
    name: String,
    body: Body,
    path: Path,
    start: f64,
    speed: Stream<f64>,
    offset: Stream<f64>,
}

/// The handle of a placed object that moves along a path, with its outputs and its inputs.
#[derive(Debug, Clone)]
pub struct Actor {
    speed_input: Input<f64>,
    offset_input: Input<f64>,
    position: Output<Vector2<f64>>,
    speed: Output<f64>,
    travelled: Output<f64>,
    remaining: Output<f64>,
}

struct Moving {
    path: Path,
    /// The object's present place (`at`) and its place at the start, in metres along the path.
    at: f64,
    start: f64,
    /// The distance to the left of the path, in metres.
    offset: f64,
    pose: Pose,
    speed: f64,
    speed_input: Input<f64>,
    offset_input: Input<f64>,
    shown: Shown,
}

struct Shown {
    position: Output<Vector2<f64>>,
    x: Output<f64>,
    y: Output<f64>,
    speed: Output<f64>,
    travelled: Output<f64>,
    remaining: Output<f64>,
}

impl Mover {
    /// Makes an object with a given body that moves along a path. Traces and requirements refer to it by its name.
    pub fn new(name: &str, body: Body, path: Path) -> Self {
        let (speed, offset) = (Stream::absent(), Stream::constant(0.0));
        Self { name: name.to_owned(), body, path, start: 0.0, speed, offset }
    }

    /// Makes a passenger car called `other`.
    pub fn car(path: Path) -> Self {
        Self::new("other", Body::car(), path)
    }

    /// Makes a lorry called `truck`.
    pub fn truck(path: Path) -> Self {
        Self::new("truck", Body::truck(), path)
    }

    /// Makes a bicycle called `bicycle`.
    pub fn bicycle(path: Path) -> Self {
        Self::new("bicycle", Body::bicycle(), path)
    }

    /// Sets the name by which traces and requirements refer to the object.
    pub fn named(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// Sets the place of the object's middle at the beginning, in metres along the path.
    pub fn starting(mut self, at: f64) -> Self {
        self.start = at;
        self
    }

    /// Sets the speed of the object along the path in m/s, which is not negative. The object stands at ticks at which
    /// the stream is absent, and at the end of the path.
    pub fn speed(mut self, speed: impl Into<Stream<f64>>) -> Self {
        self.speed = speed.into();
        self
    }

    /// Sets the distance to the left of the path in metres, for example for lane changes; negative to the right, 0 by default. The object
    /// starts at the first value of the stream.
    pub fn offset(mut self, offset: impl Into<Stream<f64>>) -> Self {
        self.offset = offset.into();
        self
    }
}

impl Place for Mover {
    type Handle = Actor;

    fn place(self, scenario: &mut Scenario) -> Actor {
        let mut draft = scenario.object(&self.name);
        let length = self.path.length();
        if let Some(piece) = self.path.wrong_piece() {
            draft.flaw(ObjectFlaw::Piece { line: "path", piece });
        }
        if !(0.0..=length).contains(&self.start) {
            draft.flaw(ObjectFlaw::Start { line: "path", start: self.start, length });
        }
        let pose = self.path.beside(self.start, 0.0);
        draft.body(self.body, pose);
        let shown = Shown {
            position: draft.output("position"),
            x: draft.signal("x"),
            y: draft.signal("y"),
            speed: draft.signal("speed"),
            travelled: draft.output("travelled"),
            remaining: draft.output("remaining"),
        };
        let actor = Actor {
            speed_input: draft.input("speed", self.speed),
            offset_input: draft.input("offset", self.offset),
            position: shown.position.clone(),
            speed: shown.speed.clone(),
            travelled: shown.travelled.clone(),
            remaining: shown.remaining.clone(),
        };
        draft.geometric(Moving {
            path: self.path,
            at: self.start,
            start: self.start,
            offset: 0.0,
            pose,
            speed: 0.0,
            speed_input: actor.speed_input.clone(),
            offset_input: actor.offset_input.clone(),
            shown,
        });
        actor
    }
}

impl Actor {
    /// Binds the speed of the object to another stream, with the rules of [`Mover::speed`].
    pub fn drive(&self, speed: impl Into<Stream<f64>>) {
        self.speed_input.bind(speed);
    }

    /// Binds the distance to the left of the path to another stream, with the rules of [`Mover::offset`].
    pub fn shift(&self, offset: impl Into<Stream<f64>>) {
        self.offset_input.bind(offset);
    }

    /// Returns a stream of the position of the object's middle.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        self.position.stream()
    }

    /// Returns a stream of the speed of the object, in m/s.
    pub fn speed(&self) -> Stream<f64> {
        self.speed.stream()
    }

    /// Returns a stream of the distance that the object has travelled along the path, in metres.
    pub fn travelled(&self) -> Stream<f64> {
        self.travelled.stream()
    }

    /// Returns a stream of the distance from the object to the end of its path, in metres.
    pub fn remaining(&self) -> Stream<f64> {
        self.remaining.stream()
    }

    /// Returns a stream that is true at the ticks at which the object stands at the end of its path.
    pub fn arrived(&self) -> Stream<bool> {
        self.remaining().at_most(0.0)
    }
}

impl Geometric for Moving {
    fn poses(&self, poses: &mut [Option<Pose>]) {
        poses[0] = Some(self.pose);
    }

    fn begin(&mut self, tick: &Tick<'_>, velocities: &mut [Vector2<f64>]) -> Result<(), InputError> {
        self.offset = tick.number(&self.offset_input)?;
        self.pose = self.path.beside(self.at, self.offset);
        self.speed = tick.speed(&self.speed_input)?;
        velocities[0] = self.pose.forward() * self.speed;
        Ok(())
    }

    fn show(&self, outputs: &mut Outputs<'_>) {
        outputs.set(&self.shown.position, self.pose.position);
        outputs.set(&self.shown.x, self.pose.position.x);
        outputs.set(&self.shown.y, self.pose.position.y);
        outputs.set(&self.shown.speed, self.speed);
        outputs.set(&self.shown.travelled, self.at - self.start);
        outputs.set(&self.shown.remaining, self.path.length() - self.at);
    }

    fn plan(&self) -> Option<Path> {
        Some(self.path.piece(self.at, self.path.length()))
    }

    fn step(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
        let offset = tick.number(&self.offset_input)?;
        let before = (self.at, self.offset, self.pose.position);
        self.at = (self.at + tick.speed(&self.speed_input)? * tick.dt()).min(self.path.length());
        self.offset = offset;
        self.pose = self.path.beside(self.at, offset);
        // It faces in its direction of motion, even off the path. A motion that is only sideways does not turn it.
        let (ahead, aside) = (self.at - before.0, offset - before.1);
        if ahead > 0.0 {
            self.pose.heading = paracosm_road::wrapped(self.pose.heading + libm::atan2(aside, ahead));
        }
        self.speed = (self.pose.position - before.2).norm() / tick.dt();
        Ok(())
    }
}
