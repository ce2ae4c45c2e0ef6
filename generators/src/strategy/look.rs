//! The look of a strategy in a figure, which tells it from other strategies.

/// The shape of a mark in a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkShape {
    /// The mark is a circle.
    Circle,
    /// The mark is a square that stands on its side.
    Square,
    /// The mark is a square that stands on its corner.
    Diamond,
    /// The mark is a triangle with its tip upwards.
    Triangle,
    /// The mark is a triangle with its tip downwards.
    Tip,
}

/// The look of a strategy's curve in a figure, with the colour and the marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    /// The colour of the curve as red, green and blue, each from 0 to 255.
    pub colour: (u8, u8, u8),
    /// The shape of the marks on the curve.
    pub shape: MarkShape,
    /// `true` if the marks on the curve are filled.
    pub filled: bool,
}

impl Look {
    /// The looks of strategies of other programs, one after the other.
    pub const OTHERS: [Self; 4] = [
        Self::hollow(0x00_0000, MarkShape::Square),
        Self::hollow(0x77_3399, MarkShape::Diamond),
        Self::hollow(0x99_6600, MarkShape::Tip),
        Self::hollow(0x66_6666, MarkShape::Triangle),
    ];

    /// Makes a look with filled marks and a colour such as `0xd5_5e00`.
    pub const fn filled(colour: u32, shape: MarkShape) -> Self {
        Self { colour: ((colour >> 16) as u8, (colour >> 8) as u8, colour as u8), shape, filled: true }
    }

    /// Makes a look with hollow marks and a colour such as `0xd5_5e00`.
    pub const fn hollow(colour: u32, shape: MarkShape) -> Self {
        Self { filled: false, ..Self::filled(colour, shape) }
    }
}
