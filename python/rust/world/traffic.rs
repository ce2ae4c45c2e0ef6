//! Cars that drive by themselves.

use super::building::Building;
use super::network::{Streets, side_of};
use super::place::Pose;
use super::stream::Stream;
use super::wire::Operand;
use paracosm::engine::{self, Place};
use pyo3::prelude::*;

/// Cars that drive by themselves over the roads, and react to others. They are not placed yet.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct EnvironmentCars {
    inner: engine::EnvironmentCars,
}

#[pymethods]
impl EnvironmentCars {
    /// Makes `count` cars at random places of the roads; fewer if there is not enough room.
    #[staticmethod]
    #[pyo3(signature = (streets, count, seed = 1))]
    fn scattered(streets: &Streets, count: usize, seed: u64) -> PyResult<Self> {
        Ok(Self { inner: streets.building.with(|_| engine::EnvironmentCars::scattered(&streets.inner, count, seed))? })
    }

    /// Returns the cars without those that would start within some metres of a place.
    fn away_from(&self, place: &Pose, metres: f64) -> Self {
        Self { inner: self.inner.clone().away_from(place.inner.position, metres) }
    }
}

impl EnvironmentCars {
    /// Places the cars in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<Fleet> {
        let inner = building.with(|scenario| self.inner.clone().place(scenario))?;
        Ok(Fleet { building: building.clone(), inner })
    }
}

/// The cars in the world that drive by themselves. They are counted from 0.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Fleet {
    building: Building,
    inner: engine::Fleet,
}

#[pymethods]
impl Fleet {
    fn __len__(&self) -> usize {
        self.inner.count()
    }

    /// Returns the position of a car.
    fn position(&self, car: usize) -> PyResult<Stream> {
        Ok(Stream::of(&self.building, self.building.with(|_| self.inner.position(car))?))
    }

    /// Returns the speed of a car in m/s.
    fn speed(&self, car: usize) -> PyResult<Stream> {
        Ok(Stream::of(&self.building, self.building.with(|_| self.inner.speed(car))?))
    }

    /// Gives a car a speed in m/s, from which it deviates only to avoid a collision. While the stream is absent, the car drives by its model.
    fn drive(&self, car: usize, speed: &Bound<PyAny>) -> PyResult<()> {
        let speed = Operand::numbers(speed, "speed")?;
        self.building.with(|_| self.inner.drive(car, speed))
    }

    /// Sets the speed in m/s at which a car drives on a free road.
    fn wish(&self, car: usize, speed: &Bound<PyAny>) -> PyResult<()> {
        let speed = Operand::numbers(speed, "speed")?;
        self.building.with(|_| self.inner.wish(car, speed))
    }

    /// Lets a car change to the next lane on a side, "left" or "right", within some seconds when `event` occurs.
    fn change_lane(&self, car: usize, side: &str, seconds: f64, event: &Bound<PyAny>) -> PyResult<()> {
        let (side, event) = (side_of(side)?, Operand::of(event, "event")?.wire.truths("event")?);
        self.building.with(|_| self.inner.change_lane(car, side, seconds, &event))
    }
}
