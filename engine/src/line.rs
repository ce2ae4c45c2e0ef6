//! Lines across a road, to which distances are measured.

use nalgebra::Vector2;

/// A line across a road, with the direction of the traffic that crosses it.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    pub(crate) name: String,
    pub(crate) point: Vector2<f64>,
    pub(crate) direction: Vector2<f64>,
}

impl Line {
    /// Returns the distance in metres from a position to the line ahead; negative if the line lies behind the position.
    pub fn ahead_of(&self, position: Vector2<f64>) -> f64 {
        (self.point - position).dot(&self.direction)
    }
}
