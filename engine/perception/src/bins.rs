//! The classes of road users by distance, size and visible share for which recall is counted separately.

/// A property of a road user in an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The distance from the middle of the ego vehicle, in metres.
    Distance,
    /// The height of the box in pixels of the perceiver's input.
    Height,
    /// The share of the object that is in the image and not behind another object.
    Visible,
}

/// A range of a property: at least `from` and less than `to`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bin {
    /// The property.
    pub axis: Axis,
    /// The least value.
    pub from: f64,
    /// The value that is too much.
    pub to: f64,
}

const fn bin(axis: Axis, from: f64, to: f64) -> Bin {
    Bin { axis, from, to }
}

/// The usual ranges.
pub const BINS: [Bin; 13] = [
    bin(Axis::Distance, 0.0, 10.0),
    bin(Axis::Distance, 10.0, 20.0),
    bin(Axis::Distance, 20.0, 40.0),
    bin(Axis::Distance, 40.0, 80.0),
    bin(Axis::Distance, 80.0, f64::INFINITY),
    bin(Axis::Height, 0.0, 12.0),
    bin(Axis::Height, 12.0, 24.0),
    bin(Axis::Height, 24.0, 48.0),
    bin(Axis::Height, 48.0, 300.0),
    bin(Axis::Height, 300.0, f64::INFINITY),
    bin(Axis::Visible, 0.25, 0.5),
    bin(Axis::Visible, 0.5, 0.75),
    bin(Axis::Visible, 0.75, f64::INFINITY),
];

impl Bin {
    /// Returns the name of the range in the metrics of a test, for example `distance-10-20`. The last range of an axis
    /// has no end in its name.
    pub fn name(&self) -> String {
        let axis = match self.axis {
            Axis::Distance => "distance",
            Axis::Height => "height",
            Axis::Visible => "visible",
        };
        if self.to.is_finite() { format!("{axis}-{}-{}", self.from, self.to) } else { format!("{axis}-{}", self.from) }
    }

    /// Returns the range in words, for example "10 to 20 m away".
    pub fn words(&self) -> String {
        let Self { axis, from, to } = self;
        match (axis, to.is_finite()) {
            (Axis::Distance, true) => format!("{from} to {to} m away"),
            (Axis::Distance, false) => format!("{from} m away and more"),
            (Axis::Height, true) => format!("{from} to {to} pixels high"),
            (Axis::Height, false) => format!("{from} pixels high and more"),
            (Axis::Visible, true) => format!("{:.0} to {:.0} % visible", 100.0 * from, 100.0 * to),
            (Axis::Visible, false) => format!("{:.0} % visible and more", 100.0 * from),
        }
    }

    /// Returns `true` if the range contains a value.
    pub fn contains(&self, value: f64) -> bool {
        self.from <= value && value < self.to
    }
}
