//! The valid part of the unit cube: the places whose tests keep the constraints of a space.
//!
//! A constraint on continuous parameters can cut any shape out of the cube. A tree of cells holds this shape from both
//! sides: in some cells every test is valid, in some no test is, and the others are undecided. Bisection keeps the
//! undecided cells small (`bisect.rs`). The volume of a box within the valid part is therefore known as a bracket. Both
//! ends of the bracket grow with the box, also after rounding: they are sums of products of clipped lengths. The search
//! for the largest empty box needs exactly this.

mod bisect;
mod validity;
mod written;

pub use validity::{Effort, Validity};
pub use written::{OtherCell, WrittenCell, WrittenPart};

use crate::Bracket;

/// The valid part of a unit cube, as a tree of cells.
#[derive(Debug, Clone, PartialEq)]
pub struct ValidPart {
    dims: usize,
    /// The axes along which cells are cut. The constraints do not depend on the other axes.
    axes: Vec<usize>,
    cases: Cases,
    /// The cells. The first is the whole cube, and the halves of a cell come after the cell.
    cells: Vec<Cell>,
}

/// The values of other parameters for which the cells are decided. A cell is valid if one case makes it valid.
#[derive(Debug, Clone, PartialEq)]
struct Cases {
    /// The continuous parameters of the cube, as positions among the continuous parameters.
    continuous: Vec<usize>,
    /// The discrete parameters on which the constraints depend, as positions among the discrete parameters.
    discrete: Vec<usize>,
    /// The levels of these parameters in each valid row of discrete values.
    rows: Vec<Vec<usize>>,
    /// The continuous parameters outside of the cube on which the constraints depend.
    beside: Vec<usize>,
    /// The places in the cube of these parameters that were tried.
    places: Vec<Vec<f64>>,
}

#[derive(Debug, Clone, PartialEq)]
struct Cell {
    /// The volume of the cells within this one that are certainly valid.
    certain: f64,
    /// The volume of the cells within this one that are not certainly invalid.
    possible: f64,
    content: Content,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Content {
    /// Every test in the cell keeps the constraints, with the levels of this row and at this place beside the cube.
    Valid { row: usize, place: usize },
    /// No test in the cell keeps the constraints, in any case.
    Invalid,
    /// The bisection ended before the cell was decided.
    Undecided,
    /// The cell is cut in two at a coordinate. `axis` is a position among the axes of the tree.
    Cut { axis: usize, at: f64, halves: [usize; 2] },
}

/// The two ends of the bracket of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bound {
    /// The volume that is certainly valid.
    Certain,
    /// The volume that is not certainly invalid.
    Possible,
}

impl ValidPart {
    /// Returns the volume of the valid part as a share of the cube.
    pub fn share(&self) -> Bracket {
        self.bracket(self.cells[0].certain, self.cells[0].possible)
    }

    /// Returns `true` if no cell is undecided.
    pub fn is_exact(&self) -> bool {
        self.cells.iter().all(|cell| cell.content != Content::Undecided)
    }

    /// Returns the number of dimensions of the cube.
    pub fn dims(&self) -> usize {
        self.dims
    }

    /// Returns one end of the bracket of the valid volume of a box. It never shrinks when the box grows.
    pub(crate) fn weight(&self, bound: Bound, side: impl Fn(usize) -> (f64, f64)) -> f64 {
        let free: f64 =
            (0..self.dims).filter(|axis| !self.axes.contains(axis)).map(|axis| length(side(axis))).product();
        let mut clipped: Vec<(f64, f64)> = self.axes.iter().map(|&axis| side(axis)).collect();
        let mut cell = vec![(0.0, 1.0); self.axes.len()];
        free * self.within(bound, 0, &mut cell, &mut clipped)
    }

    /// Returns the least share of the valid part that a box takes up.
    pub(crate) fn least_share(&self, side: impl Fn(usize) -> (f64, f64)) -> f64 {
        let certain = self.weight(Bound::Certain, &side);
        if certain <= 0.0 {
            return 0.0;
        }
        // The undecided cells outside of the box make the share smaller if they are valid. Those in the box would add to the
        // box as much as to the valid part.
        let beside = self.cells[0].possible - (self.weight(Bound::Possible, &side) - certain);
        if self.is_exact() { certain / beside } else { (certain / beside * (1.0 - self.rounding())).min(1.0) }
    }

    /// Returns the greatest share of the valid part that a box of this possible weight takes up.
    pub(crate) fn greatest_share(&self, possible: f64) -> f64 {
        let certain = self.cells[0].certain;
        let inexact = if self.is_exact() { 0.0 } else { self.rounding() };
        if possible < certain { (possible / certain * (1.0 + inexact)).min(1.0) } else { 1.0 }
    }

    /// Returns the greatest share of the valid part that a box takes up.
    pub(crate) fn greatest_share_of(&self, side: impl Fn(usize) -> (f64, f64)) -> f64 {
        self.greatest_share(self.weight(Bound::Possible, side))
    }

    /// Returns the possible weight that a box needs to take up more than a share of the valid part.
    pub(crate) fn weight_for(&self, share: f64) -> f64 {
        share * self.cells[0].certain * (1.0 - self.rounding())
    }

    fn bracket(&self, lower: f64, upper: f64) -> Bracket {
        if self.is_exact() {
            return Bracket::exact(lower);
        }
        Bracket { lower: lower * (1.0 - self.rounding()), upper: (upper * (1.0 + self.rounding())).min(1.0) }
    }

    /// Returns a bound on the relative error of weights: each of the lengths, products and sums may lose half an ulp.
    pub(crate) fn rounding(&self) -> f64 {
        2.0 * (self.cells.len() + 2 * self.dims + 2) as f64 * f64::EPSILON
    }

    /// Returns the weight of the part of a box that lies in a cell. `clipped` is that part.
    fn within(&self, bound: Bound, index: usize, cell: &mut [(f64, f64)], clipped: &mut [(f64, f64)]) -> f64 {
        let Cell { certain, possible, content } = &self.cells[index];
        let whole = if bound == Bound::Certain { *certain } else { *possible };
        let Content::Cut { axis, at, halves: [low, high] } = *content else {
            let counts = whole > 0.0;
            return if counts { clipped.iter().copied().map(length).product() } else { 0.0 };
        };
        if whole <= 0.0 || cell == clipped {
            return whole;
        }
        let (of_cell, of_box) = (cell[axis], clipped[axis]);
        let mut sum = 0.0;
        if of_box.0 < at {
            (cell[axis], clipped[axis]) = ((of_cell.0, at), (of_box.0, of_box.1.min(at)));
            sum += self.within(bound, low, cell, clipped);
        }
        if of_box.1 > at {
            (cell[axis], clipped[axis]) = ((at, of_cell.1), (of_box.0.max(at), of_box.1));
            sum += self.within(bound, high, cell, clipped);
        }
        (cell[axis], clipped[axis]) = (of_cell, of_box);
        sum
    }
}

fn length((lower, upper): (f64, f64)) -> f64 {
    upper - lower
}
