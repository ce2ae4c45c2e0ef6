//! The places that show the value of a measure: an empty box, an empty ball.

use crate::Bracket;

/// An open box in the unit cube that holds no point.
#[derive(Debug, Clone, PartialEq)]
pub struct LargestEmptyBox {
    /// The lower corner of the box.
    pub lower: Vec<f64>,
    /// The upper corner of the box.
    pub upper: Vec<f64>,
}

impl LargestEmptyBox {
    /// Returns the volume of the box, as a share of the volume of the cube.
    pub fn volume(&self) -> f64 {
        self.lower.iter().zip(&self.upper).map(|(lower, upper)| upper - lower).product()
    }
}

/// The dispersion of a set of points, with the box that shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Dispersion {
    /// The largest volume; its lower bound is the volume of `witness`.
    pub volume: Bracket,
    /// The largest empty box that was found.
    pub witness: LargestEmptyBox,
}

/// The fill distance of a set of points, with the place that shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    /// The radius of the largest ball; its lower bound is the distance from `centre` to the nearest point.
    pub radius: Bracket,
    /// The centre of the largest ball that was found, in the cube.
    pub centre: Vec<f64>,
}
