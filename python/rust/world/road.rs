//! `RoadSegment`, which is a road that is not placed yet, and `Road`.

use super::building::Building;
use super::network::{Composite, Streets, side_of};
use super::place::{Line, Path, Pose};
use super::wire::Operand;
use paracosm::engine::{self, Place, road};
use pyo3::prelude::*;

/// A straight road of a length in metres, which is not placed yet. It begins at the origin and leads along x.
#[pyclass(frozen, unsendable, module = "paracosm")]
#[derive(Clone)]
pub struct RoadSegment {
    inner: engine::RoadSegment,
    friction: Option<engine::Stream<f64>>,
}

impl RoadSegment {
    fn changed(&self, change: impl FnOnce(engine::RoadSegment) -> engine::RoadSegment) -> Self {
        Self { inner: change(self.inner.clone()), friction: self.friction.clone() }
    }

    /// Places the road in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<Road> {
        let road = self.inner.clone();
        let inner = building.with(|scenario| match self.friction.clone() {
            Some(friction) => road.friction(friction).place(scenario),
            None => road.place(scenario),
        })?;
        Ok(Road { building: building.clone(), inner })
    }

    /// Returns the road as a part of a network.
    pub fn composite(&self) -> road::Composite {
        self.inner.clone().into()
    }
}

#[pymethods]
impl RoadSegment {
    #[new]
    fn new(length: f64) -> Self {
        Self { inner: engine::RoadSegment::new(length), friction: None }
    }

    /// Makes a road along an arc. `radius` is in metres, and `angle` in radians, positive to the left.
    #[staticmethod]
    fn arc(radius: f64, angle: f64) -> Self {
        Self { inner: engine::RoadSegment::arc(radius, angle), friction: None }
    }

    /// Returns the road with a number of lanes in both directions together.
    fn lanes(&self, lanes: i32) -> Self {
        self.changed(|road| road.lanes(lanes))
    }

    /// Returns the road with a width of its lanes in metres.
    fn lane_width(&self, metres: f64) -> Self {
        self.changed(|road| road.lane_width(metres))
    }

    /// Returns the road with a width of its sidewalks in metres; 0 for none.
    fn sidewalk(&self, metres: f64) -> Self {
        self.changed(|road| road.sidewalk(metres))
    }

    /// Returns the road with a zebra crossing `at` metres along it.
    fn zebra(&self, at: f64) -> Self {
        self.changed(|road| road.zebra(at))
    }

    /// Returns the road with a name, by which a network refers to it.
    fn named(&self, name: &str) -> Self {
        self.changed(|road| road.named(name))
    }

    /// Returns the road with a friction coefficient between tyre and road: a number or a stream.
    fn friction(&self, friction: &Bound<PyAny>) -> PyResult<Self> {
        Ok(Self { inner: self.inner.clone(), friction: Some(Operand::numbers(friction, "friction")?) })
    }

    /// Joins the point `child_point` of another part to the point `point` of this road.
    fn connect(&self, point: &str, child: &Bound<PyAny>, child_point: &str) -> PyResult<Composite> {
        Composite::from(self.composite()).joined(point, child, child_point)
    }
}

/// A road in the world.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Road {
    building: Building,
    inner: engine::Road,
}

#[pymethods]
impl Road {
    /// Returns the pose in the middle of a lane, `at` metres along the road, in the direction of its traffic. Lanes 1, 2, .. lead along the
    /// road, from the centre line to the right; lanes -1, -2, .. lead back.
    fn on_lane(&self, lane: i32, at: f64) -> PyResult<Pose> {
        self.building.with(|_| self.inner.on_lane(lane, at)).map(Pose::from)
    }

    /// Returns the pose in the middle of the sidewalk on a side, "left" or "right", `at` metres along the road. It faces the road.
    fn on_sidewalk(&self, side: &str, at: f64) -> PyResult<Pose> {
        let side = side_of(side)?;
        self.building.with(|_| self.inner.on_sidewalk(side, at)).map(Pose::from)
    }

    /// Returns the line straight across the road, `at` metres along it.
    fn crossing(&self, at: f64) -> PyResult<Line> {
        Ok(Line { inner: self.building.with(|_| self.inner.crossing(at))? })
    }

    /// Returns the path along the middle of a whole lane, in the direction of its traffic.
    fn path(&self, lane: i32) -> PyResult<Path> {
        self.building.with(|_| self.inner.path(lane)).map(Path::from)
    }

    /// The network of which the road is the only part.
    #[getter]
    fn streets(&self) -> Streets {
        Streets { building: self.building.clone(), inner: self.inner.streets().clone() }
    }
}
