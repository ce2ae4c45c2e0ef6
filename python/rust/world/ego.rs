//! The car under test: `AutonomousVehicle`, and `Car` once it is placed.

use super::building::Building;
use super::place::{Line, Path, Pose};
use super::stream::Stream;
use crate::error::raised;
use paracosm::engine::object::Class;
use paracosm::engine::{self, Place};
use paracosm::space::{did_you_mean, nearest};
use pyo3::prelude::*;

/// The ego vehicle before it is placed. It starts at a pose and drives straight on, or it follows a path (`along`).
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct AutonomousVehicle {
    inner: engine::AutonomousVehicle,
}

#[pymethods]
impl AutonomousVehicle {
    #[new]
    fn new(start: &Pose) -> Self {
        Self { inner: engine::AutonomousVehicle::at(start.inner) }
    }

    /// Makes a car at the beginning of a path, which is the way that the car is to go.
    #[staticmethod]
    fn along(way: &Path) -> Self {
        Self { inner: engine::AutonomousVehicle::along(way.inner.clone()) }
    }

    /// Returns the car with its start in metres along its way.
    fn starting(&self, at: f64) -> Self {
        Self { inner: self.inner.clone().starting(at) }
    }

    /// Returns the car with the speed in m/s at which it starts, and that its driver is to keep. The speed is a number, such as
    /// `parameter.value()`, because the driver changes it later.
    fn speed(&self, speed: &Bound<PyAny>) -> PyResult<Self> {
        if speed.cast::<Stream>().is_ok() {
            return Err(raised(
                "the speed of the car under test is a number, because its driver changes it later: write `parameter.value()`",
            ));
        }
        Ok(Self { inner: self.inner.clone().speed(speed.extract()?) })
    }
}

impl AutonomousVehicle {
    /// Places the car in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<Car> {
        let inner = building.with(|scenario| self.inner.clone().place(scenario))?;
        Ok(Car { building: building.clone(), inner })
    }
}

/// The car under test in the world, with its signals as streams.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Car {
    building: Building,
    pub inner: engine::Car,
}

#[pymethods]
impl Car {
    /// Returns the position of the car's middle.
    fn position(&self) -> Stream {
        Stream::of(&self.building, self.inner.position())
    }

    /// Returns the car's heading, in radians in (-π, π], counter-clockwise from x.
    fn heading(&self) -> Stream {
        Stream::of(&self.building, self.inner.heading())
    }

    /// Returns the car's speed in m/s.
    fn speed(&self) -> Stream {
        Stream::of(&self.building, self.inner.speed())
    }

    /// Returns the car's forward acceleration over the last tick, in m/s².
    fn acceleration(&self) -> Stream {
        Stream::of(&self.building, self.inner.acceleration())
    }

    /// Returns the distance that the car has covered, in metres.
    fn travelled(&self) -> Stream {
        Stream::of(&self.building, self.inner.travelled())
    }

    /// Returns the distance to the nearest other body in metres; bodies on the `Roadside` do not
    /// count. At a contact: minus the missing braking distance, max(v²/(2 μ g), 0.001), with v the speed at which the
    /// car and the body close along the heading of the car, or 0 if they do not close.
    fn clearance(&self) -> Stream {
        Stream::of(&self.building, self.inner.clearance())
    }

    /// Returns a stream that is true while the car touches another body.
    fn collides(&self) -> Stream {
        Stream::of(&self.building, self.inner.collides())
    }

    /// Returns the car's acceleration to the left in m/s².
    fn lateral_acceleration(&self) -> Stream {
        Stream::of(&self.building, self.inner.lateral_acceleration())
    }

    /// Returns the car's yaw rate, to the left, in rad/s.
    fn yaw_rate(&self) -> Stream {
        Stream::of(&self.building, self.inner.yaw_rate())
    }

    /// Returns the rate at which the car's forward acceleration changes, in m/s³.
    fn jerk(&self) -> Stream {
        Stream::of(&self.building, self.inner.jerk())
    }

    /// Returns the greatest absolute slip ratio of the car's wheels; 0 if all wheels roll, 1 if a wheel is locked or
    /// spins in place.
    fn wheel_slip(&self) -> Stream {
        Stream::of(&self.building, self.inner.wheel_slip())
    }

    /// Returns the greatest absolute slip angle of the car's wheels, in radians.
    fn slip_angle(&self) -> Stream {
        Stream::of(&self.building, self.inner.slip_angle())
    }

    /// Returns the number of the car's wheels that touch the road.
    fn wheels_on_road(&self) -> Stream {
        Stream::of(&self.building, self.inner.wheels_on_road())
    }

    /// Returns the least time to collision with another body, in seconds; infinite without a collision course.
    fn time_to_collision(&self) -> Stream {
        Stream::of(&self.building, self.inner.time_to_collision())
    }

    /// Returns the time headway in seconds, which is the time that the car takes to the present place of the nearest
    /// body straight ahead; infinite without such a body.
    fn headway(&self) -> Stream {
        Stream::of(&self.building, self.inner.headway())
    }

    /// Returns the free width of the lane beside the car on the narrower side, in metres; negative beyond the edge.
    fn lane_margin(&self) -> Stream {
        Stream::of(&self.building, self.inner.lane_margin())
    }

    /// Returns the seconds until a road user with the right of way comes to the car's place in an intersection;
    /// infinite if no road user comes.
    fn right_of_way(&self) -> Stream {
        Stream::of(&self.building, self.inner.right_of_way())
    }

    /// Returns the distance of the car from the way that the car is to go, in metres, positive to the left of the way.
    fn way_offset(&self) -> Stream {
        Stream::of(&self.building, self.inner.way_offset())
    }

    /// Returns the seconds for which the car has been standing; 0 while the car moves.
    fn standing_time(&self) -> Stream {
        Stream::of(&self.building, self.inner.standing_time())
    }

    /// Returns the metres to the end of the way that the car is to go; infinite if the way has no end.
    fn remaining(&self) -> Stream {
        Stream::of(&self.building, self.inner.remaining())
    }

    /// Returns the distance in metres from the front of the car to a line ahead.
    fn gap_along(&self, line: &Line) -> Stream {
        Stream::of(&self.building, self.inner.gap_along(&line.inner))
    }

    /// Returns the clearance of the car to the nearest body of a class, such as "pedestrian".
    fn clearance_to(&self, kind: &str) -> PyResult<Stream> {
        Ok(Stream::of(&self.building, self.inner.clearance_to(class_of(kind)?)))
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
