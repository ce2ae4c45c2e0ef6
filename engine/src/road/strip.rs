//! What there is to draw of a road: strips along curves, each of one surface. Pictures, meshes and the check that
//! no two elements overlap are all made of them.

use super::curve::Curve;
use crate::geometry::Pose;
use nalgebra::Vector2;

/// What a strip shows, in the order in which it is drawn: later ones cover earlier ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Surface {
    /// Where pedestrians walk.
    Sidewalk,
    /// Where cars drive.
    Carriageway,
    /// The middle of a roundabout.
    Island,
    /// The stone beside a carriageway.
    Kerb,
    /// The line between the two directions.
    CentreLine,
    /// A line between two lanes of one direction.
    LaneLine,
    /// The line at the edge of a road without sidewalks.
    EdgeLine,
    /// Where one stops before a crossing of equal roads.
    StopLine,
    /// Where one gives way: the stem of a T-intersection, the entries of a roundabout.
    GiveWayLine,
    /// A stripe of a zebra crossing.
    Zebra,
}

/// The ground between two curves that run beside one, `right` and `left` metres to the left of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strip {
    /// What it shows.
    pub surface: Surface,
    /// The curve that it follows.
    pub curve: Curve,
    /// Where its right side runs: metres to the left of the curve, negative to the right.
    pub right: f64,
    /// Where its left side runs, greater than `right`.
    pub left: f64,
    /// Metres of dash and of gap along the curve, for a broken line.
    pub dash: Option<(f64, f64)>,
}

impl Strip {
    pub(super) fn new(surface: Surface, curve: Curve, right: f64, left: f64) -> Self {
        Self { surface, curve, right, left, dash: None }
    }

    pub(super) fn dashed(self, dash: f64, gap: f64) -> Self {
        Self { dash: Some((dash, gap)), ..self }
    }

    pub(super) fn moved(&self, frame: &Pose) -> Self {
        Self { curve: self.curve.moved(frame), ..*self }
    }

    /// Its middle: the way of a pedestrian on a sidewalk, of a brush on a line.
    pub fn middle(&self) -> Curve {
        self.curve.offset(0.5 * (self.right + self.left))
    }

    /// The unbroken strips that it consists of: its dashes, or itself. Dashes begin and end with half a gap.
    pub fn solid_parts(&self) -> Vec<Strip> {
        let Some((dash, gap)) = self.dash else { return vec![*self] };
        let count = (self.curve.length() / (dash + gap)) as usize;
        let start = 0.5 * (self.curve.length() - count as f64 * (dash + gap) + gap);
        let part = |i: usize| {
            let from = start + i as f64 * (dash + gap);
            Strip { curve: self.curve.piece(from, from + dash), dash: None, ..*self }
        };
        (0..count).map(part).collect()
    }

    /// Its sides as polylines that are true to `tolerance` metres, with as many points each: right, left.
    pub fn sides(&self, tolerance: f64) -> (Vec<Vector2<f64>>, Vec<Vector2<f64>>) {
        let pieces = self.curve.pieces(self.right, tolerance).max(self.curve.pieces(self.left, tolerance));
        let side = |offset: f64| {
            let step = self.curve.length() / pieces as f64;
            (0..=pieces).map(|i| self.curve.beside(i as f64 * step, offset)).collect()
        };
        (side(self.right), side(self.left))
    }

    /// Its outline as a polygon that is true to `tolerance` metres, counter-clockwise.
    pub fn outline(&self, tolerance: f64) -> Vec<Vector2<f64>> {
        let (mut right, left) = self.sides(tolerance);
        right.extend(left.iter().rev());
        right
    }
}
