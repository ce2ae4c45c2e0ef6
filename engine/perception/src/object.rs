//! The objects of the ground truth, and the sizes of objects that a measure counts.

use crate::Rect;

/// An object of the ground truth in an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Object {
    /// The box of the object on the image.
    pub rect: Rect,
    /// The area of the object in square pixels, by which measures choose objects by size.
    pub area: f64,
    /// True if it does not matter whether the object is detected. Any number of detections may lie in such an object.
    pub crowd: bool,
}

/// A range of areas in square pixels. Objects of other areas are ignored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Areas {
    /// The least area.
    pub least: f64,
    /// The greatest area.
    pub most: f64,
}

impl Areas {
    /// All areas; the bound is COCO's.
    pub const ALL: Self = Self { least: 0.0, most: 1e10 };

    /// Returns `true` if the range contains an area.
    pub fn contains(&self, area: f64) -> bool {
        self.least <= area && area <= self.most
    }

    /// Returns `true` if an object counts: it is no crowd, and its area is within the range.
    pub fn count(&self, object: &Object) -> bool {
        !object.crowd && self.contains(object.area)
    }
}
