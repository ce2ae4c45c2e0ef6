//! Rectangles on images.

use serde::{Deserialize, Serialize};

/// A rectangle on an image, in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Rect {
    /// The distance of the left edge from the left edge of the image.
    pub left: f64,
    /// The distance of the upper edge from the upper edge of the image.
    pub top: f64,
    /// The width.
    pub width: f64,
    /// The height.
    pub height: f64,
}

impl Rect {
    /// Makes a rectangle from two opposite corners, each as x and y.
    pub fn between([left, top]: [f64; 2], [right, bottom]: [f64; 2]) -> Self {
        Self { left, top, width: right - left, height: bottom - top }
    }

    /// Returns the area in square pixels.
    pub fn area(&self) -> f64 {
        self.width * self.height
    }

    /// Returns the middle as x and y.
    pub fn centre(&self) -> [f64; 2] {
        [self.left + 0.5 * self.width, self.top + 0.5 * self.height]
    }

    /// Returns the length of the diagonal in pixels.
    pub fn diagonal(&self) -> f64 {
        libm::hypot(self.width, self.height)
    }

    /// Returns the area that two rectangles share, in square pixels.
    pub fn shared(&self, other: &Self) -> f64 {
        let along = |a: f64, length_a: f64, b: f64, length_b: f64| (a + length_a).min(b + length_b) - a.max(b);
        let width = along(self.left, self.width, other.left, other.width);
        let height = along(self.top, self.height, other.top, other.height);
        if width <= 0.0 || height <= 0.0 { 0.0 } else { width * height }
    }

    /// Returns the intersection over union (IoU), from 0 to 1.
    pub fn overlap(&self, other: &Self) -> f64 {
        let shared = self.shared(other);
        if shared <= 0.0 { 0.0 } else { shared / (self.area() + other.area() - shared) }
    }

    /// Returns the share of this rectangle that lies in another rectangle, from 0 to 1.
    pub fn share_in(&self, other: &Self) -> f64 {
        let shared = self.shared(other);
        if shared <= 0.0 { 0.0 } else { shared / self.area() }
    }

    /// Returns the part of the rectangle that lies on an image; `None` if no part of it does.
    pub fn within(&self, width: f64, height: f64) -> Option<Self> {
        let clamped = |from: f64, length: f64, most: f64| (from.clamp(0.0, most), (from + length).clamp(0.0, most));
        let (left, right) = clamped(self.left, self.width, width);
        let (top, bottom) = clamped(self.top, self.height, height);
        (left < right && top < bottom).then(|| Self::between([left, top], [right, bottom]))
    }
}
