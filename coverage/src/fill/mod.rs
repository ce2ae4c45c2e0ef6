//! Fill distance.

mod hunt;
mod relaxation;
mod search;
mod tree;

use crate::{Bracket, Deadline, PointSet};
use hunt::Hunt;

/// The fill distance of a set of points, with the place that shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    /// The radius of the largest empty ball; its lower end is the distance of `centre` from the point nearest to it.
    pub radius: Bracket,
    /// The centre of the largest empty ball that was found, in the cube.
    pub centre: Vec<f64>,
}

/// The fill distance.
pub fn fill(points: &PointSet, deadline: Deadline) -> Option<Fill> {
    (!points.is_empty()).then(|| Hunt::new(points, deadline).run())
}
