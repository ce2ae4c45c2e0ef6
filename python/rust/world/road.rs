//! `Road`: a single road in the world.

use super::handle::Handle;
use super::place::{Line, Path, Pose};
use super::streets::{Streets, side_of};
use paracosm::engine;
use pyo3::prelude::*;

/// A road in the world.
#[pyclass(frozen, module = "paracosm")]
pub struct Road(pub Handle<engine::Road>);

#[pymethods]
impl Road {
    /// Returns the pose in the middle of a lane, `at` metres along the road, in the direction of its traffic. Lanes 1, 2, .. lead along the
    /// road, from the centre line to the right; lanes -1, -2, .. lead back.
    fn on_lane(&self, lane: i32, at: f64) -> PyResult<Pose> {
        self.0.with(|road| road.on_lane(lane, at)).map(Pose::from)
    }

    /// Returns the pose in the middle of the sidewalk on a side, "left" or "right", `at` metres along the road. It faces the road.
    fn on_sidewalk(&self, side: &str, at: f64) -> PyResult<Pose> {
        let side = side_of(side)?;
        self.0.with(|road| road.on_sidewalk(side, at)).map(Pose::from)
    }

    /// Returns the line straight across the road, `at` metres along it.
    fn crossing(&self, at: f64) -> PyResult<Line> {
        Ok(Line { inner: self.0.with(|road| road.crossing(at))? })
    }

    /// Returns the path along the middle of a whole lane, in the direction of its traffic.
    fn path(&self, lane: i32) -> PyResult<Path> {
        self.0.with(|road| road.path(lane)).map(Path::from)
    }

    /// The network of which the road is the only part.
    #[getter]
    fn streets(&self) -> PyResult<Streets> {
        self.0.made(|road| road.streets().clone()).map(Streets)
    }
}
