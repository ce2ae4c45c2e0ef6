//! The sides of a box under search: where they end, and where empty boxes inside may end.

/// A box along one axis, with the constraints on the empty boxes that are searched inside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    pub lower: f64,
    pub upper: f64,
    /// The lower ends of the empty boxes are below this coordinate: other branches try the cuts from there on.
    lower_below: f64,
    /// The upper ends of the empty boxes are above this coordinate.
    upper_above: f64,
}

/// One of the two ends of a side.
#[derive(Debug, Clone, Copy)]
pub(super) enum End {
    Lower,
    Upper,
}

impl Side {
    /// Makes a side without constraints.
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

    /// Returns `true` if an end may move to `x`.
    pub fn allows(&self, x: f64, end: End) -> bool {
        match end {
            End::Lower => x < self.lower_below,
            End::Upper => x > self.upper_above,
        }
    }

    /// Returns the side with an end at `x`.
    pub fn moved(self, x: f64, end: End) -> Self {
        match end {
            End::Lower => Self { lower: x, ..self },
            End::Upper => Self { upper: x, ..self },
        }
    }

    /// Returns the side with the constraint that this end does not reach `x`.
    pub fn kept(self, x: f64, end: End) -> Self {
        match end {
            End::Lower => Self { lower_below: self.lower_below.min(x), ..self },
            End::Upper => Self { upper_above: self.upper_above.max(x), ..self },
        }
    }
}

/// The volume of a box: the product of differences in the order of the axes, which rounding keeps monotone.
pub(super) fn volume(sides: &[Side]) -> f64 {
    sides.iter().map(Side::length).product()
}

/// Returns `true` if a point lies strictly inside a box.
pub(super) fn inside(point: &[f64], sides: &[Side]) -> bool {
    sides.iter().zip(point).all(|(side, x)| side.holds(*x))
}
