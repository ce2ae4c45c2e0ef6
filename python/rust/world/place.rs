//! Places in the plane: poses, lines across a road, and paths.

use nalgebra::Vector2;
use paracosm::engine::{self, road};
use pyo3::prelude::*;

/// A place in the plane with a direction: `x` and `y` in metres, and `heading` in radians, counter-clockwise from x.
#[pyclass(frozen, module = "paracosm")]
#[derive(Clone)]
pub struct Pose {
    pub inner: engine::Pose,
}

impl From<engine::Pose> for Pose {
    fn from(inner: engine::Pose) -> Self {
        Self { inner }
    }
}

#[pymethods]
impl Pose {
    #[new]
    #[pyo3(signature = (x, y, heading = 0.0))]
    fn new(x: f64, y: f64, heading: f64) -> Self {
        engine::Pose { position: Vector2::new(x, y), heading }.into()
    }

    /// The first coordinate in metres.
    #[getter]
    fn x(&self) -> f64 {
        self.inner.position.x
    }

    /// The second coordinate in metres.
    #[getter]
    fn y(&self) -> f64 {
        self.inner.position.y
    }

    /// The direction in radians, counter-clockwise from x.
    #[getter]
    fn heading(&self) -> f64 {
        self.inner.heading
    }

    /// Returns the pose with the same heading that lies `forward` metres ahead and `left` metres to the left.
    #[pyo3(signature = (forward = 0.0, left = 0.0))]
    fn moved(&self, forward: f64, left: f64) -> Self {
        let position = self.inner.position + self.inner.forward() * forward + self.inner.left() * left;
        engine::Pose { position, ..self.inner }.into()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.inner == other.inner
    }

    fn __repr__(&self) -> String {
        format!("Pose({}, {}, {})", self.inner.position.x, self.inner.position.y, self.inner.heading)
    }
}

/// A line straight across a road, to which distances are measured: `road.crossing(at)`.
#[pyclass(frozen, module = "paracosm")]
pub struct Line {
    pub inner: engine::Line,
}

/// A path in the plane, such as the middle of a lane: `road.path(lane)`.
#[pyclass(frozen, module = "paracosm")]
pub struct Path {
    pub inner: road::Path,
}

impl From<road::Path> for Path {
    fn from(inner: road::Path) -> Self {
        Self { inner }
    }
}

#[pymethods]
impl Path {
    /// Makes the straight path from one pose to another; their headings do not matter.
    #[staticmethod]
    fn straight(from_: &Pose, to: &Pose) -> Self {
        road::Path::straight(from_.inner.position, to.inner.position).into()
    }

    /// The length in metres.
    #[getter]
    fn length(&self) -> f64 {
        self.inner.length()
    }

    /// Returns the pose `at` metres along the path.
    fn at(&self, at: f64) -> Pose {
        self.inner.at(at).into()
    }

    /// Returns the part of the path from one place to another, in metres along the path.
    fn piece(&self, start: f64, end: f64) -> Self {
        self.inner.piece(start, end).into()
    }

    /// Returns the path in the other direction.
    fn reversed(&self) -> Self {
        self.inner.reversed().into()
    }

    /// Returns the path `left` metres to the left; to the right if `left` is negative.
    fn shifted(&self, left: f64) -> Self {
        self.inner.shifted(left).into()
    }

    fn __repr__(&self) -> String {
        format!("Path(of {} m)", self.inner.length())
    }
}
