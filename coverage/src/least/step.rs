//! The steps of a proof, as text that another program can follow.

use std::fmt;

/// A step of a proof that no points have a dispersion below a level, in the order in which the search goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// No coordinates keep the bounds.
    Impossible,
    /// The next point takes each of its places: on the second axis from the lowest place to the highest, for each of these on the third axis, and so on.
    NextPoint,
    /// The interval of a difference is cut in two. The lower part comes first.
    Split(Split),
}

/// A cut of the interval of a difference in two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Split {
    /// The axis of the difference.
    pub axis: usize,
    /// The node from which the difference goes: 0 is the lower end of the cube, and the points follow in their order along the first axis.
    pub from: usize,
    /// The node to which the difference goes.
    pub to: usize,
    /// The place of the cut, in units of 2^-40.
    pub at: i64,
}

/// `x` for an impossible case, `+` for the next point, and the axis, both nodes and the place of a cut, with commas and a semicolon.
impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Impossible => f.write_str("x"),
            Self::NextPoint => f.write_str("+"),
            Self::Split(Split { axis, from, to, at }) => write!(f, "{axis},{from},{to},{at};"),
        }
    }
}
