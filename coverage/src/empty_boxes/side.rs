//! The side of a box along an axis: an interval, or an arc of a circle if opposite faces of the cube are glued together.

use std::ops::Range;

/// The open side of a box. If the upper end is not above the lower end, the side goes on beyond 1, from 0 to the upper
/// end (periodic boxes as in Breneis, Hinrichs, Fibonacci lattices have minimal dispersion on the two-dimensional torus,
/// arXiv 1905.03856).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Side {
    pub lower: f64,
    pub upper: f64,
}

impl Side {
    /// The side from wall to wall.
    pub const WALL_TO_WALL: Self = Self { lower: 0.0, upper: 1.0 };

    /// The side that goes all the way round a circle. It holds every coordinate and has no ends.
    pub const ROUND: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// Returns `true` if a coordinate lies strictly inside.
    pub fn holds(self, x: f64) -> bool {
        let (above, below) = (self.lower < x, x < self.upper);
        if self.lower < self.upper { above && below } else { above || below }
    }

    /// Returns the length of the side. It has a relative error of one ulp at most.
    pub fn width(self) -> f64 {
        if self.lower < self.upper { (self.upper - self.lower).min(1.0) } else { (1.0 - self.lower) + self.upper }
    }

    /// Returns the parts that are left if a coordinate is cut out, each with its ends that lie at the coordinate (0 is
    /// the lower end). A circle without one coordinate is a single part.
    pub fn without(self, x: f64) -> impl Iterator<Item = (Self, Range<usize>)> {
        let parts = if self == Self::ROUND {
            [Some((Self { lower: x, upper: x }, 0..2)), None]
        } else {
            [Some((Self { lower: x, ..self }, 0..1)), Some((Self { upper: x, ..self }, 1..2))]
        };
        parts.into_iter().flatten()
    }
}
