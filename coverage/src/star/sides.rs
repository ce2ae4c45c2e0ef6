//! Boxes as the positions of their free sides, so that one search serves both anchored boxes and all boxes.
//!
//! A side's position says how far the box reaches in the side's direction: `y` for an upper side at `y`, `-a` for a
//! lower side at `a`. Points have coordinates of the same kind. A box holds a point if the point's coordinate is
//! below the position on every side. Negation is exact, and sums and products of floating-point numbers are monotone:
//! a box inside another is never computed to be larger, and a computed bound is at least the computed value of every
//! box that it drops.

use crate::PointSet;
use crate::ordered::greatest;

/// A set of points, with the coordinates of the points in the directions of the free sides of boxes.
pub(crate) struct Sides<'a> {
    points: &'a PointSet,
    anchored: bool,
}

impl<'a> Sides<'a> {
    /// Makes the sides for boxes `[0, y)`, which have one free side per axis.
    pub(crate) fn of_anchored_boxes(points: &'a PointSet) -> Self {
        Self { points, anchored: true }
    }

    /// Makes the sides for all boxes, which have two free sides per axis. The sides `2 j` and `2 j + 1` bound axis `j`
    /// from below and above.
    pub(crate) fn of_all_boxes(points: &'a PointSet) -> Self {
        Self { points, anchored: false }
    }

    /// Returns the number of free sides of a box.
    pub(super) fn count(&self) -> usize {
        self.points.dims() * self.per_axis()
    }

    pub(super) fn per_axis(&self) -> usize {
        if self.anchored { 1 } else { 2 }
    }

    pub(crate) fn points(&self) -> usize {
        self.points.len()
    }

    /// Returns the coordinate of a point in the direction of a side.
    pub(super) fn coordinate(&self, point: usize, side: usize) -> f64 {
        let point = self.points.point(point);
        if self.anchored {
            return point[side];
        }
        let x = point[side / 2];
        if side % 2 == 1 { x } else { -x }
    }

    /// Returns the farthest position of a side in the cube.
    pub(super) fn end(&self, side: usize) -> f64 {
        if self.anchored || side % 2 == 1 { 1.0 } else { 0.0 }
    }

    /// Returns the width of a box along an axis; 0 if the sides of the box have passed each other.
    pub(super) fn width(&self, axis: usize, positions: &[f64]) -> f64 {
        if self.anchored { positions[axis] } else { greatest(positions[2 * axis] + positions[2 * axis + 1], 0.0) }
    }

    /// Returns the volume of a box, which is the product of its widths in the order of the axes.
    pub(super) fn volume(&self, positions: &[f64]) -> f64 {
        (0..self.points.dims()).map(|axis| self.width(axis, positions)).product()
    }

    /// Returns the product of the widths of a box along all axes except the axis `without`.
    pub(super) fn volume_across(&self, without: usize, positions: &[f64]) -> f64 {
        (0..self.points.dims()).filter(|axis| *axis != without).map(|axis| self.width(axis, positions)).product()
    }

    /// Returns the farthest position of a side at which the box has the given width along the side's axis.
    pub(super) fn position(&self, side: usize, width: f64, positions: &[f64]) -> f64 {
        if self.anchored { width } else { width - positions[side ^ 1] }
    }

    /// Returns a number of points as a share of all points.
    pub(crate) fn share(&self, count: usize) -> f64 {
        count as f64 / self.points.len() as f64
    }
}
