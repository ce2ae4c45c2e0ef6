//! The sides of a box under search: where they end, where empty boxes inside may end, and how much a box weighs.

use crate::valid::{Bound, ValidPart};

/// The interval of a box along one axis, with constraints on the empty boxes inside the box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    pub lower: f64,
    pub upper: f64,
    /// The lower ends of the empty boxes are below this coordinate: other branches try the cuts from there on.
    lower_below: f64,
    /// The upper ends of the empty boxes are above this coordinate.
    upper_above: f64,
}

/// The lower or the upper end of a side of a box.
#[derive(Debug, Clone, Copy)]
pub(super) enum End {
    Lower,
    Upper,
}

impl Side {
    /// Makes the side from `lower` to `upper`, without constraints.
    pub fn between(lower: f64, upper: f64) -> Self {
        Self { lower, upper, lower_below: f64::INFINITY, upper_above: f64::NEG_INFINITY }
    }

    pub fn length(&self) -> f64 {
        self.upper - self.lower
    }

    /// Returns `true` if `x` lies strictly inside the side.
    pub fn holds(&self, x: f64) -> bool {
        self.lower < x && x < self.upper
    }

    /// Returns `true` if the constraints allow that the given end moves to `x`.
    pub fn allows(&self, x: f64, end: End) -> bool {
        match end {
            End::Lower => x < self.lower_below,
            End::Upper => x > self.upper_above,
        }
    }

    /// Returns the side with the given end moved to `x`.
    pub fn moved(self, x: f64, end: End) -> Self {
        match end {
            End::Lower => Self { lower: x, ..self },
            End::Upper => Self { upper: x, ..self },
        }
    }

    /// Returns the side with the added constraint that the given end of an empty box lies beyond `x`.
    pub fn kept(self, x: f64, end: End) -> Self {
        match end {
            End::Lower => Self { lower_below: self.lower_below.min(x), ..self },
            End::Upper => Self { upper_above: self.upper_above.max(x), ..self },
        }
    }
}

/// The weight by which a search compares boxes. It never shrinks when a box grows, also after rounding.
pub(super) trait Weight: Copy + Sync {
    /// Returns the weight of a box with the given sides.
    fn of(self, sides: &[Side]) -> f64;
}

/// The volume of a box as its weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Volume;

/// One end of the bracket of the valid volume of a box as its weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Valid<'a>(pub &'a ValidPart, pub Bound);

impl Weight for Volume {
    fn of(self, sides: &[Side]) -> f64 {
        volume(sides)
    }
}

impl Weight for Valid<'_> {
    fn of(self, sides: &[Side]) -> f64 {
        self.0.weight(self.1, |axis| (sides[axis].lower, sides[axis].upper))
    }
}

/// Returns the volume of a box with the given sides. It is the product of differences in the order of the axes, which
/// rounding keeps monotone.
pub(super) fn volume(sides: &[Side]) -> f64 {
    sides.iter().map(Side::length).product()
}

/// Returns `true` if a point lies strictly inside a box.
pub(super) fn inside(point: &[f64], sides: &[Side]) -> bool {
    sides.iter().zip(point).all(|(side, x)| side.holds(*x))
}
