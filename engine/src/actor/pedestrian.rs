//! People on foot: they walk straight to a target, at the speed that their input says.

use crate::geometry::Pose;
use crate::object::{Body, Geometric, Input, InputError, Output, Outputs, Tick};
use crate::road::Path;
use crate::scenario::{Place, Scenario};
use crate::stream::{Datum, Stream};
use nalgebra::Vector2;
use std::cell::Cell;
use std::rc::Rc;

/// A person on foot, not placed yet.
#[derive(Debug, Clone)]
pub struct Pedestrian {
    name: String,
    body: Body,
    start: Pose,
}

/// A placed pedestrian: its outputs and its input.
#[derive(Debug, Clone)]
pub struct Walker {
    /// Where it walks to, once the program has said so.
    target: Rc<Cell<Option<Vector2<f64>>>>,
    speed: Input<f64>,
    position: Output<Vector2<f64>>,
    remaining: Output<f64>,
}

/// A walk that a pedestrian's input is bound to; its methods bind it to what they make of it.
#[derive(Debug)]
pub struct Walk(Input<f64>);

/// A pedestrian in motion.
struct Walking {
    pose: Pose,
    /// Metres per second over the last tick.
    velocity: Vector2<f64>,
    target: Rc<Cell<Option<Vector2<f64>>>>,
    input: Input<f64>,
    position: Output<Vector2<f64>>,
    x: Output<f64>,
    y: Output<f64>,
    speed: Output<f64>,
    remaining: Output<f64>,
}

impl Pedestrian {
    /// A pedestrian of average build who stands at `start`.
    pub fn at(start: Pose) -> Self {
        Self { name: "pedestrian".to_owned(), body: Body::adult(), start }
    }

    /// A child who stands at `start`.
    pub fn child(start: Pose) -> Self {
        Self { name: "child".to_owned(), body: Body::child(), start }
    }

    /// The name by which traces and requirements speak of it.
    pub fn named(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }
}

impl Place for Pedestrian {
    type Handle = Walker;

    fn place(self, scenario: &mut Scenario) -> Walker {
        let mut draft = scenario.object(&self.name);
        draft.body(self.body, self.start);
        let walking = Walking {
            pose: self.start,
            velocity: Vector2::zeros(),
            target: Rc::default(),
            input: draft.input("speed", Stream::absent()),
            position: draft.output("position"),
            x: draft.signal("x"),
            y: draft.signal("y"),
            speed: draft.signal("speed"),
            remaining: draft.output("remaining"),
        };
        let walker = Walker {
            target: walking.target.clone(),
            speed: walking.input.clone(),
            position: walking.position.clone(),
            remaining: walking.remaining.clone(),
        };
        draft.geometric(walking);
        walker
    }
}

impl Walker {
    /// Walks straight to `target` at this speed in m/s, which it has from the first tick on, and stops there. It stands
    /// at ticks at which the speed is absent.
    pub fn walk(&self, target: Pose, speed: impl Into<Stream<f64>>) -> Walk {
        self.target.set(Some(target.position));
        self.speed.bind(speed);
        Walk(self.speed.clone())
    }

    /// Where it is.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        self.position.stream()
    }

    /// Metres that it still has to walk.
    pub fn remaining(&self) -> Stream<f64> {
        self.remaining.stream()
    }

    /// Whether it stands at the target of its walk.
    pub fn arrived(&self) -> Stream<bool> {
        self.remaining().at_most(0.0)
    }
}

impl Walk {
    /// Begins at the tick of the event: [`Stream::skip_until`].
    pub fn skip_until<E: Datum>(self, event: &Stream<E>) -> Self {
        self.0.rebind(|speed| speed.skip_until(event));
        self
    }

    /// Ends at the tick of the event: [`Stream::take_until`].
    pub fn take_until<E: Datum>(self, event: &Stream<E>) -> Self {
        self.0.rebind(|speed| speed.take_until(event));
        self
    }
}

impl Walking {
    fn remaining(&self) -> f64 {
        self.target.get().map_or(0.0, |target| (target - self.pose.position).norm())
    }
}

impl Geometric for Walking {
    fn poses(&self, poses: &mut [Option<Pose>]) {
        poses[0] = Some(self.pose);
    }

    fn begin(&mut self, tick: &Tick<'_>, velocities: &mut [Vector2<f64>]) -> Result<(), InputError> {
        let way = self.target.get().map_or(Vector2::zeros(), |target| target - self.pose.position);
        self.velocity = way.try_normalize(0.0).unwrap_or_default() * tick.speed(&self.input)?;
        velocities[0] = self.velocity;
        Ok(())
    }

    fn show(&self, outputs: &mut Outputs<'_>) {
        outputs.set(&self.position, self.pose.position);
        outputs.set(&self.x, self.pose.position.x);
        outputs.set(&self.y, self.pose.position.y);
        outputs.set(&self.speed, self.velocity.norm());
        outputs.set(&self.remaining, self.remaining());
    }

    fn plan(&self) -> Option<Path> {
        self.target.get().map(|target| Path::straight(self.pose.position, target))
    }

    /// Walks no further than to the target, which it then reaches exactly.
    fn step(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
        let speed = tick.speed(&self.input)?;
        let before = self.pose.position;
        if let Some(target) = self.target.get() {
            let way = target - before;
            let step = speed * tick.dt();
            self.pose.position = if step >= way.norm() { target } else { before + way * (step / way.norm()) };
        }
        self.velocity = (self.pose.position - before) / tick.dt();
        Ok(())
    }
}
