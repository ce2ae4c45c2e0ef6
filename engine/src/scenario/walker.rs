//! Pedestrians: their pose is set by the program, tick by tick (the paper's `Geometric`).

use super::{Place, Pose, Scenario};
use crate::stream::{Datum, Source, Stream};
use nalgebra::Vector2;
use std::cell::RefCell;
use std::rc::Rc;

/// A person on foot, not placed yet.
#[derive(Debug, Clone, Copy)]
pub struct Pedestrian {
    start: Pose,
}

/// What a walker was told to do, shared between its handle and the scenario.
#[derive(Debug, Default)]
pub(crate) struct Task {
    pub target: Option<Vector2<f64>>,
    /// Speed towards the target; the walker stands at ticks at which it is absent.
    pub speed: Option<Stream<f64>>,
}

/// What a run needs of a placed pedestrian.
#[derive(Debug)]
pub(crate) struct WalkerSetup {
    pub name: String,
    pub start: Pose,
    pub task: Rc<RefCell<Task>>,
}

/// A placed pedestrian: its outputs and its input.
#[derive(Debug, Clone)]
pub struct Walker {
    index: usize,
    name: String,
    task: Rc<RefCell<Task>>,
}

/// A walk that a pedestrian's input is bound to; its methods bind it to what they make of it.
#[derive(Debug)]
pub struct Walk {
    task: Rc<RefCell<Task>>,
}

impl WalkerSetup {
    /// The stream that its speed is bound to.
    pub fn speed(&self) -> Option<Stream<f64>> {
        self.task.borrow().speed.clone()
    }
}

impl Pedestrian {
    /// A pedestrian of average build who stands at `start`.
    pub fn at(start: Pose) -> Self {
        Self { start }
    }
}

impl Place for Pedestrian {
    type Handle = Walker;

    fn place(self, scenario: &mut Scenario) -> Walker {
        let index = scenario.walkers.len();
        let name = if index == 0 { "pedestrian".to_owned() } else { format!("pedestrian-{}", index + 1) };
        let task = Rc::<RefCell<Task>>::default();
        scenario.walkers.push(WalkerSetup { name: name.clone(), start: self.start, task: task.clone() });
        Walker { index, name, task }
    }
}

impl Walker {
    /// Walks straight to `target` at this speed in m/s, which it has from the first tick on, and stops there.
    pub fn walk(&self, target: Pose, speed: impl Into<Stream<f64>>) -> Walk {
        *self.task.borrow_mut() = Task { target: Some(target.position), speed: Some(speed.into()) };
        Walk { task: self.task.clone() }
    }

    /// Where it is.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        Stream::output(Source::WalkerPosition(self.index), format!("{}.position", self.name))
    }

    /// Whether it stands at the target of its walk.
    pub fn arrived(&self) -> Stream<bool> {
        let remaining = Stream::output(Source::WalkerRemaining(self.index), format!("{}.remaining", self.name));
        remaining.at_most(0.0)
    }
}

impl Walk {
    /// Begins at the tick of the event: [`Stream::skip_until`].
    pub fn skip_until<E: Datum>(self, event: &Stream<E>) -> Self {
        self.rebind(|speed| speed.skip_until(event))
    }

    /// Ends at the tick of the event: [`Stream::take_until`].
    pub fn take_until<E: Datum>(self, event: &Stream<E>) -> Self {
        self.rebind(|speed| speed.take_until(event))
    }

    fn rebind(self, change: impl FnOnce(Stream<f64>) -> Stream<f64>) -> Self {
        {
            let mut task = self.task.borrow_mut();
            task.speed = task.speed.take().map(change);
        }
        self
    }
}
