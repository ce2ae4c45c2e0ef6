//! The visible surfaces of a road: strips along curves, each with one surface. Pictures, meshes and the check that no
//! two elements overlap use them.

use super::curve::Curve;
use crate::geometry::Pose;
use nalgebra::Vector2;

/// The surface of a strip of road, in the order of drawing, so that later surfaces cover earlier surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Surface {
    /// A sidewalk for pedestrians.
    Sidewalk,
    /// A carriageway for cars.
    Carriageway,
    /// The island in the middle of a roundabout.
    Island,
    /// The kerb beside a carriageway.
    Kerb,
    /// The line between the two directions of traffic.
    CentreLine,
    /// A line between two lanes of the same direction.
    LaneLine,
    /// The line at the edge of a road without sidewalks.
    EdgeLine,
    /// The line where cars stop before an intersection of roads of equal rank.
    StopLine,
    /// The line where cars give way, at the stem of a T-intersection and at the entries of a roundabout.
    GiveWayLine,
    /// A stripe of a zebra crossing.
    Zebra,
}

/// A strip of ground between two parallels of `curve`, which lie `right` and `left` metres to the left of `curve`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strip {
    /// The surface of the strip, for example a sidewalk.
    pub surface: Surface,
    /// The curve that the strip follows.
    pub curve: Curve,
    /// The offset of the right side of the strip, in metres to the left of the curve; negative to the right.
    pub right: f64,
    /// The offset of the left side of the strip, in metres to the left of the curve; greater than `right`.
    pub left: f64,
    /// The lengths of a dash and of a gap along the curve, in metres; `None` for an unbroken strip.
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

    /// Returns the curve along the middle of the strip, for example the path of a pedestrian on a sidewalk.
    pub fn middle(&self) -> Curve {
        self.curve.offset(0.5 * (self.right + self.left))
    }

    /// Returns the dashes of a broken strip, with half a gap at each end, or an unbroken strip itself.
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

    /// Returns the right and left side of the strip as polylines of equally many points, exact to `tolerance` metres.
    pub fn sides(&self, tolerance: f64) -> (Vec<Vector2<f64>>, Vec<Vector2<f64>>) {
        let pieces = self.curve.pieces(self.right, tolerance).max(self.curve.pieces(self.left, tolerance));
        let side = |offset: f64| {
            let step = self.curve.length() / pieces as f64;
            (0..=pieces).map(|i| self.curve.beside(i as f64 * step, offset)).collect()
        };
        (side(self.right), side(self.left))
    }

    /// Returns the outline of the strip as a counter-clockwise polygon, exact to `tolerance` metres.
    pub fn outline(&self, tolerance: f64) -> Vec<Vector2<f64>> {
        let (mut right, left) = self.sides(tolerance);
        right.extend(left.iter().rev());
        right
    }
}
