//! `Streets`: a network of roads in the world.

use super::handle::Handle;
use super::place::{Line, Path, Pose};
use crate::error::raised;
use paracosm::engine::{self, Side};
use pyo3::prelude::*;

/// A network of roads in the world.
#[pyclass(frozen, module = "paracosm")]
pub struct Streets(pub Handle<engine::Streets>);

#[pymethods]
impl Streets {
    /// Returns the pose in the middle of a lane of a road, `at` metres along the road.
    fn on_lane(&self, road: &str, lane: i32, at: f64) -> PyResult<Pose> {
        self.0.with(|streets| streets.on_lane(road, lane, at)).map(Pose::from)
    }

    /// Returns the pose in the middle of the sidewalk on a side of a road, "left" or "right", `at` metres along the road.
    fn on_sidewalk(&self, road: &str, side: &str, at: f64) -> PyResult<Pose> {
        let side = side_of(side)?;
        self.0.with(|streets| streets.on_sidewalk(road, side, at)).map(Pose::from)
    }

    /// Returns the line straight across a road, `at` metres along it.
    fn crossing(&self, road: &str, at: f64) -> PyResult<Line> {
        Ok(Line { inner: self.0.with(|streets| streets.crossing(road, at))? })
    }

    /// Returns the path along the middle of a whole lane of a road.
    fn path(&self, road: &str, lane: i32) -> PyResult<Path> {
        self.0.with(|streets| streets.path(road, lane)).map(Path::from)
    }

    /// Returns the shortest path between two places without a change of lanes. A place is a road, a lane, and metres along the road.
    fn way(&self, start: (String, i32, f64), end: (String, i32, f64)) -> PyResult<Path> {
        let way = |streets: &engine::Streets| streets.way((&start.0, start.1, start.2), (&end.0, end.1, end.2));
        self.0.with(way).map(Path::from)
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
