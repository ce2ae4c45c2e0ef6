//! The places that show the value of a measure: an empty box, an empty ball.

use crate::Bracket;

/// The largest open box in the unit cube that holds no point, or the largest box that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct LargestEmptyBox {
    /// The lower corner of the empty box.
    pub lower: Vec<f64>,
    /// The upper corner of the empty box.
    pub upper: Vec<f64>,
}

impl LargestEmptyBox {
    /// Returns the volume of the empty box, as a share of the volume of the unit cube.
    pub fn volume(&self) -> f64 {
        self.lower.iter().zip(&self.upper).map(|(lower, upper)| upper - lower).product()
    }
}

/// The dispersion of a set of points, with the largest empty box that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Dispersion {
    /// The largest volume of an empty box; the lower bound is the volume of `witness`.
    pub volume: Bracket,
    /// The largest empty box that was found.
    pub witness: LargestEmptyBox,
}

/// The fill distance of a set of points, with the centre of the largest empty ball that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    /// The radius of the largest empty ball; the lower bound is the distance from `centre` to the nearest point.
    pub radius: Bracket,
    /// The centre of the largest empty ball that was found, which lies in the cube.
    pub centre: Vec<f64>,
}
