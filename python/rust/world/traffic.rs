//! Cars that drive by themselves.

use super::actors::body_of;
use super::building::Building;
use super::handle::Handle;
use super::operand::Operand;
use super::place::Pose;
use super::stream::Stream;
use super::streets::{Streets, side_of};
use crate::error::raised;
use crate::whole::whole;
use paracosm::engine::road::RoutePosition;
use paracosm::engine::{self, Place};
use pyo3::prelude::*;

/// A place on the roads: a road, a lane, and metres along the road.
type OnRoad = (String, i32, f64);

/// A car that drives by itself, as `EnvironmentCars.on` takes it. It stands with its middle at a place (road, lane, metres along the road), drives at
/// 50 km/h on a free road, and turns at random.
#[pyclass(frozen, module = "paracosm")]
pub struct TrafficCar {
    inner: engine::traffic::TrafficCar,
}

impl TrafficCar {
    fn made(
        streets: &Streets,
        (road, lane, at): &OnRoad,
        make: fn(RoutePosition) -> engine::traffic::TrafficCar,
    ) -> PyResult<Self> {
        let start = streets.0.with(|streets| streets.place_on(road, *lane, *at))?;
        start.map(|start| Self { inner: make(start) }).ok_or_else(|| raised("the network of the roads cannot be built"))
    }
}

#[pymethods]
impl TrafficCar {
    #[new]
    fn new(streets: &Streets, start: OnRoad) -> PyResult<Self> {
        Self::made(streets, &start, engine::traffic::TrafficCar::at)
    }

    /// Makes a panel van at a place.
    #[staticmethod]
    fn van(streets: &Streets, start: OnRoad) -> PyResult<Self> {
        Self::made(streets, &start, engine::traffic::TrafficCar::van)
    }

    /// Makes a lorry at a place, for ways that lead straight on.
    #[staticmethod]
    fn truck(streets: &Streets, start: OnRoad) -> PyResult<Self> {
        Self::made(streets, &start, engine::traffic::TrafficCar::truck)
    }

    /// Makes a city bus at a place, for ways that lead straight on.
    #[staticmethod]
    fn bus(streets: &Streets, start: OnRoad) -> PyResult<Self> {
        Self::made(streets, &start, engine::traffic::TrafficCar::bus)
    }

    /// Makes a motorcycle at a place.
    #[staticmethod]
    fn motorcycle(streets: &Streets, start: OnRoad) -> PyResult<Self> {
        Self::made(streets, &start, engine::traffic::TrafficCar::motorcycle)
    }

    /// Makes a bicycle at a place. It drives at up to 5 m/s at the right of its lane.
    #[staticmethod]
    fn bicycle(streets: &Streets, start: OnRoad) -> PyResult<Self> {
        Self::made(streets, &start, engine::traffic::TrafficCar::bicycle)
    }

    /// Makes a car that drives along the shortest route from one place to another, and stays there. It starts `driven` metres after the beginning of
    /// the route.
    #[staticmethod]
    #[pyo3(signature = (streets, start, end, driven = 0.0))]
    fn following(streets: &Streets, start: OnRoad, end: OnRoad, driven: f64) -> PyResult<Self> {
        streets.0.with(|streets| {
            let ends = [&start, &end].map(|(road, lane, at)| streets.place_on(road, *lane, *at));
            let (Some(network), [Some(from), Some(to)]) = (streets.network(), ends) else {
                return Err(raised("the network of the roads cannot be built"));
            };
            let route = network.route(from, to, 0.0).ok_or_else(|| {
                let [(from, lane, _), (to, other, _)] = [&start, &end];
                raised(format!("no route leads from lane {lane} of `{from}` to lane {other} of `{to}`"))
            })?;
            let route = if driven > 0.0 { network.rest_of(&route, driven) } else { route };
            Ok(Self { inner: engine::traffic::TrafficCar::following(&route) })
        })?
    }

    /// Returns the car with another body. `body` has the same form as for `Mover`.
    fn body(&self, body: &Bound<PyAny>) -> PyResult<Self> {
        Ok(Self { inner: self.inner.clone().body(body_of(body)?) })
    }

    /// Returns the car with the speed in m/s at which it drives on a free road.
    fn desired_speed(&self, speed: f64) -> Self {
        Self { inner: self.inner.clone().desired_speed(speed) }
    }

    /// Returns the car with the speed in m/s that it has at the start.
    fn speed(&self, speed: f64) -> Self {
        Self { inner: self.inner.clone().speed(speed) }
    }

    /// Returns the car with a start at its desired speed.
    fn moving(&self) -> Self {
        Self { inner: self.inner.clone().moving() }
    }

    /// Returns the car with a distance in metres to the right of the middle of its lane.
    fn keeping_right(&self, metres: f64) -> Self {
        Self { inner: self.inner.clone().keeping_right(metres) }
    }

    /// Returns a car that changes lanes in order to drive faster.
    fn changing_lanes(&self) -> Self {
        Self { inner: self.inner.clone().changing_lanes() }
    }

    /// Returns a car that does not react to the car under test.
    fn heedless(&self) -> Self {
        Self { inner: self.inner.clone().heedless() }
    }

    /// Returns a similar car with random changes of its size and its driver, which follow from `seed`.
    fn varied(&self, seed: u64) -> Self {
        Self { inner: self.inner.clone().varied(seed) }
    }
}

/// Cars that drive by themselves over the roads, and react to others. They are not placed yet.
#[pyclass(frozen, module = "paracosm")]
pub struct EnvironmentCars(Handle<engine::EnvironmentCars>);

#[pymethods]
impl EnvironmentCars {
    /// Makes a fleet of the given cars.
    #[staticmethod]
    #[pyo3(signature = (streets, cars, seed = 1))]
    fn on(streets: &Streets, cars: Vec<PyRef<TrafficCar>>, #[pyo3(from_py_with = whole)] seed: u64) -> PyResult<Self> {
        let cars = cars.iter().map(|car| car.inner.clone()).collect();
        streets.0.made(|streets| engine::EnvironmentCars::on(streets, cars).seed(seed)).map(Self)
    }

    /// Makes `count` cars at random places of the roads; fewer if there is not enough room.
    #[staticmethod]
    #[pyo3(signature = (streets, count, seed = 1))]
    fn scattered(
        streets: &Streets,
        #[pyo3(from_py_with = whole)] count: usize,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> PyResult<Self> {
        streets.0.made(|streets| engine::EnvironmentCars::scattered(streets, count, seed)).map(Self)
    }

    /// Removes all cars that would start less than `metres` from `place`, and returns the rest.
    fn away_from(&self, place: &Pose, metres: f64) -> PyResult<Self> {
        self.0.made(|cars| cars.clone().away_from(place.inner.position, metres)).map(Self)
    }
}

impl EnvironmentCars {
    /// Places the cars in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<Fleet> {
        let cars = self.0.with(engine::EnvironmentCars::clone)?;
        Ok(Fleet(Handle::new(building, building.with(|scenario| cars.place(scenario))?)))
    }
}

/// The cars in the world that drive by themselves. They are counted from 0.
#[pyclass(frozen, module = "paracosm")]
pub struct Fleet(Handle<engine::Fleet>);

#[pymethods]
impl Fleet {
    fn __len__(&self) -> PyResult<usize> {
        self.0.with(engine::Fleet::count)
    }

    /// Returns the position of a car.
    fn position(&self, #[pyo3(from_py_with = whole)] car: usize) -> PyResult<Stream> {
        self.0.stream(|fleet| fleet.position(car))
    }

    /// Returns the speed of a car in m/s.
    fn speed(&self, #[pyo3(from_py_with = whole)] car: usize) -> PyResult<Stream> {
        self.0.stream(|fleet| fleet.speed(car))
    }

    /// Gives a car a speed in m/s, from which it deviates only to avoid a collision. While the stream is absent, the car drives by its model.
    fn drive(&self, #[pyo3(from_py_with = whole)] car: usize, speed: &Bound<PyAny>) -> PyResult<()> {
        let speed = Operand::numbers(speed, "speed")?;
        self.0.with(|fleet| fleet.drive(car, speed))
    }

    /// Sets the speed in m/s at which a car drives on a free road.
    fn wish(&self, #[pyo3(from_py_with = whole)] car: usize, speed: &Bound<PyAny>) -> PyResult<()> {
        let speed = Operand::numbers(speed, "speed")?;
        self.0.with(|fleet| fleet.wish(car, speed))
    }

    /// Lets a car change to the next lane on a side, "left" or "right", within some seconds when `event` occurs.
    fn change_lane(
        &self,
        #[pyo3(from_py_with = whole)] car: usize,
        side: &str,
        seconds: f64,
        event: &Bound<PyAny>,
    ) -> PyResult<()> {
        let (side, event) = (side_of(side)?, Operand::of(event, "event")?.wire.truths("event")?);
        self.0.with(|fleet| fleet.change_lane(car, side, seconds, &event))
    }
}
