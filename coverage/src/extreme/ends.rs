//! The sides of a region of boxes: two strips, one with all left sides and one with all right sides.

use super::plane::Plane;
use crate::star::BoxKind;
use std::ops::Range;

/// The place of a point that does not exist, which is in no strip.
pub(super) const NO_POINT: u32 = u32::MAX;

/// The places of the positions that the left sides and the right sides of boxes may take. The two ranges are the same
/// or have no place in common.
pub(super) struct Ends {
    pub(super) left: Range<u32>,
    pub(super) right: Range<u32>,
}

impl Ends {
    /// Returns the parts: each range with more than one place is cut into halves.
    pub(super) fn parts(&self) -> impl Iterator<Item = Self> + use<> {
        let halves = |range: &Range<u32>| {
            let middle = range.start.midpoint(range.end);
            [range.start..middle, middle..range.end]
        };
        let [lefts, rights] = [halves(&self.left), halves(&self.right)];
        let pairs =
            lefts.into_iter().flat_map(move |left| rights.clone().map(|right| Self { left: left.clone(), right }));
        pairs.filter(|ends| !ends.left.is_empty() && !ends.right.is_empty() && ends.left.start <= ends.right.start)
    }

    /// Returns `true` if the two ranges have no place in common.
    pub(super) fn are_apart(&self) -> bool {
        self.left != self.right
    }

    /// Returns the least and the greatest width of a box.
    pub(super) fn widths(&self, plane: &Plane) -> [f64; 2] {
        [plane.width(self.left.end - 1, self.right.start), plane.width(self.left.start, self.right.end - 1)]
    }

    /// Returns the places of the points that are inside all boxes along x, and the places of the points that are
    /// inside some boxes.
    pub(super) fn inside(&self, kind: BoxKind) -> [Range<u32>; 2] {
        // Open boxes leave out the points on their faces.
        let face = u32::from(kind == BoxKind::Open);
        [
            self.left.end - 1 + face..(self.right.start + 1).saturating_sub(face),
            self.left.start + face..self.right.end.saturating_sub(face),
        ]
    }
}
