//! Roads, intersections and roundabouts that are not placed yet, alone or joined to a `Composite`.

use super::building::Building;
use super::handle::Handle;
use super::place::Path;
use super::recipe::Quantity;
use super::road::Road;
use super::streets::Streets;
use crate::error::raised;
use crate::whole::whole;
use paracosm::engine::{self, Place, road};
use paracosm::standards::opendrive::Map;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::path::PathBuf;
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
        Ok(RoadNetwork { inner: self.inner.clone().build().map_err(raised)?, file: None })
    }
}

/// A straight road of a length in metres, which is not placed yet. It begins at the origin and leads along x. Its points are "one" (the start) and
/// "two" (the end).
#[pyclass(frozen, module = "paracosm")]
#[derive(Clone)]
pub struct RoadSegment {
    inner: engine::RoadSegment,
    friction: Option<Quantity>,
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
        let friction = self.friction.as_ref().map(Quantity::stream).transpose()?;
        let road = building.with(|scenario| match friction {
            Some(friction) => road.friction(friction).place(scenario),
            None => road.place(scenario),
        })?;
        Ok(Road(Handle::new(building, road)))
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
        Ok(Self { inner: self.inner.clone(), friction: Some(Quantity::of(friction, "friction")?) })
    }

    /// Joins the point `child_point` of another part to the point `point` of this road.
    fn connect(&self, point: &str, child: &Bound<PyAny>, child_point: &str) -> PyResult<Composite> {
        Composite::from(self.composite()).joined(point, child, child_point)
    }
}

/// Returns a part of a network.
fn part(found: &Bound<PyAny>) -> PyResult<road::Composite> {
    if let Ok(composite) = found.cast::<Composite>() {
        return Ok(composite.get().inner.clone());
    }
    if let Ok(road) = found.cast::<RoadSegment>() {
        return Ok(road.get().composite());
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

/// Makes the parts of a city, to be built by `build()`: a grid of junctions and streets of `block` metres between them. The junctions are called "junction ROW,COLUMN", and the
/// streets that begin there "street ROW,COLUMN east" and "street ROW,COLUMN south".
///
/// Raises `Error` if there are fewer than two rows or columns.
#[pyfunction]
#[pyo3(signature = (rows, columns, block, lanes = 2))]
pub fn grid_city(
    #[pyo3(from_py_with = whole)] rows: usize,
    #[pyo3(from_py_with = whole)] columns: usize,
    block: f64,
    lanes: i32,
) -> PyResult<Composite> {
    if rows < 2 || columns < 2 {
        return Err(raised(format!("a grid has at least two rows and two columns, found {rows} and {columns}")));
    }
    Ok(road::grid_city(rows, columns, block, lanes).into())
}

/// A network of roads that is built.
#[pyclass(frozen, module = "paracosm")]
pub struct RoadNetwork {
    inner: Arc<road::RoadNetwork>,
    /// The file that has the roads, with its hash; `None` for roads of a program.
    file: Option<(PathBuf, String)>,
}

#[pymethods]
impl RoadNetwork {
    /// Reads the roads of a file of ASAM OpenDRIVE. The elements have the ids of the file, and lanes their numbers. Read a file once, outside of the
    /// function of the scenario.
    ///
    /// Raises `Error` if the file cannot be read, is not valid, or has an element that is not supported.
    #[staticmethod]
    fn read(py: Python, file: PathBuf) -> PyResult<Self> {
        let map = Map::read(&file).map_err(raised)?;
        let inner = map.network().map_err(|error| raised(format!("{}: {error}", file.display())))?;
        let hash = py.import("paracosm._scenarios")?.call_method1("_hash", (&file,))?.extract()?;
        Ok(Self { inner, file: Some((file, hash)) })
    }

    /// Says how to read the file again from a pickle.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (PathBuf,))> {
        let Some((file, _)) = &self.file else {
            return Err(PyTypeError::new_err("cannot pickle a RoadNetwork that does not come from a file"));
        };
        Ok((py.get_type::<Self>().getattr("read")?, (file.clone(),)))
    }

    /// The names of the roads, junctions and roundabouts.
    #[getter]
    fn elements(&self) -> Vec<&str> {
        self.inner.elements().collect()
    }

    /// Returns the path along lanes that follow each other. A road has the points "one" (its start) and "two". A lane is a pair of a road and a number of a lane; or, through an intersection, a
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
        if let Some(at) = lanes.windows(2).position(|pair| !self.inner.lane(pair[0]).successors.contains(&pair[1])) {
            let (one, other) = (at + 1, at + 2);
            return Err(raised(format!(
                "lane {other} of the path does not begin where lane {one} ends (counted from 1)"
            )));
        }
        Ok(self.inner.path(&lanes).into())
    }

    fn __repr__(&self) -> String {
        format!("RoadNetwork({} elements)", self.inner.elements().len())
    }
}

/// Places a network in a scenario; `None` if the object is no network.
///
/// # Errors
/// The scenario has noted a mistake.
pub fn placed(found: &Bound<PyAny>, building: &Building) -> PyResult<Option<Streets>> {
    let inner = match found.cast::<RoadNetwork>() {
        Ok(network) => {
            let RoadNetwork { inner, file } = network.get();
            file.iter().cloned().for_each(|file| building.reads(file));
            building.with(|scenario| inner.clone().place(scenario))?
        }
        Err(_) => match part(found) {
            Ok(parts) => building.with(|scenario| parts.place(scenario))?,
            Err(_) => return Ok(None),
        },
    };
    Ok(Some(Streets(Handle::new(building, inner))))
}
