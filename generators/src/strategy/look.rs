//! How a strategy is told from others in a figure.

/// The shapes of marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkShape {
    /// A circle.
    Circle,
    /// A square on its side.
    Square,
    /// A square on its corner.
    Diamond,
    /// A triangle with its tip upwards.
    Triangle,
    /// A triangle with its tip downwards.
    Tip,
}

/// The mark and the colour of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    /// Red, green and blue.
    pub colour: (u8, u8, u8),
    /// The shape of the marks.
    pub shape: MarkShape,
    /// Whether the marks are filled.
    pub filled: bool,
}

impl Look {
    /// Filled marks of a colour such as `0xd5_5e00`.
    pub const fn filled(colour: u32, shape: MarkShape) -> Self {
        Self { colour: ((colour >> 16) as u8, (colour >> 8) as u8, colour as u8), shape, filled: true }
    }

    /// Hollow marks of a colour such as `0xd5_5e00`.
    pub const fn hollow(colour: u32, shape: MarkShape) -> Self {
        Self { filled: false, ..Self::filled(colour, shape) }
    }
}
