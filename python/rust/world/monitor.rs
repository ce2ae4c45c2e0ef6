//! `Monitor`: predefined requirements on the ego vehicle.

use super::ego::Car;
use paracosm::engine::Monitor as Stated;
use pyo3::prelude::*;

/// A predefined requirement on the ego vehicle, for `s.monitor(..)`.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Monitor {
    pub inner: Stated,
}

#[pymethods]
impl Monitor {
    /// Requires that the car touches nobody.
    #[staticmethod]
    fn no_collision(car: &Car) -> Self {
        Self { inner: Stated::no_collision(&car.inner) }
    }

    /// Requires that the car travels at least some metres.
    #[staticmethod]
    fn progress(car: &Car, metres: f64) -> Self {
        Self { inner: Stated::progress(&car.inner, metres) }
    }

    /// Requires that the car comes within some metres of the end of its way.
    #[staticmethod]
    fn route_completion(car: &Car, metres: f64) -> Self {
        Self { inner: Stated::route_completion(&car.inner, metres) }
    }

    /// Requires that the car never stands still for some seconds.
    #[staticmethod]
    fn activity(car: &Car, seconds: f64) -> Self {
        Self { inner: Stated::activity(&car.inner, seconds) }
    }

    /// Requires that the car keeps at least some metres away from all other bodies.
    #[staticmethod]
    fn clearance(car: &Car, metres: f64) -> Self {
        Self { inner: Stated::clearance(&car.inner, metres) }
    }

    /// Requires that the car is never faster than a speed in m/s.
    #[staticmethod]
    fn speed_limit(car: &Car, limit: f64) -> Self {
        Self { inner: Stated::speed_limit(&car.inner, limit) }
    }

    /// Requires that the time to collision is never below some seconds.
    #[staticmethod]
    fn time_to_collision(car: &Car, seconds: f64) -> Self {
        Self { inner: Stated::time_to_collision(&car.inner, seconds) }
    }

    /// Requires that the time headway to the body straight ahead is never below some seconds.
    #[staticmethod]
    fn headway(car: &Car, seconds: f64) -> Self {
        Self { inner: Stated::headway(&car.inner, seconds) }
    }

    /// Requires that the whole car stays in a lane of its own direction.
    #[staticmethod]
    fn lane_keeping(car: &Car) -> Self {
        Self { inner: Stated::lane_keeping(&car.inner) }
    }

    /// Requires that the car's middle stays within some metres of its way.
    #[staticmethod]
    fn on_its_way(car: &Car, metres: f64) -> Self {
        Self { inner: Stated::on_its_way(&car.inner, metres) }
    }

    /// Requires that the acceleration along the heading never changes faster than a limit in m/s³.
    #[staticmethod]
    fn jerk(car: &Car, limit: f64) -> Self {
        Self { inner: Stated::jerk(&car.inner, limit) }
    }

    /// Requires that nobody with the right of way reaches the car's place in an intersection within some seconds.
    #[staticmethod]
    fn right_of_way(car: &Car, seconds: f64) -> Self {
        Self { inner: Stated::right_of_way(&car.inner, seconds) }
    }
}
