//! The places that show a number: an empty box, an empty ball.

use crate::Bracket;

/// An open box in the unit cube that holds no point.
#[derive(Debug, Clone, PartialEq)]
pub struct LargestEmptyBox {
    /// Its lower corner.
    pub lower: Vec<f64>,
    /// Its upper corner.
    pub upper: Vec<f64>,
}

impl LargestEmptyBox {
    /// Its volume, as a share of the cube's.
    pub fn volume(&self) -> f64 {
        self.lower.iter().zip(&self.upper).map(|(lower, upper)| upper - lower).product()
    }
}

/// The dispersion of a set of points, with the box that shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Dispersion {
    /// The largest volume; its lower end is the volume of `witness`.
    pub volume: Bracket,
    /// The largest empty box that was found.
    pub witness: LargestEmptyBox,
}

/// The fill distance of a set of points, with the place that shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    /// The radius of the largest ball; its lower end is the distance of `centre` from the point nearest to it.
    pub radius: Bracket,
    /// The centre of the largest ball that was found, in the cube.
    pub centre: Vec<f64>,
}
