//! The others in a world: pedestrians, vehicles that move as the scenario says, things that stand still, and the roadside.

use super::building::Building;
use super::ego::class_of;
use super::handle::Handle;
use super::operand::Operand;
use super::place::{Path, Pose};
use super::recipe::{Quantity, Recipe};
use super::stream::Stream;
use super::wire::each;
use crate::error::raised;
use paracosm::engine::object::{Body, VehicleKind};
use paracosm::engine::{self, Place};
use paracosm::space::{did_you_mean, nearest};
use pyo3::prelude::*;
use std::cell::RefCell;

/// A person on foot, who is not placed yet and stands at a pose.
#[pyclass(frozen, module = "paracosm")]
pub struct Pedestrian {
    inner: engine::Pedestrian,
}

#[pymethods]
impl Pedestrian {
    #[new]
    fn new(start: &Pose) -> Self {
        Self { inner: engine::Pedestrian::at(start.inner) }
    }

    /// Makes a child who stands at a pose.
    #[staticmethod]
    fn child(start: &Pose) -> Self {
        Self { inner: engine::Pedestrian::child(start.inner) }
    }

    /// Returns the pedestrian with a name for traces and requirements.
    fn named(&self, name: &str) -> Self {
        Self { inner: self.inner.clone().named(name) }
    }

    /// Sets the acceleration and the deceleration of the pedestrian in m/s². Without it, the speed changes at once.
    fn accelerating(&self, acceleration: f64) -> Self {
        Self { inner: self.inner.clone().accelerating(acceleration) }
    }
}

impl Pedestrian {
    /// Places the pedestrian in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<Walker> {
        let walker = building.with(|scenario| self.inner.clone().place(scenario))?;
        Ok(Walker(Handle::new(building, walker)))
    }
}

/// A pedestrian in the world.
#[pyclass(frozen, module = "paracosm")]
pub struct Walker(Handle<engine::Walker>);

#[pymethods]
impl Walker {
    /// Lets the pedestrian walk straight to `target` with a speed in m/s, and stop there. The pedestrian stands while the speed is absent.
    fn walk(&self, target: &Pose, speed: &Bound<PyAny>) -> PyResult<Walk> {
        let speed = Operand::numbers(speed, "speed")?;
        self.0.made(|walker| RefCell::new(Some(walker.walk(target.inner, speed)))).map(Walk)
    }

    /// Returns the position of the pedestrian.
    fn position(&self) -> PyResult<Stream> {
        self.0.stream(engine::Walker::position)
    }

    /// Returns the distance that the pedestrian still has to walk, in metres.
    fn remaining(&self) -> PyResult<Stream> {
        self.0.stream(engine::Walker::remaining)
    }

    /// Returns a stream that is true while the pedestrian stands at the target.
    fn arrived(&self) -> PyResult<Stream> {
        self.0.stream(engine::Walker::arrived)
    }
}

/// The walk of a pedestrian, which can begin and end by events.
#[pyclass(frozen, module = "paracosm")]
pub struct Walk(Handle<RefCell<Option<engine::Walk>>>);

impl Walk {
    fn changed(&self, change: impl FnOnce(engine::Walk) -> engine::Walk) -> PyResult<()> {
        self.0.with(|own| {
            let walk = own.take();
            *own.borrow_mut() = walk.map(change);
        })
    }
}

#[pymethods]
impl Walk {
    /// Lets the walk begin at the first tick at which `event` occurs.
    fn skip_until<'py>(slf: Bound<'py, Self>, event: &Stream) -> PyResult<Bound<'py, Self>> {
        let event = event.wire()?;
        slf.get().changed(|walk| each!(&event, event => walk.skip_until(event)))?;
        Ok(slf)
    }

    /// Lets the walk end at the first tick at which `event` occurs.
    fn take_until<'py>(slf: Bound<'py, Self>, event: &Stream) -> PyResult<Bound<'py, Self>> {
        let event = event.wire()?;
        slf.get().changed(|walk| each!(&event, event => walk.take_until(event)))?;
        Ok(slf)
    }
}

/// Something that moves along a path, and does not react to others. `body` is a kind ("car", "van", "truck", "bus", "motorcycle", "bicycle",
/// "adult", "child"), or a class with length, width and height in metres. It stands still until it gets a speed.
#[pyclass(frozen, module = "paracosm")]
pub struct Mover(Recipe<engine::Mover>);

#[pymethods]
impl Mover {
    #[new]
    fn new(name: &str, body: &Bound<PyAny>, path: &Path) -> PyResult<Self> {
        let (name, body, path) = (name.to_owned(), body_of(body)?, path.inner.clone());
        Ok(Self(Recipe::new(move || engine::Mover::new(&name, body, path.clone()))))
    }

    /// Makes a passenger car called "other".
    #[staticmethod]
    fn car(path: &Path) -> Self {
        Self::on(path, engine::Mover::car)
    }

    /// Makes a lorry called "truck".
    #[staticmethod]
    fn truck(path: &Path) -> Self {
        Self::on(path, engine::Mover::truck)
    }

    /// Makes a bicycle called "bicycle".
    #[staticmethod]
    fn bicycle(path: &Path) -> Self {
        Self::on(path, engine::Mover::bicycle)
    }

    /// Returns the object with another name for traces and requirements.
    fn named(&self, name: &str) -> Self {
        let name = name.to_owned();
        Self(self.0.then(move |mover| Ok(mover.named(&name))))
    }

    /// Returns the object with the start of its middle, in metres along the path.
    fn starting(&self, at: f64) -> Self {
        Self(self.0.then(move |mover| Ok(mover.starting(at))))
    }

    /// Returns the object with a speed along the path in m/s: a number or a stream from 0 on.
    fn speed(&self, speed: &Bound<PyAny>) -> PyResult<Self> {
        let speed = Quantity::of(speed, "speed")?;
        Ok(Self(self.0.then(move |mover| Ok(mover.speed(speed.stream()?)))))
    }

    /// Returns the object with a distance to the left of the path in metres: a number or a stream, for example for a change of lanes.
    fn offset(&self, offset: &Bound<PyAny>) -> PyResult<Self> {
        let offset = Quantity::of(offset, "offset")?;
        Ok(Self(self.0.then(move |mover| Ok(mover.offset(offset.stream()?)))))
    }
}

impl Mover {
    fn on(path: &Path, make: impl Fn(engine::road::Path) -> engine::Mover + Send + Sync + 'static) -> Self {
        let path = path.inner.clone();
        Self(Recipe::new(move || make(path.clone())))
    }

    /// Places the object in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<Actor> {
        let mover = self.0.make()?;
        Ok(Actor(Handle::new(building, building.with(|scenario| mover.place(scenario))?)))
    }
}

/// Something in the world that moves along a path.
#[pyclass(frozen, module = "paracosm")]
pub struct Actor(Handle<engine::Actor>);

#[pymethods]
impl Actor {
    /// Gives the object another speed in m/s.
    fn drive(&self, speed: &Bound<PyAny>) -> PyResult<()> {
        let speed = Operand::numbers(speed, "speed")?;
        self.0.with(|actor| actor.drive(speed))
    }

    /// Gives the object another distance to the left of the path in metres.
    fn shift(&self, offset: &Bound<PyAny>) -> PyResult<()> {
        let offset = Operand::numbers(offset, "offset")?;
        self.0.with(|actor| actor.shift(offset))
    }

    /// Returns the position of the object's middle.
    fn position(&self) -> PyResult<Stream> {
        self.0.stream(engine::Actor::position)
    }

    /// Returns the speed of the object in m/s.
    fn speed(&self) -> PyResult<Stream> {
        self.0.stream(engine::Actor::speed)
    }

    /// Returns the distance that the object has travelled along the path, in metres.
    fn travelled(&self) -> PyResult<Stream> {
        self.0.stream(engine::Actor::travelled)
    }

    /// Returns the distance from the object to the end of its path, in metres.
    fn remaining(&self) -> PyResult<Stream> {
        self.0.stream(engine::Actor::remaining)
    }

    /// Returns a stream that is true while the object stands at the end of its path.
    fn arrived(&self) -> PyResult<Stream> {
        self.0.stream(engine::Actor::arrived)
    }
}

/// Something that stands still at a pose. `body` has the same form as for `Mover`.
#[pyclass(frozen, module = "paracosm")]
pub struct Fixture {
    inner: engine::Fixture,
}

#[pymethods]
impl Fixture {
    #[new]
    fn new(name: &str, body: &Bound<PyAny>, at: &Pose) -> PyResult<Self> {
        Ok(Self { inner: engine::Fixture::new(name, body_of(body)?, at.inner) })
    }

    /// Makes a house of two storeys, 10 m by 8 m.
    #[staticmethod]
    fn house(at: &Pose) -> Self {
        Self { inner: engine::Fixture::house(at.inner) }
    }

    /// Makes a tree. Only its trunk is in the way.
    #[staticmethod]
    fn tree(at: &Pose) -> Self {
        Self { inner: engine::Fixture::tree(at.inner) }
    }

    /// Makes a traffic sign on a post.
    #[staticmethod]
    fn sign(at: &Pose) -> Self {
        Self { inner: engine::Fixture::sign(at.inner) }
    }

    /// Makes a parked car without a driver.
    #[staticmethod]
    fn parked_car(at: &Pose) -> Self {
        Self { inner: engine::Fixture::parked_car(at.inner) }
    }
}

impl Fixture {
    /// Places the object in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<()> {
        building.with(|scenario| self.inner.clone().place(scenario))
    }
}

/// Scenery that fills a share of the places beside the roads, from 0 to 1. Place it after everything else.
#[pyclass(frozen, module = "paracosm")]
pub struct Roadside {
    fullness: f64,
}

#[pymethods]
impl Roadside {
    #[new]
    fn new(fullness: f64) -> Self {
        Self { fullness }
    }
}

impl Roadside {
    /// Places the scenery in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<()> {
        building.with(|scenario| engine::Roadside::new(self.fullness).place(scenario))
    }
}

/// Reads a body: the name of a kind, or a class with length, width and height.
///
/// # Errors
/// There is no such kind or class.
pub fn body_of(found: &Bound<PyAny>) -> PyResult<Body> {
    if let Ok((class, length, width, height)) = found.extract::<(String, f64, f64, f64)>() {
        return Ok(Body::block(class_of(&class)?, length, width, height));
    }
    let name: String = found.extract().map_err(|_| {
        raised("a body is a kind, such as \"car\", or a tuple of a class, a length, a width and a height in metres")
    })?;
    match name.as_str() {
        "adult" => return Ok(Body::adult()),
        "child" => return Ok(Body::child()),
        _ => {}
    }
    let kind = VehicleKind::ALL.iter().find(|kind| kind.name == name);
    kind.map(Body::of).ok_or_else(|| {
        let names: Vec<&str> = VehicleKind::ALL.iter().map(|kind| kind.name).chain(["adult", "child"]).collect();
        let meant = did_you_mean(&nearest(&name, names.iter().copied()));
        raised(format!("no kind of body is called `{name}`{meant}; the kinds are {}", names.join(", ")))
    })
}
