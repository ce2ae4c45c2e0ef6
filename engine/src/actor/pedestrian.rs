//! People on foot: they walk straight to a target, at the speed of their input.

use crate::flaw::ObjectFlaw;
use crate::object::{Body, Geometric, Input, InputError, Output, Outputs, Tick};
use crate::road::Path;
use crate::scenario::{Place, Scenario};
use crate::stream::{Datum, Stream};
use nalgebra::Vector2;
use paracosm_road::Pose;
use std::cell::Cell;
use std::rc::Rc;

/// A person on foot who is not placed in a world yet.
#[derive(Debug, Clone)]
pub struct Pedestrian {
    name: String,
    body: Body,
    start: Pose,
    acceleration: f64,
}

/// The handle of a placed pedestrian, with its outputs and its input.
#[derive(Debug, Clone)]
pub struct Walker {
    /// The target of the walk, as soon as the program has set one.
    target: Rc<Cell<Option<Vector2<f64>>>>,
    speed: Input<f64>,
    position: Output<Vector2<f64>>,
    remaining: Output<f64>,
}

/// The walk of a pedestrian, which can begin and end by events. It consists of the speed that the input is bound to.
#[derive(Debug)]
pub struct Walk(Input<f64>);

/// A pedestrian in motion.
struct Walking {
    pose: Pose,
    /// The velocity over the last tick, in m/s.
    velocity: Vector2<f64>,
    /// The speed at which the pedestrian walked in the last tick, unless the walk ended within it, in m/s.
    pace: f64,
    /// The greatest change of the speed in m/s².
    acceleration: f64,
    target: Rc<Cell<Option<Vector2<f64>>>>,
    input: Input<f64>,
    position: Output<Vector2<f64>>,
    x: Output<f64>,
    y: Output<f64>,
    speed: Output<f64>,
    remaining: Output<f64>,
}

impl Pedestrian {
    /// Makes a pedestrian of average build who stands at `start`.
    pub fn at(start: Pose) -> Self {
        Self { name: "pedestrian".to_owned(), body: Body::adult(), start, acceleration: f64::INFINITY }
    }

    /// Makes a child who stands at `start`.
    pub fn child(start: Pose) -> Self {
        Self { name: "child".to_owned(), body: Body::child(), start, acceleration: f64::INFINITY }
    }

    /// Sets the name by which traces and requirements refer to the pedestrian.
    pub fn named(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// Sets the acceleration in m/s² with which the pedestrian becomes faster and slower. By default the pedestrian has
    /// each new speed at once. At the target, the pedestrian always stops at once.
    pub fn accelerating(mut self, acceleration: f64) -> Self {
        self.acceleration = acceleration;
        self
    }
}

impl Place for Pedestrian {
    type Handle = Walker;

    fn place(self, scenario: &mut Scenario) -> Walker {
        let mut draft = scenario.object(&self.name);
        draft.body(self.body, self.start);
        // In this form, the condition refuses NaN as well.
        let is_sound = self.acceleration > 0.0;
        if !is_sound {
            draft.flaw(ObjectFlaw::Acceleration { acceleration: self.acceleration });
        }
        let walking = Walking {
            pose: self.start,
            velocity: Vector2::zeros(),
            pace: 0.0,
            acceleration: self.acceleration,
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
    /// Lets the pedestrian walk straight to `target` at a given speed in m/s from the first tick on, and stop at
    /// `target`. The pedestrian stands at ticks at which the speed is absent.
    pub fn walk(&self, target: Pose, speed: impl Into<Stream<f64>>) -> Walk {
        self.target.set(Some(target.position));
        self.speed.bind(speed);
        Walk(self.speed.clone())
    }

    /// Returns a stream of the position of the pedestrian.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        self.position.stream()
    }

    /// Returns a stream of the distance that the pedestrian still has to walk, in metres.
    pub fn remaining(&self) -> Stream<f64> {
        self.remaining.stream()
    }

    /// Returns a stream that is true at the ticks at which the pedestrian stands at the target of the walk.
    pub fn arrived(&self) -> Stream<bool> {
        self.remaining().at_most(0.0)
    }
}

impl Walk {
    /// Lets the walk begin at the tick of an event, by [`Stream::skip_until`].
    pub fn skip_until<E: Datum>(self, event: &Stream<E>) -> Self {
        self.0.rebind(|speed| speed.skip_until(event));
        self
    }

    /// Lets the walk end at the tick of an event, by [`Stream::take_until`].
    pub fn take_until<E: Datum>(self, event: &Stream<E>) -> Self {
        self.0.rebind(|speed| speed.take_until(event));
        self
    }
}

impl Walking {
    /// Returns the speed in this tick, in m/s.
    fn next_pace(&self, tick: &Tick<'_>) -> Result<f64, InputError> {
        let (wanted, most) = (tick.speed(&self.input)?, self.acceleration * tick.dt());
        let change = wanted - self.pace;
        Ok(if change.abs() <= most { wanted } else { self.pace + most.copysign(change) })
    }

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
        self.velocity = way.try_normalize(0.0).unwrap_or_default() * self.next_pace(tick)?;
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

    /// Walks no further than to the target. The last step reaches it exactly.
    fn step(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
        self.pace = self.next_pace(tick)?;
        let before = self.pose.position;
        if let Some(target) = self.target.get() {
            let way = target - before;
            let step = self.pace * tick.dt();
            self.pose.position = if step >= way.norm() { target } else { before + way * (step / way.norm()) };
        }
        self.velocity = (self.pose.position - before) / tick.dt();
        Ok(())
    }
}
