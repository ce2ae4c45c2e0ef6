//! Networks of roads: intersections and roundabouts, joined to a `Composite`, and `Streets` once they are placed.

use super::building::Building;
use super::place::{Line, Path, Pose};
use super::road::RoadSegment;
use crate::error::raised;
use paracosm::engine::{self, Place, Side, road};
use pyo3::prelude::*;
use std::sync::Arc;

/// Parts of a network of roads, joined at their points. It is not placed yet.
#[pyclass(frozen, module = "paracosm")]
#[derive(Clone)]
pub struct Composite {
    inner: road::Composite,
}

impl From<road::Composite> for Composite {
    fn from(inner: road::Composite) -> Self {
        Self { inner }
    }
}

impl Composite {
    /// Joins another part to a point.
    ///
    /// # Errors
    /// `child` is no part of a network.
    pub fn joined(self, point: &str, child: &Bound<PyAny>, child_point: &str) -> PyResult<Self> {
        Ok(self.inner.connect(point, part(child)?, child_point).into())
    }
}

#[pymethods]
impl Composite {
    /// Joins the point `child_point` of another part to the point `point` of these parts. A point of a part with a name is called
    /// "NAME.POINT".
    fn connect(&self, point: &str, child: &Bound<PyAny>, child_point: &str) -> PyResult<Self> {
        self.clone().joined(point, child, child_point)
    }

    /// Joins two points of these parts, which have to lie at the same place.
    fn close(&self, a: &str, b: &str) -> Self {
        self.inner.clone().close(a, b).into()
    }

    /// Builds the network. Build a network that is the same in every test once, outside of the function of the scenario.
    ///
    /// Raises `Error` if the parts do not fit together.
    fn build(&self) -> PyResult<RoadNetwork> {
        Ok(RoadNetwork { inner: self.inner.clone().build().map_err(raised)? })
    }
}

/// Returns a part of a network.
fn part(found: &Bound<PyAny>) -> PyResult<road::Composite> {
    if let Ok(composite) = found.cast::<Composite>() {
        return Ok(composite.get().inner.clone());
    }
    if let Ok(road) = found.cast::<RoadSegment>() {
        return Ok(road.try_borrow()?.composite());
    }
    if let Ok(tee) = found.cast::<TIntersection>() {
        return Ok(tee.get().inner.clone().into());
    }
    if let Ok(cross) = found.cast::<CrossIntersection>() {
        return Ok(cross.get().inner.clone().into());
    }
    if let Ok(ring) = found.cast::<Roundabout>() {
        return Ok(ring.get().inner.clone().into());
    }
    let kind = found.get_type().name()?;
    Err(raised(format!(
        "found a value of the type {kind}, expected a RoadSegment, an intersection, a Roundabout or a Composite"
    )))
}

/// Makes the class of a part of a network.
macro_rules! element {
    ($(#[$doc:meta])* $name:ident, $($(#[$about:meta])* $method:ident: $type:ty),*) => {
        $(#[$doc])*
        #[pyclass(frozen, module = "paracosm")]
        #[derive(Clone)]
        pub struct $name {
            inner: road::$name,
        }

        #[pymethods]
        impl $name {
            #[new]
            fn new() -> Self {
                Self { inner: road::$name::new() }
            }

            $($(#[$about])*
            fn $method(&self, value: $type) -> Self {
                Self { inner: self.inner.clone().$method(value) }
            })*

            /// Returns the part with a number of lanes of its roads, in both directions together.
            fn lanes(&self, lanes: i32) -> Self {
                Self { inner: self.inner.clone().lanes(lanes) }
            }

            /// Returns the part with a width of its lanes in metres.
            fn lane_width(&self, metres: f64) -> Self {
                Self { inner: self.inner.clone().lane_width(metres) }
            }

            /// Returns the part with a width of its sidewalks in metres; 0 for none.
            fn sidewalk(&self, metres: f64) -> Self {
                Self { inner: self.inner.clone().sidewalk(metres) }
            }

            /// Returns the part with a name, by which a network refers to it.
            fn named(&self, name: &str) -> Self {
                Self { inner: self.inner.clone().named(name) }
            }

            /// Joins the point `child_point` of another part to the point `point` of this part.
            fn connect(&self, point: &str, child: &Bound<PyAny>, child_point: &str) -> PyResult<Composite> {
                Composite::from(road::Composite::from(self.inner.clone())).joined(point, child, child_point)
            }
        }
    };
}

element!(
    /// An intersection where a road ends at another road. The arms lead east ("one"), south ("two") and west ("three").
    TIntersection,
    /// Returns the intersection with a radius of its corners in metres.
    corner: f64
);
element!(
    /// An intersection of two roads, with arms east ("one"), south ("two"), west ("three") and north ("four").
    CrossIntersection,
    /// Returns the intersection with a radius of its corners in metres.
    corner: f64
);
element!(
    /// A roundabout with counter-clockwise traffic. Its arms "one", "two", .. lie clockwise from the east.
    Roundabout,
    /// Returns the roundabout with a number of arms.
    arms: i32,
    /// Returns the roundabout with a radius of its island in metres.
    island: f64,
    /// Returns the roundabout with a radius of its entries in metres.
    entry: f64
);

/// Makes a city with a grid of junctions and streets of `block` metres between them. The junctions are called "junction ROW,COLUMN", and the
/// streets that begin there "street ROW,COLUMN east" and "street ROW,COLUMN south".
///
/// Raises `Error` if there are fewer than two rows or columns.
#[pyfunction]
#[pyo3(signature = (rows, columns, block, lanes = 2))]
pub fn grid_city(rows: usize, columns: usize, block: f64, lanes: i32) -> PyResult<Composite> {
    if rows < 2 || columns < 2 {
        return Err(raised(format!("a grid has at least two rows and two columns, found {rows} and {columns}")));
    }
    Ok(road::grid_city(rows, columns, block, lanes).into())
}

/// A network of roads that is built.
#[pyclass(frozen, module = "paracosm")]
pub struct RoadNetwork {
    inner: Arc<road::RoadNetwork>,
}

#[pymethods]
impl RoadNetwork {
    /// The names of the roads, junctions and roundabouts.
    #[getter]
    fn elements(&self) -> Vec<&str> {
        self.inner.elements().collect()
    }

    /// Returns the path along lanes that follow each other. A lane is a pair of a road and a number of a lane; or, through an intersection, a
    /// tuple of the intersection, the arm of the entry, the arm of the exit, and the number of the lane.
    fn path(&self, lanes: Vec<Bound<PyAny>>) -> PyResult<Path> {
        let lane = |found: Bound<PyAny>| {
            if let Ok((road, number)) = found.extract::<(String, i32)>() {
                return self.inner.lane_of(&road, number).map_err(raised);
            }
            let through = found.extract::<(String, String, String, i32)>();
            let (element, from, to, number) = through.map_err(|_| {
                raised(format!(
                    "found {}, expected a lane: (road, number) or (intersection, arm, arm, number)",
                    found.repr().map(|text| text.to_string()).unwrap_or_default()
                ))
            })?;
            self.inner.lane_between(&element, &from, &to, number).map_err(raised)
        };
        let lanes = lanes.into_iter().map(lane).collect::<PyResult<Vec<_>>>()?;
        Ok(self.inner.path(&lanes).into())
    }

    fn __repr__(&self) -> String {
        format!("RoadNetwork({} elements)", self.inner.elements().len())
    }
}

/// A network of roads in the world.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Streets {
    pub building: Building,
    pub inner: engine::Streets,
}

/// Places a network in a scenario; `None` if the object is no network.
///
/// # Errors
/// The scenario has noted a mistake.
pub fn placed(found: &Bound<PyAny>, building: &Building) -> PyResult<Option<Streets>> {
    let inner = match found.cast::<RoadNetwork>() {
        Ok(network) => building.with(|scenario| network.get().inner.clone().place(scenario))?,
        Err(_) => match part(found) {
            Ok(parts) => building.with(|scenario| parts.place(scenario))?,
            Err(_) => return Ok(None),
        },
    };
    Ok(Some(Streets { building: building.clone(), inner }))
}

#[pymethods]
impl Streets {
    /// Returns the pose in the middle of a lane of a road, `at` metres along the road.
    fn on_lane(&self, road: &str, lane: i32, at: f64) -> PyResult<Pose> {
        self.building.with(|_| self.inner.on_lane(road, lane, at)).map(Pose::from)
    }

    /// Returns the pose in the middle of the sidewalk on a side of a road, "left" or "right", `at` metres along the road.
    fn on_sidewalk(&self, road: &str, side: &str, at: f64) -> PyResult<Pose> {
        let side = side_of(side)?;
        self.building.with(|_| self.inner.on_sidewalk(road, side, at)).map(Pose::from)
    }

    /// Returns the line straight across a road, `at` metres along it.
    fn crossing(&self, road: &str, at: f64) -> PyResult<Line> {
        Ok(Line { inner: self.building.with(|_| self.inner.crossing(road, at))? })
    }

    /// Returns the path along the middle of a whole lane of a road.
    fn path(&self, road: &str, lane: i32) -> PyResult<Path> {
        self.building.with(|_| self.inner.path(road, lane)).map(Path::from)
    }

    /// Returns the shortest path between two places without a change of lanes. A place is a road, a lane, and metres along the road.
    fn way(&self, start: (String, i32, f64), end: (String, i32, f64)) -> PyResult<Path> {
        let way = |_: &mut engine::Scenario| self.inner.way((&start.0, start.1, start.2), (&end.0, end.1, end.2));
        self.building.with(way).map(Path::from)
    }
}

/// Reads a side.
///
/// # Errors
/// The text is neither "left" nor "right".
pub fn side_of(side: &str) -> PyResult<Side> {
    match side {
        "left" => Ok(Side::Left),
        "right" => Ok(Side::Right),
        _ => Err(raised(format!("found the side \"{side}\", expected \"left\" or \"right\""))),
    }
}
