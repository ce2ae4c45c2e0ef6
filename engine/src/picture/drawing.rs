//! What is on a picture, before anybody has chosen a file format: marks in pixels, later ones over earlier ones.
//!
//! Everything curved is a cubic Bézier curve. That is what SVG, fonts and rasterisers have in common, so that each of
//! them shows the same picture.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

pub use crate::object::Colour;

/// Pixels to the right of the upper left corner, and below it.
pub type Pixel = [f64; 2];

/// A picture of some width and height in pixels. What reaches beyond them is cut off.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Its width, a whole number.
    pub width: f64,
    /// Its height, a whole number.
    pub height: f64,
    /// What is on it, from the ground up.
    pub marks: Vec<PictureItem>,
}

/// One thing on a picture.
#[derive(Debug, Clone, PartialEq)]
pub enum PictureItem {
    /// A filled area: what is inside by the non-zero rule.
    Fill {
        /// Its outline.
        contour: Contour,
        /// What it is filled with.
        paint: Paint,
    },
    /// A line with round ends and joins.
    Stroke {
        /// The way of the pen.
        contour: Contour,
        /// What it leaves.
        paint: Paint,
        /// Its width in pixels.
        width: f64,
        /// Pixels of dash and of gap, for a broken line.
        dash: Option<[f64; 2]>,
    },
    /// A line of text.
    Text {
        /// Where its baseline begins, has its middle, or ends.
        at: Pixel,
        /// Which of these.
        anchor: Anchor,
        /// The height of its letters, as fonts count it.
        size: f64,
        /// Its colour.
        colour: Colour,
        /// The colour of a rim that sets it off from what is behind it.
        halo: Option<Colour>,
        /// What it says.
        text: String,
    },
    /// A picture within the picture, which cuts off what reaches beyond it.
    Inset {
        /// Where its upper left corner is.
        at: Pixel,
        /// The picture.
        drawing: Drawing,
    },
}

/// What of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A colour, and how much of what is behind it is hidden.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paint {
    /// The colour.
    pub colour: Colour,
    /// From 0, nothing is hidden, to 1.
    pub opacity: f64,
}

impl From<Colour> for Paint {
    fn from(colour: Colour) -> Self {
        Self { colour, opacity: 1.0 }
    }
}

impl Paint {
    /// Some of it.
    pub(super) fn faint(self, share: f64) -> Self {
        Self { opacity: self.opacity * share, ..self }
    }
}

/// A line that a pen follows, lifted now and then.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Contour {
    /// What the pen does, in turn.
    pub segments: Vec<PathSegment>,
}

/// A movement of the pen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathSegment {
    /// Lifted, to a place.
    Move(Pixel),
    /// Straight to a place.
    Line(Pixel),
    /// By two control points to a place.
    Cubic(Pixel, Pixel, Pixel),
    /// Straight to where it was put down last.
    Close,
}

impl Contour {
    /// The line through these points.
    pub(super) fn polyline(points: impl IntoIterator<Item = Pixel>) -> Self {
        let mut contour = Self::default();
        for point in points {
            let first = contour.segments.is_empty();
            contour.segments.push(if first { PathSegment::Move(point) } else { PathSegment::Line(point) });
        }
        contour
    }

    /// The polygon with these corners.
    pub(super) fn polygon(corners: impl IntoIterator<Item = Pixel>) -> Self {
        let mut contour = Self::polyline(corners);
        contour.segments.push(PathSegment::Close);
        contour
    }

    /// The rectangle between two corners.
    pub(super) fn rectangle([left, top]: Pixel, [right, bottom]: Pixel) -> Self {
        Self::polygon([[left, top], [right, top], [right, bottom], [left, bottom]])
    }

    /// A circle.
    pub(super) fn circle([x, y]: Pixel, radius: f64) -> Self {
        // The control points of a quarter that is right to 0.03 % of the radius.
        let reach = 4.0 / 3.0 * libm::tan(0.25 * FRAC_PI_2);
        let on = |i: usize| {
            let (sin, cos) = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][i % 4];
            ([x + radius * cos, y + radius * sin], [-radius * reach * sin, radius * reach * cos])
        };
        let mut segments = vec![PathSegment::Move(on(0).0)];
        for i in 0..4 {
            let ((from, out), (to, into)) = (on(i), on(i + 1));
            segments.push(PathSegment::Cubic(
                [from[0] + out[0], from[1] + out[1]],
                [to[0] - into[0], to[1] - into[1]],
                to,
            ));
        }
        segments.push(PathSegment::Close);
        Self { segments }
    }

    /// A star of this many points.
    pub(super) fn star([x, y]: Pixel, points: usize, outer: f64, inner: f64) -> Self {
        Self::polygon((0..2 * points).map(|i| {
            let (sin, cos) = libm::sincos(i as f64 * TAU / (2 * points) as f64 - 2.0 * FRAC_PI_4);
            let radius = if i % 2 == 0 { outer } else { inner };
            [x + radius * cos, y + radius * sin]
        }))
    }

    pub(super) fn fill(self, paint: impl Into<Paint>) -> PictureItem {
        PictureItem::Fill { contour: self, paint: paint.into() }
    }

    pub(super) fn stroke(self, paint: impl Into<Paint>, width: f64) -> PictureItem {
        PictureItem::Stroke { contour: self, paint: paint.into(), width, dash: None }
    }

    pub(super) fn dashed(self, paint: impl Into<Paint>, width: f64, dash: [f64; 2]) -> PictureItem {
        PictureItem::Stroke { contour: self, paint: paint.into(), width, dash: Some(dash) }
    }
}
