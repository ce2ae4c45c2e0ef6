//! The sides of a box under search: where they end, and where they have promised to end or not to end.

/// A box along one axis, and what is known of the empty boxes that are looked for inside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    pub lower: f64,
    pub upper: f64,
    /// Their lower ends are below this: cuts from there on were tried elsewhere.
    lower_below: f64,
    /// Their upper ends are above this.
    upper_above: f64,
}

/// One of the two ends of a side.
#[derive(Debug, Clone, Copy)]
pub(super) enum End {
    Lower,
    Upper,
}

impl Side {
    /// A side with nothing promised.
    pub fn between(lower: f64, upper: f64) -> Self {
        Self { lower, upper, lower_below: f64::INFINITY, upper_above: f64::NEG_INFINITY }
    }

    pub fn length(&self) -> f64 {
        self.upper - self.lower
    }

    /// Whether `x` lies strictly inside.
    pub fn holds(&self, x: f64) -> bool {
        self.lower < x && x < self.upper
    }

    /// Whether an end may move to `x`.
    pub fn allows(&self, x: f64, end: End) -> bool {
        match end {
            End::Lower => x < self.lower_below,
            End::Upper => x > self.upper_above,
        }
    }

    /// The side with an end at `x`.
    pub fn moved(self, x: f64, end: End) -> Self {
        match end {
            End::Lower => Self { lower: x, ..self },
            End::Upper => Self { upper: x, ..self },
        }
    }

    /// The side with the promise that this end does not reach `x`.
    pub fn kept(self, x: f64, end: End) -> Self {
        match end {
            End::Lower => Self { lower_below: self.lower_below.min(x), ..self },
            End::Upper => Self { upper_above: self.upper_above.max(x), ..self },
        }
    }
}

/// Volumes are products of differences in the order of the axes, which rounding keeps monotone.
pub(super) fn volume(sides: &[Side]) -> f64 {
    sides.iter().map(Side::length).product()
}

/// Whether a point lies strictly inside a box.
pub(super) fn inside(point: &[f64], sides: &[Side]) -> bool {
    sides.iter().zip(point).all(|(side, x)| side.holds(*x))
}
