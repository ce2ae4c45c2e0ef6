//! The canvas on which plotters draws: lines, shapes and letters with smooth edges. It is used because plotters' own
//! canvas moves every letter to a whole pixel, so that words come apart.

use super::letters::letters;
use super::{Look, fill, painted, stroke};
use crate::birds_eye::Anchor;
use crate::plot::FONT;
use ab_glyph::FontRef;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontTransform,
};
use std::convert::Infallible;
use tiny_skia::{Color, Paint, Path, PathBuilder, Pixmap, Rect, Transform};

/// The size of a font as plotters counts it, over the font's em: the same ratio as in plotters' SVG.
const PER_EM: f64 = 1.24;
/// The height of a capital letter, and half the height of a small letter, in ems.
const CAPITAL: f64 = 0.76;
const HALF_SMALL: f64 = 0.27;

type Done = Result<(), DrawingErrorKind<Infallible>>;

/// The pixels that plotters draws on.
pub(in crate::plot) struct Canvas<'a> {
    pixels: &'a mut Pixmap,
    font: FontRef<'static>,
}

impl<'a> Canvas<'a> {
    /// Makes a canvas that draws on the given pixels.
    pub fn on(pixels: &'a mut Pixmap) -> Self {
        Self { pixels, font: FontRef::try_from_slice(FONT).expect("the font in the program is a font") }
    }

    fn fill(&mut self, path: Option<Path>, colour: BackendColor) -> Done {
        fill(self.pixels, path, &paint(colour), Transform::identity());
        Ok(())
    }

    fn stroke<S: BackendStyle>(&mut self, path: Option<Path>, style: &S) -> Done {
        let width = f64::from(style.stroke_width());
        stroke(self.pixels, path, &paint(style.color()), width, None, Transform::identity());
        Ok(())
    }
}

/// Returns the path of a line through points. Lines of an odd width run through the middles of pixels, others between
/// two pixels, so that their edges are edges of pixels.
fn line(points: impl IntoIterator<Item = BackendCoord>, style: &impl BackendStyle) -> PathBuilder {
    polygon(points, 0.5 * (style.stroke_width() % 2) as f32)
}

fn polygon(points: impl IntoIterator<Item = BackendCoord>, offset: f32) -> PathBuilder {
    let mut path = PathBuilder::new();
    for (x, y) in points {
        let (x, y) = (x as f32 + offset, y as f32 + offset);
        if path.is_empty() { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    path
}

fn closed(mut path: PathBuilder) -> Option<Path> {
    path.close();
    path.finish()
}

fn paint(colour: BackendColor) -> Paint<'static> {
    let (red, green, blue) = colour.rgb;
    painted(Look { colour: [red, green, blue], opacity: colour.alpha })
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.pixels.width(), self.pixels.height())
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    fn present(&mut self) -> Done {
        Ok(())
    }

    fn draw_pixel(&mut self, at: BackendCoord, colour: BackendColor) -> Done {
        let square = Rect::from_xywh(at.0 as f32, at.1 as f32, 1.0, 1.0).map(PathBuilder::from_rect);
        self.fill(square, colour)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Done {
        self.stroke(line([from, to], style).finish(), style)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, points: I, style: &S) -> Done {
        self.stroke(line(points, style).finish(), style)
    }

    fn draw_rect<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S, filled: bool) -> Done {
        let corners = |to: BackendCoord| [from, (to.0, from.1), to, (from.0, to.1)];
        if filled {
            // The pixel at the last corner is part of the rectangle.
            self.fill(closed(polygon(corners((to.0 + 1, to.1 + 1)), 0.0)), style.color())
        } else {
            self.stroke(closed(line(corners(to), style)), style)
        }
    }

    fn draw_circle<S: BackendStyle>(&mut self, middle: BackendCoord, radius: u32, style: &S, filled: bool) -> Done {
        let circle = PathBuilder::from_circle(middle.0 as f32 + 0.5, middle.1 as f32 + 0.5, radius as f32);
        if filled { self.fill(circle, style.color()) } else { self.stroke(circle, style) }
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, corners: I, style: &S) -> Done {
        self.fill(closed(polygon(corners, 0.5)), style.color())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Done {
        let em = style.size() / PER_EM;
        let anchor = match style.anchor().h_pos {
            HPos::Left => Anchor::Start,
            HPos::Center => Anchor::Middle,
            HPos::Right => Anchor::End,
        };
        let down = match style.anchor().v_pos {
            VPos::Top => CAPITAL,
            VPos::Center => HALF_SMALL,
            VPos::Bottom => -HALF_SMALL,
        };
        let turn = match style.transform() {
            FontTransform::None => 0.0,
            FontTransform::Rotate90 => 90.0,
            FontTransform::Rotate180 => 180.0,
            FontTransform::Rotate270 => 270.0,
        };
        let (x, y) = (at.0 as f32, at.1 as f32);
        let letters = letters(&self.font, text, [f64::from(x), f64::from(y) + down * em], anchor, em);
        fill(self.pixels, letters, &paint(style.color()), Transform::from_rotate_at(turn, x, y));
        Ok(())
    }
}

/// Returns the pixels of a white sheet.
pub(in crate::plot) fn sheet(width: u32, height: u32) -> Pixmap {
    let mut pixels = Pixmap::new(width, height).expect("a picture is not empty and fits into memory");
    pixels.fill(Color::WHITE);
    pixels
}
