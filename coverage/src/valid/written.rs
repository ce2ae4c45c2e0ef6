//! Valid parts as certificates hold them, so that others can check each cell and compute the same weights.

use super::{Cases, Content, ValidPart};
use serde::{Deserialize, Serialize};

/// The valid part of a projection, as a tree of cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WrittenPart {
    /// The continuous parameters of the projection, as positions among the continuous parameters.
    pub axes: Vec<usize>,
    /// The axes along which cells are cut, as positions in `axes`.
    pub along: Vec<usize>,
    /// The discrete parameters on which the cells depend, as positions among the discrete parameters.
    pub discrete: Vec<usize>,
    /// The levels of these parameters in each valid row. If a row is missing, no cell is invalid.
    pub rows: Vec<Vec<usize>>,
    /// The continuous parameters outside of the projection on which the cells depend.
    pub beside: Vec<usize>,
    /// The places, as coordinates of these parameters, that make cells valid.
    pub places: Vec<Vec<f64>>,
    /// The cells. After a cell that is cut come the cells of its lower half, and then the cells of its upper half.
    pub cells: Vec<WrittenCell>,
}

/// A cell of a valid part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum WrittenCell {
    /// The cell is cut in the middle along the axis at this position in `along`.
    Cut(usize),
    /// The position of a row and the position of a place. Every test in the cell with this row at this place keeps the constraints.
    Valid([usize; 2]),
    /// The cell is not valid.
    Other(OtherCell),
}

/// A cell that is not valid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OtherCell {
    /// No test in the cell keeps the constraints.
    Invalid,
    /// The bisection ended before the cell was decided.
    Undecided,
}

impl From<&ValidPart> for WrittenPart {
    fn from(part: &ValidPart) -> Self {
        let Cases { continuous, discrete, rows, beside, places } = part.cases.clone();
        let mut cells = Vec::new();
        let mut waiting = vec![0];
        while let Some(index) = waiting.pop() {
            cells.push(match part.cells[index].content {
                Content::Cut { axis, halves: [low, high], .. } => {
                    waiting.extend([high, low]);
                    WrittenCell::Cut(axis)
                }
                Content::Valid { row, place } => WrittenCell::Valid([row, place]),
                Content::Invalid => WrittenCell::Other(OtherCell::Invalid),
                Content::Undecided => WrittenCell::Other(OtherCell::Undecided),
            });
        }
        Self { axes: continuous, along: part.axes.clone(), discrete, rows, beside, places, cells }
    }
}
