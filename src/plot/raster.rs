//! Pictures of worlds and runs as pixels: the one module that names tiny-skia.

use super::FONT;
use crate::engine::picture::{Anchor, Contour, Drawing, Mark, Paint as Look, Pixel, Segment};
use ab_glyph::{Font, FontRef, OutlineCurve, Point};
use std::error::Error as StdError;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Stroke, StrokeDash, Transform,
};

/// A drawing as pixels, each `scale` times as wide and high as it says.
pub(super) fn rasterised(drawing: &Drawing, scale: f32) -> Pixmap {
    let [width, height] = [drawing.width, drawing.height].map(|length| (length as f32 * scale).round().max(1.0) as u32);
    let mut pixels = Pixmap::new(width, height).expect("a picture is not empty and fits into memory");
    draw(&mut pixels, drawing, scale);
    pixels
}

/// Draws over what is there.
pub(super) fn draw(pixels: &mut Pixmap, drawing: &Drawing, scale: f32) {
    let font = FontRef::try_from_slice(FONT).expect("the font in the program is a font");
    let zoom = Transform::from_scale(scale, scale);
    for mark in &drawing.marks {
        match mark {
            Mark::Fill { contour, paint } => fill(pixels, path(contour), &painted(*paint), zoom),
            Mark::Stroke { contour, paint, width, dash } => {
                let dash = dash.and_then(|[dash, gap]| StrokeDash::new(vec![dash as f32, gap as f32], 0.0));
                stroke(pixels, path(contour), &painted(*paint), *width, dash, zoom);
            }
            Mark::Text { at, anchor, size, colour, halo, text } => {
                let letters = || letters(&font, text, *at, *anchor, *size);
                if let Some(halo) = halo {
                    stroke(pixels, letters(), &painted((*halo).into()), 0.25 * size, None, zoom);
                }
                fill(pixels, letters(), &painted((*colour).into()), zoom);
            }
            Mark::Inset { at, drawing } => {
                let inset = rasterised(drawing, scale);
                let [x, y] = at.map(|pixel| (pixel as f32 * scale).round() as i32);
                pixels.draw_pixmap(x, y, inset.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
            }
        }
    }
}

/// The picture as the contents of a PNG file, at twice the size, so that it is sharp on any screen.
///
/// # Errors
/// The encoder fails.
pub(crate) fn png(drawing: &Drawing) -> Result<Vec<u8>, Box<dyn StdError + Send + Sync>> {
    let pixels = rasterised(drawing, super::PNG_SCALE as f32);
    super::encode_png(pixels.width(), pixels.height(), &opaque(&pixels))
}

/// Red, green and blue of every pixel of a picture that hides what is behind it.
pub(super) fn opaque(pixels: &Pixmap) -> Vec<u8> {
    pixels.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect()
}

fn painted(look: Look) -> Paint<'static> {
    let [red, green, blue] = look.colour;
    let opacity = (look.opacity * 255.0).round() as u8;
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(Color::from_rgba8(red, green, blue, opacity));
    paint
}

/// Nothing is drawn of what has no extent or goes beyond all numbers.
fn fill(pixels: &mut Pixmap, path: Option<Path>, paint: &Paint, zoom: Transform) {
    if let Some(path) = path {
        pixels.fill_path(&path, paint, FillRule::Winding, zoom, None);
    }
}

fn stroke(
    pixels: &mut Pixmap,
    path: Option<Path>,
    paint: &Paint,
    width: f64,
    dash: Option<StrokeDash>,
    zoom: Transform,
) {
    let (line_cap, line_join) = (LineCap::Round, LineJoin::Round);
    let stroke = Stroke { width: width as f32, line_cap, line_join, dash, ..Stroke::default() };
    if let Some(path) = path {
        pixels.stroke_path(&path, paint, &stroke, zoom, None);
    }
}

fn path(contour: &Contour) -> Option<Path> {
    let mut path = PathBuilder::new();
    let single = |[x, y]: Pixel| (x as f32, y as f32);
    for segment in &contour.segments {
        match *segment {
            Segment::Move(to) => {
                let (x, y) = single(to);
                path.move_to(x, y);
            }
            Segment::Line(to) => {
                let (x, y) = single(to);
                path.line_to(x, y);
            }
            Segment::Cubic(a, b, to) => {
                let ((ax, ay), (bx, by), (x, y)) = (single(a), single(b), single(to));
                path.cubic_to(ax, ay, bx, by, x, y);
            }
            Segment::Close => path.close(),
        }
    }
    path.finish()
}

/// The outlines of the letters of a text.
fn letters(font: &FontRef, text: &str, [x, y]: Pixel, anchor: Anchor, size: f64) -> Option<Path> {
    let scale = size as f32 / font.units_per_em()?;
    let glyphs: Vec<_> = text.chars().map(|letter| font.glyph_id(letter)).collect();
    let width: f32 = glyphs.iter().map(|glyph| scale * font.h_advance_unscaled(*glyph)).sum();
    let mut pen = x as f32
        - match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * width,
            Anchor::End => width,
        };
    let mut path = PathBuilder::new();
    for glyph in glyphs {
        let place = |point: Point| (pen + scale * point.x, y as f32 - scale * point.y);
        let mut at = None;
        for curve in font.outline(glyph).into_iter().flat_map(|outline| outline.curves) {
            let (OutlineCurve::Line(from, _) | OutlineCurve::Quad(from, ..) | OutlineCurve::Cubic(from, ..)) = curve;
            // Curves follow each other; where one begins elsewhere, so does a new part of the letter.
            if at != Some(from) {
                path.move_to(place(from).0, place(from).1);
            }
            at = Some(match curve {
                OutlineCurve::Line(_, to) => {
                    path.line_to(place(to).0, place(to).1);
                    to
                }
                OutlineCurve::Quad(_, a, to) => {
                    path.quad_to(place(a).0, place(a).1, place(to).0, place(to).1);
                    to
                }
                OutlineCurve::Cubic(_, a, b, to) => {
                    path.cubic_to(place(a).0, place(a).1, place(b).0, place(b).1, place(to).0, place(to).1);
                    to
                }
            });
        }
        pen += scale * font.h_advance_unscaled(glyph);
    }
    path.finish()
}
