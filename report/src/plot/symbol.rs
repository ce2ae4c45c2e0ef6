//! Draws the marks of curves, whose shapes can be told apart without colour.

use paracosm_generators::{Look, MarkShape};
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::*;
use plotters_backend::DrawingErrorKind;

/// The size of marks, in pixels of the SVG.
const SIDE: f64 = 4.2;
/// The width of lines. Half of it is a whole number of pixels in both the SVG and the PNG, so that the plotter rounds
/// in the same way for lines of any direction.
pub(super) const LINE: f64 = 2.0;

/// Returns the colour of curves of a look.
pub(super) fn rgb(look: Look) -> RGBColor {
    let (r, g, b) = look.colour;
    RGBColor(r, g, b)
}

/// A mark of a curve, `side` pixels from its middle to its end.
pub(super) struct Symbol {
    /// The shape of the mark; `None` for a cross.
    shape: Option<MarkShape>,
    colour: RGBColor,
    filled: bool,
    side: f64,
}

impl Symbol {
    pub fn of(look: Look, scale: f64) -> Self {
        Self { shape: Some(look.shape), colour: rgb(look), filled: look.filled, side: SIDE * scale }
    }

    pub fn cross(colour: RGBColor, scale: f64) -> Self {
        Self { shape: None, colour, filled: true, side: SIDE * scale }
    }

    /// Fills the shape of the mark, scaled by a share of the mark's size.
    fn fill<B: DrawingBackend>(
        &self,
        backend: &mut B,
        (x, y): (i32, i32),
        share: f64,
        colour: RGBColor,
    ) -> std::result::Result<(), DrawingErrorKind<B::ErrorType>> {
        // The shapes have about the same area.
        let corners: &[(f64, f64)] = match self.shape {
            Some(MarkShape::Circle) => {
                return backend.draw_circle((x, y), (1.1 * share * self.side).round() as u32, &colour, true);
            }
            Some(MarkShape::Square) => &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)],
            Some(MarkShape::Diamond) => &[(0.0, -1.5), (1.5, 0.0), (0.0, 1.5), (-1.5, 0.0)],
            Some(MarkShape::Triangle) => &[(0.0, -1.4), (1.3, 0.9), (-1.3, 0.9)],
            Some(MarkShape::Tip) => &[(0.0, 1.4), (1.3, -0.9), (-1.3, -0.9)],
            None => &[],
        };
        let along = |middle: i32, offset: f64| middle + (offset * share * self.side).round() as i32;
        backend.fill_polygon(corners.iter().map(|(right, down)| (along(x, *right), along(y, *down))), &colour)
    }
}

impl<'a> PointCollection<'a, (i32, i32)> for &'a Symbol {
    type Point = (i32, i32);
    type IntoIter = std::iter::Once<(i32, i32)>;

    fn point_iter(self) -> Self::IntoIter {
        std::iter::once((0, 0))
    }
}

impl<B: DrawingBackend> Drawable<B> for Symbol {
    fn draw<I: Iterator<Item = (i32, i32)>>(
        &self,
        mut points: I,
        backend: &mut B,
        _: (u32, u32),
    ) -> std::result::Result<(), DrawingErrorKind<B::ErrorType>> {
        let Some((x, y)) = points.next() else { return Ok(()) };
        if self.shape.is_none() {
            let (side, stroke) =
                ((0.95 * self.side).round() as i32, self.colour.stroke_width((0.45 * self.side) as u32));
            backend.draw_line((x - side, y - side), (x + side, y + side), &stroke)?;
            return backend.draw_line((x - side, y + side), (x + side, y - side), &stroke);
        }
        self.fill(backend, (x, y), 1.0, self.colour)?;
        if self.filled { Ok(()) } else { self.fill(backend, (x, y), 0.5, WHITE) }
    }
}
