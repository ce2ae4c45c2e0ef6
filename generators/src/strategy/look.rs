//! The look of a strategy in a figure, which tells it from other strategies.

/// The shape of a mark.
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
    /// `true` if the marks are filled.
    pub filled: bool,
}

impl Look {
    /// Makes filled marks of a colour such as `0xd5_5e00`.
    pub const fn filled(colour: u32, shape: MarkShape) -> Self {
        Self { colour: ((colour >> 16) as u8, (colour >> 8) as u8, colour as u8), shape, filled: true }
    }

    /// Makes hollow marks of a colour such as `0xd5_5e00`.
    pub const fn hollow(colour: u32, shape: MarkShape) -> Self {
        Self { filled: false, ..Self::filled(colour, shape) }
    }
}
