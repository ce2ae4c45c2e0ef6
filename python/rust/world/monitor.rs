//! `Monitor`: predefined requirements on the ego vehicle.

use super::ego::Car;
use super::handle::Handle;
use paracosm::engine::{self, Monitor as Stated};
use pyo3::prelude::*;

/// A predefined requirement on the ego vehicle, for `s.monitor(..)`.
#[pyclass(frozen, module = "paracosm")]
pub struct Monitor(Handle<Stated>);

impl Monitor {
    fn on(car: &Car, state: impl FnOnce(&engine::Car) -> Stated) -> PyResult<Self> {
        car.0.made(state).map(Self)
    }

    /// Returns the requirement of the library.
    ///
    /// # Errors
    /// The requirement belongs to the world of another test.
    pub fn inner(&self) -> PyResult<Stated> {
        self.0.with(Stated::clone)
    }
}

#[pymethods]
impl Monitor {
    /// Requires that the car touches nobody.
    #[staticmethod]
    fn no_collision(car: &Car) -> PyResult<Self> {
        Self::on(car, Stated::no_collision)
    }

    /// Requires that the car travels at least some metres.
    #[staticmethod]
    fn progress(car: &Car, metres: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::progress(car, metres))
    }

    /// Requires that the car comes within some metres of the end of its way.
    #[staticmethod]
    fn route_completion(car: &Car, metres: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::route_completion(car, metres))
    }

    /// Requires that the car never stands still for some seconds.
    #[staticmethod]
    fn activity(car: &Car, seconds: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::activity(car, seconds))
    }

    /// Requires that the car keeps at least some metres away from all other bodies.
    #[staticmethod]
    fn clearance(car: &Car, metres: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::clearance(car, metres))
    }

    /// Requires that the car is never faster than a speed in m/s.
    #[staticmethod]
    fn speed_limit(car: &Car, limit: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::speed_limit(car, limit))
    }

    /// Requires that the time to collision is never below some seconds.
    #[staticmethod]
    fn time_to_collision(car: &Car, seconds: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::time_to_collision(car, seconds))
    }

    /// Requires that the time headway to the body straight ahead is never below some seconds.
    #[staticmethod]
    fn headway(car: &Car, seconds: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::headway(car, seconds))
    }

    /// Requires that the whole car stays in a lane of its own direction.
    #[staticmethod]
    fn lane_keeping(car: &Car) -> PyResult<Self> {
        Self::on(car, Stated::lane_keeping)
    }

    /// Requires that the car's middle stays within some metres of its way.
    #[staticmethod]
    fn on_its_way(car: &Car, metres: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::on_its_way(car, metres))
    }

    /// Requires that the acceleration along the heading never changes faster than a limit in m/s³.
    #[staticmethod]
    fn jerk(car: &Car, limit: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::jerk(car, limit))
    }

    /// Requires that nobody with the right of way reaches the car's place in an intersection within some seconds.
    #[staticmethod]
    fn right_of_way(car: &Car, seconds: f64) -> PyResult<Self> {
        Self::on(car, |car| Stated::right_of_way(car, seconds))
    }
}
