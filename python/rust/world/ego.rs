//! The car under test: `AutonomousVehicle`, and `Car` once it is placed.

use super::building::Building;
use super::handle::Handle;
use super::place::{Line, Path, Pose};
use super::recipe::Recipe;
use super::stream::Stream;
use crate::error::raised;
use paracosm::engine::object::Class;
use paracosm::engine::{self, Place};
use paracosm::space::{did_you_mean, nearest};
use pyo3::prelude::*;

/// The ego vehicle before it is placed. It starts at a pose and drives straight on, or it follows a path (`along`).
#[pyclass(frozen, module = "paracosm")]
pub struct AutonomousVehicle(Recipe<engine::AutonomousVehicle>);

#[pymethods]
impl AutonomousVehicle {
    #[new]
    fn new(start: &Pose) -> Self {
        let start = start.inner;
        Self(Recipe::new(move || engine::AutonomousVehicle::at(start)))
    }

    /// Makes a car at the beginning of a path, which is the way that the car is to go.
    #[staticmethod]
    fn along(way: &Path) -> Self {
        let way = way.inner.clone();
        Self(Recipe::new(move || engine::AutonomousVehicle::along(way.clone())))
    }

    /// Returns the car with its start in metres along its way.
    fn starting(&self, at: f64) -> Self {
        Self(self.0.then(move |car| Ok(car.starting(at))))
    }

    /// Returns the car with the speed in m/s at which it starts, and that its driver is to keep. The speed is a number, such as
    /// `parameter.value()`, because the driver changes it later.
    fn speed(&self, speed: &Bound<PyAny>) -> PyResult<Self> {
        if speed.cast::<Stream>().is_ok() {
            return Err(raised(
                "the speed of the car under test is a number, because its driver changes it later: write `parameter.value()`",
            ));
        }
        let speed: f64 = speed.extract()?;
        Ok(Self(self.0.then(move |car| Ok(car.speed(speed)))))
    }
}

impl AutonomousVehicle {
    /// Places the car in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<Car> {
        let car = self.0.make()?;
        Ok(Car(Handle::new(building, building.with(|scenario| car.place(scenario))?)))
    }
}

/// The car under test in the world, with its signals as streams.
#[pyclass(frozen, module = "paracosm")]
pub struct Car(pub Handle<engine::Car>);

#[pymethods]
impl Car {
    /// Returns the position of the car's middle.
    fn position(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::position)
    }

    /// Returns the car's heading, in radians in (-π, π], counter-clockwise from x.
    fn heading(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::heading)
    }

    /// Returns the car's speed in m/s.
    fn speed(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::speed)
    }

    /// Returns the car's forward acceleration over the last tick, in m/s².
    fn acceleration(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::acceleration)
    }

    /// Returns the distance that the car has covered, in metres.
    fn travelled(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::travelled)
    }

    /// Returns the distance to the nearest other body in metres; bodies on the `Roadside` do not
    /// count. At a contact: minus the missing braking distance, max(v²/(2 μ g), 0.001), with v the speed at which the
    /// car and the body close along the heading of the car, or 0 if they do not close.
    fn clearance(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::clearance)
    }

    /// Returns a stream that is true while the car touches another body.
    fn collides(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::collides)
    }

    /// Returns the car's acceleration to the left in m/s².
    fn lateral_acceleration(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::lateral_acceleration)
    }

    /// Returns the car's yaw rate, to the left, in rad/s.
    fn yaw_rate(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::yaw_rate)
    }

    /// Returns the rate at which the car's forward acceleration changes, in m/s³.
    fn jerk(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::jerk)
    }

    /// Returns the greatest absolute slip ratio of the car's wheels; 0 if all wheels roll, 1 if a wheel is locked or
    /// spins in place.
    fn wheel_slip(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::wheel_slip)
    }

    /// Returns the greatest absolute slip angle of the car's wheels, in radians.
    fn slip_angle(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::slip_angle)
    }

    /// Returns the number of the car's wheels that touch the road.
    fn wheels_on_road(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::wheels_on_road)
    }

    /// Returns the least time to collision with another body, in seconds; infinite without a collision course.
    fn time_to_collision(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::time_to_collision)
    }

    /// Returns the time headway in seconds, which is the time that the car takes to the present place of the nearest
    /// body straight ahead; infinite without such a body.
    fn headway(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::headway)
    }

    /// Returns the free width of the lane beside the car on the narrower side, in metres; negative beyond the edge.
    fn lane_margin(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::lane_margin)
    }

    /// Returns the seconds until a road user with the right of way comes to the car's place in an intersection;
    /// infinite if no road user comes.
    fn right_of_way(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::right_of_way)
    }

    /// Returns the distance of the car from the way that the car is to go, in metres, positive to the left of the way.
    fn way_offset(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::way_offset)
    }

    /// Returns the seconds for which the car has been standing; 0 while the car moves.
    fn standing_time(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::standing_time)
    }

    /// Returns the metres to the end of the way that the car is to go; infinite if the way has no end.
    fn remaining(&self) -> PyResult<Stream> {
        self.0.stream(engine::Car::remaining)
    }

    /// Returns the distance in metres from the front of the car to a line ahead.
    fn gap_along(&self, line: &Line) -> PyResult<Stream> {
        self.0.stream(|car| car.gap_along(&line.inner))
    }

    /// Returns the clearance of the car to the nearest body of a class, such as "pedestrian".
    fn clearance_to(&self, kind: &str) -> PyResult<Stream> {
        let class = class_of(kind)?;
        self.0.stream(|car| car.clearance_to(class))
    }
}

/// Returns the class of bodies with a name.
///
/// # Errors
/// There is no such class.
pub fn class_of(name: &str) -> PyResult<Class> {
    let names = Class::ALL.map(|class| class.to_string());
    let found = Class::ALL.into_iter().find(|class| class.to_string() == name);
    found.ok_or_else(|| {
        let meant = did_you_mean(&nearest(name, names.iter().map(String::as_str)));
        raised(format!("no class of bodies is called `{name}`{meant}; the classes are {}", names.join(", ")))
    })
}
