//! The part of the ground that a picture shows, and its scale.

use super::drawing::{Contour, PathSegment, Pixel};
use nalgebra::Vector2;
use paracosm_engine::road::{Bounds, Centreline, Curve, RoadNetwork, Surface};
use std::f64::consts::FRAC_PI_4;

/// A part of the ground, from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    pub bounds: Bounds,
    /// The scale of the view in pixels per metre.
    pub scale: f64,
}

/// The margin in metres to the left and right of the bounds, and above and below them.
pub(super) const MARGIN: [f64; 2] = [14.0, 6.0];
/// The greatest distance in metres from a road user to the edges of the road that are shown.
const ACROSS: f64 = 25.0;
/// The metres that are shown beyond the edges of a road.
const VERGE: f64 = 2.0;
/// The least width in metres of the ground in a picture.
const NARROWEST: f64 = 60.0;
/// The least and the largest height of a picture, as shares of its width.
const HEIGHTS: [f64; 2] = [0.12, 0.7];

/// Returns the bounds with some ground around them.
pub(super) fn with_margin(bounds: &Bounds) -> Bounds {
    let margin = Vector2::from(MARGIN);
    Bounds { min: bounds.min - margin, max: bounds.max + margin }
}

/// Returns the bounds of the road's edges at each of these points.
pub(super) fn across(network: &RoadNetwork, points: impl Iterator<Item = Vector2<f64>>) -> Bounds {
    let mut strips = network.strips();
    strips.retain(|strip| matches!(strip.surface, Surface::Sidewalk | Surface::Carriageway));
    let edges = points.flat_map(|point| {
        strips.iter().flat_map(move |strip| {
            let s = strip.curve.nearest(point);
            [strip.right, strip.left]
                .map(|side| strip.curve.beside(s, side))
                .into_iter()
                .filter(move |edge| (edge - point).norm() <= ACROSS)
        })
    });
    Bounds::around(edges).grown(VERGE)
}

impl View {
    /// Makes a view with a width in pixels that shows the given bounds, enlarged if the picture would be too flat or
    /// too tall.
    pub fn fit(bounds: &Bounds, width: f64) -> Self {
        let extent = bounds.max - bounds.min;
        let wide = extent.x.max(NARROWEST).max(extent.y / HEIGHTS[1]);
        let high = extent.y.max(wide * HEIGHTS[0]);
        let (centre, half) = (0.5 * (bounds.min + bounds.max), 0.5 * Vector2::new(wide, high));
        Self { bounds: Bounds { min: centre - half, max: centre + half }, scale: width / wide }
    }

    /// Returns the width and the height of the picture in pixels.
    pub fn size(&self) -> [f64; 2] {
        let extent = (self.bounds.max - self.bounds.min) * self.scale;
        [extent.x.round(), extent.y.round()]
    }

    /// Returns the position in the picture of a point of the ground.
    pub fn at(&self, point: Vector2<f64>) -> Pixel {
        [(point.x - self.bounds.min.x) * self.scale, (self.bounds.max.y - point.y) * self.scale]
    }

    /// Returns `true` if a point is inside the view or at most `beyond` metres outside its edge.
    pub fn shows(&self, point: Vector2<f64>, beyond: f64) -> bool {
        Bounds { min: point, max: point }.meets(&self.bounds.grown(beyond))
    }

    /// Returns the path of a line `offset` metres to the left of a curve.
    pub fn curve(&self, curve: &Curve, offset: f64) -> Contour {
        let mut contour = Contour { segments: vec![PathSegment::Move(self.at(curve.beside(0.0, offset)))] };
        self.along(&mut contour, curve, offset, [0.0, curve.length()]);
        contour
    }

    /// Returns the path of the middle line of a lane.
    pub fn line(&self, line: &Centreline) -> Contour {
        let mut contour = Contour { segments: vec![PathSegment::Move(self.at(line.point(0.0)))] };
        line.curves().for_each(|curve| self.along(&mut contour, curve, 0.0, [0.0, curve.length()]));
        contour
    }

    /// Extends a path along a line `offset` metres to the left of a curve.
    pub fn along(&self, contour: &mut Contour, curve: &Curve, offset: f64, [from, to]: [f64; 2]) {
        if curve.curvature() == 0.0 {
            return contour.segments.push(PathSegment::Line(self.at(curve.beside(to, offset))));
        }
        let turn = curve.curvature() * (to - from);
        let pieces = (turn.abs() / FRAC_PI_4).ceil().max(1.0);
        let reach = 4.0 / 3.0 * libm::tan(0.25 * turn / pieces) * (1.0 / curve.curvature() - offset);
        for piece in 1..=pieces as usize {
            let [a, b] = [piece - 1, piece].map(|piece| from + (to - from) * piece as f64 / pieces);
            let ahead = |s: f64| curve.at(s).forward() * reach;
            let [start, end] = [a, b].map(|s| curve.beside(s, offset));
            let points = [start + ahead(a), end - ahead(b), end].map(|point| self.at(point));
            contour.segments.push(PathSegment::Cubic(points[0], points[1], points[2]));
        }
    }
}
