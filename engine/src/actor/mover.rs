//! Cars, lorries, bicycles and people that move along a path, as fast as their input says.
//!
//! They do not look around: what they do is the scenario's to say. Traffic that drives itself is in
//! [`traffic`](crate::traffic).

use crate::flaw::ObjectFlaw;
use crate::geometry::Pose;
use crate::object::{Body, Geometric, Input, InputError, Output, Outputs, Tick};
use crate::road::Path;
use crate::scenario::{Place, Scenario};
use crate::stream::Stream;
use nalgebra::Vector2;

/// Something that moves along a path, not placed yet. It stands until its [speed](Mover::speed) is said.
#[derive(Debug, Clone)]
pub struct Mover {
    name: String,
    body: Body,
    path: Path,
    start: f64,
    speed: Stream<f64>,
    offset: Stream<f64>,
}

/// Something placed that moves along a path: its outputs and its inputs.
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
    /// Metres along the path, and at which it began.
    at: f64,
    start: f64,
    /// Metres to the left of the path.
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
    /// A body on a path; traces and requirements speak of it by its name.
    pub fn new(name: &str, body: Body, path: Path) -> Self {
        let (speed, offset) = (Stream::absent(), Stream::constant(0.0));
        Self { name: name.to_owned(), body, path, start: 0.0, speed, offset }
    }

    /// A passenger car called `other`.
    pub fn car(path: Path) -> Self {
        Self::new("other", Body::car(), path)
    }

    /// A lorry called `truck`.
    pub fn truck(path: Path) -> Self {
        Self::new("truck", Body::truck(), path)
    }

    /// A bicycle called `bicycle`.
    pub fn bicycle(path: Path) -> Self {
        Self::new("bicycle", Body::bicycle(), path)
    }

    /// A person on foot called `pedestrian`.
    pub fn pedestrian(path: Path) -> Self {
        Self::new("pedestrian", Body::adult(), path)
    }

    /// The name by which traces and requirements speak of it.
    pub fn named(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// The size that it has instead of the usual one.
    pub fn body(mut self, body: Body) -> Self {
        self.body = body;
        self
    }

    /// How many metres along the path its middle is at first.
    pub fn starting(mut self, at: f64) -> Self {
        self.start = at;
        self
    }

    /// How fast it moves along the path, in m/s: not backwards. It stands at ticks at which the stream is absent, and
    /// where the path ends.
    pub fn speed(mut self, speed: impl Into<Stream<f64>>) -> Self {
        self.speed = speed.into();
        self
    }

    /// How far to the left of the path it is, in metres, from 0 on: how it changes lanes.
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
    /// Binds its speed to another stream: [`Mover::speed`].
    pub fn drive(&self, speed: impl Into<Stream<f64>>) {
        self.speed_input.bind(speed);
    }

    /// Binds its offset to another stream: [`Mover::offset`].
    pub fn shift(&self, offset: impl Into<Stream<f64>>) {
        self.offset_input.bind(offset);
    }

    /// Where its middle is.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        self.position.stream()
    }

    /// How fast it moves, in m/s.
    pub fn speed(&self) -> Stream<f64> {
        self.speed.stream()
    }

    /// Metres along the path that it has come.
    pub fn travelled(&self) -> Stream<f64> {
        self.travelled.stream()
    }

    /// Metres to the end of its path.
    pub fn remaining(&self) -> Stream<f64> {
        self.remaining.stream()
    }

    /// Whether it stands at the end of its path.
    pub fn arrived(&self) -> Stream<bool> {
        self.remaining().at_most(0.0)
    }
}

impl Geometric for Moving {
    fn poses(&self, poses: &mut [Option<Pose>]) {
        poses[0] = Some(self.pose);
    }

    fn begin(&mut self, tick: &Tick<'_>, velocities: &mut [Vector2<f64>]) -> Result<(), InputError> {
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
        // It faces where it goes, also where that is not along the path. What moves across only is pushed aside.
        let (ahead, aside) = (self.at - before.0, offset - before.1);
        if ahead > 0.0 {
            self.pose.heading = crate::geometry::wrapped(self.pose.heading + libm::atan2(aside, ahead));
        }
        self.speed = (self.pose.position - before.2).norm() / tick.dt();
        Ok(())
    }
}
