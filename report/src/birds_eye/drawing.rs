//! The elements of a picture before a file format is chosen: marks in pixels, later marks over earlier marks.
//!
//! Everything curved is a cubic Bézier curve. SVG, fonts and rasterisers all support these curves, so each shows the
//! same picture.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

pub use paracosm_engine::object::Colour;

/// A position in a picture, in pixels to the right of the upper left corner and pixels below it.
pub type Pixel = [f64; 2];

/// A vector picture with its width and height in pixels. Parts beyond its edges are cut off.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// The width of the picture in pixels, which is a whole number.
    pub width: f64,
    /// The height of the picture in pixels, which is a whole number.
    pub height: f64,
    /// The elements of the picture, from the bottom to the top.
    pub marks: Vec<PictureItem>,
}

/// An element of a vector picture, such as an area, a line or a text.
#[derive(Debug, Clone, PartialEq)]
pub enum PictureItem {
    /// A filled area, whose inside is given by the non-zero rule.
    Fill {
        /// The outline of the area.
        contour: Contour,
        /// The colour and the opacity of the area.
        paint: Paint,
    },
    /// A line with round ends and joins.
    Stroke {
        /// The course of the line.
        contour: Contour,
        /// The colour and the opacity of the line.
        paint: Paint,
        /// The width of the line in pixels.
        width: f64,
        /// The lengths in pixels of a dash and of a gap; `None` for an unbroken line.
        dash: Option<[f64; 2]>,
    },
    /// A line of text.
    Text {
        /// The position in the picture of the text's anchor, on the baseline of the text.
        at: Pixel,
        /// The part of the text that is at the position `at`.
        anchor: Anchor,
        /// The font size in pixels.
        size: f64,
        /// The colour of the text.
        colour: Colour,
        /// The colour of a rim around the letters, which separates the text from its background.
        halo: Option<Colour>,
        /// The characters of the text.
        text: String,
    },
    /// A smaller picture within the picture. Parts beyond its edges are cut off.
    Inset {
        /// The position of the upper left corner of the smaller picture.
        at: Pixel,
        /// The smaller picture.
        drawing: Drawing,
    },
}

/// The part of a text that is at the given position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The beginning of the text.
    Start,
    /// The middle of the text.
    Middle,
    /// The end of the text.
    End,
}

/// A colour with its opacity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paint {
    /// The colour without the opacity.
    pub colour: Colour,
    /// The opacity of the colour, from 0 (invisible) to 1 (hides everything behind it).
    pub opacity: f64,
}

impl From<Colour> for Paint {
    fn from(colour: Colour) -> Self {
        Self { colour, opacity: 1.0 }
    }
}

impl Paint {
    /// Returns the paint with its opacity multiplied by `share`.
    pub(super) fn faint(self, share: f64) -> Self {
        Self { opacity: self.opacity * share, ..self }
    }
}

/// A path of lines and curves, which may have several separate parts.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Contour {
    /// The lines, curves and jumps of the path, in their order.
    pub segments: Vec<PathSegment>,
}

/// A step of a path, drawn by a pen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathSegment {
    /// A jump of the pen to a position, without a line.
    Move(Pixel),
    /// A straight line to a position.
    Line(Pixel),
    /// A cubic Bézier curve with two control points and an end position.
    Cubic(Pixel, Pixel, Pixel),
    /// A straight line back to the start of the current part of the path, which closes the part.
    Close,
}

impl Contour {
    /// Makes the line through these points.
    pub(super) fn polyline(points: impl IntoIterator<Item = Pixel>) -> Self {
        let mut contour = Self::default();
        for point in points {
            let first = contour.segments.is_empty();
            contour.segments.push(if first { PathSegment::Move(point) } else { PathSegment::Line(point) });
        }
        contour
    }

    /// Makes the polygon with these corners.
    pub(super) fn polygon(corners: impl IntoIterator<Item = Pixel>) -> Self {
        let mut contour = Self::polyline(corners);
        contour.segments.push(PathSegment::Close);
        contour
    }

    /// Makes the rectangle between two corners.
    pub(super) fn rectangle([left, top]: Pixel, [right, bottom]: Pixel) -> Self {
        Self::polygon([[left, top], [right, top], [right, bottom], [left, bottom]])
    }

    /// Makes a circle.
    pub(super) fn circle([x, y]: Pixel, radius: f64) -> Self {
        // The control points of a quarter circle, with an error of at most 0.03 % of the radius.
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

    /// Makes a star of this many points.
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
