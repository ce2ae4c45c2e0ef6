//! Draws pictures of worlds and runs as pixels. This module alone uses tiny-skia.

mod canvas;
mod letters;

pub(super) use canvas::{Canvas, sheet};

use super::FONT;
use crate::birds_eye::{Contour, Drawing, Paint as Look, PathSegment, PictureItem, Pixel};
use ab_glyph::FontRef;
use letters::letters;
use std::error::Error as StdError;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Stroke, StrokeDash, Transform,
};

/// Returns a drawing as pixels, with `scale` times the drawing's width and height.
pub(super) fn rasterised(drawing: &Drawing, scale: f32) -> Pixmap {
    let [width, height] = [drawing.width, drawing.height].map(|length| (length as f32 * scale).round().max(1.0) as u32);
    let mut pixels = Pixmap::new(width, height).expect("a picture is not empty and fits into memory");
    draw(&mut pixels, drawing, scale);
    pixels
}

/// Draws over the existing pixels.
pub(super) fn draw(pixels: &mut Pixmap, drawing: &Drawing, scale: f32) {
    let font = FontRef::try_from_slice(FONT).expect("the font in the program is a font");
    let zoom = Transform::from_scale(scale, scale);
    for mark in &drawing.marks {
        match mark {
            PictureItem::Fill { contour, paint } => fill(pixels, path(contour), &painted(*paint), zoom),
            PictureItem::Stroke { contour, paint, width, dash } => {
                let dash = dash.and_then(|[dash, gap]| StrokeDash::new(vec![dash as f32, gap as f32], 0.0));
                stroke(pixels, path(contour), &painted(*paint), *width, dash, zoom);
            }
            PictureItem::Text { at, anchor, size, colour, halo, text } => {
                let letters = || letters(&font, text, *at, *anchor, *size);
                if let Some(halo) = halo {
                    stroke(pixels, letters(), &painted((*halo).into()), 0.25 * size, None, zoom);
                }
                fill(pixels, letters(), &painted((*colour).into()), zoom);
            }
            PictureItem::Inset { at, drawing } => {
                let inset = rasterised(drawing, scale);
                let [x, y] = at.map(|pixel| (pixel as f32 * scale).round() as i32);
                pixels.draw_pixmap(x, y, inset.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
            }
        }
    }
}

/// Returns a vector picture as the contents of a PNG file with twice the width and height, for sharpness on any screen.
///
/// # Errors
/// Returns an error if the encoder fails.
pub fn drawing_png(drawing: &Drawing) -> Result<Vec<u8>, Box<dyn StdError + Send + Sync>> {
    let pixels = rasterised(drawing, super::PNG_SCALE as f32);
    super::encode_png(pixels.width(), pixels.height(), &opaque(&pixels))
}

/// Returns red, green and blue of every pixel of a picture without transparent pixels.
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

/// Fills a path with a colour. A path without extent, or with coordinates that are not finite, is not drawn.
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
            PathSegment::Move(to) => {
                let (x, y) = single(to);
                path.move_to(x, y);
            }
            PathSegment::Line(to) => {
                let (x, y) = single(to);
                path.line_to(x, y);
            }
            PathSegment::Cubic(a, b, to) => {
                let ((ax, ay), (bx, by), (x, y)) = (single(a), single(b), single(to));
                path.cubic_to(ax, ay, bx, by, x, y);
            }
            PathSegment::Close => path.close(),
        }
    }
    path.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::birds_eye::{Anchor, Colour};

    const WHITE: Colour = [255, 255, 255];
    const RED: Colour = [200, 0, 0];

    fn square(from: f64, to: f64, colour: Colour, opacity: f64) -> PictureItem {
        let corners = [[from, from], [to, from], [to, to], [from, to]];
        let mut segments = vec![PathSegment::Move(corners[0])];
        segments.extend(corners[1..].iter().map(|corner| PathSegment::Line(*corner)));
        segments.push(PathSegment::Close);
        PictureItem::Fill { contour: Contour { segments }, paint: Look { colour, opacity } }
    }

    fn drawing(marks: Vec<PictureItem>) -> Drawing {
        let background = square(0.0, 40.0, WHITE, 1.0);
        Drawing { width: 40.0, height: 40.0, marks: [vec![background], marks].concat() }
    }

    /// Returns the colour of a pixel.
    fn at(drawing: &Drawing, scale: u32, x: u32, y: u32) -> Vec<u8> {
        let first = 3 * (y * 40 * scale + x) as usize;
        opaque(&rasterised(drawing, scale as f32))[first..first + 3].to_vec()
    }

    #[test]
    fn what_is_filled_has_its_colour_and_what_is_faint_half_of_it() {
        let solid = drawing(vec![square(10.0, 20.0, RED, 1.0)]);
        assert_eq!([at(&solid, 1, 9, 15), at(&solid, 1, 10, 15), at(&solid, 1, 20, 15)], [WHITE, RED, WHITE]);
        assert_eq!([at(&solid, 2, 19, 30), at(&solid, 2, 20, 30), at(&solid, 2, 40, 30)], [WHITE, RED, WHITE]);
        let faint = at(&drawing(vec![square(10.0, 20.0, [0, 0, 0], 0.5)]), 1, 15, 15);
        assert!(faint.iter().all(|part| part.abs_diff(127) <= 1), "{faint:?}");
    }

    #[test]
    fn an_inset_cuts_off_what_reaches_beyond_it() {
        let inset = Drawing { width: 10.0, height: 10.0, marks: vec![square(-50.0, 50.0, RED, 1.0)] };
        let drawing = drawing(vec![PictureItem::Inset { at: [20.0, 10.0], drawing: inset }]);
        for (x, y, colour) in [(20, 10, RED), (29, 19, RED), (19, 10, WHITE), (30, 19, WHITE), (20, 9, WHITE)] {
            assert_eq!(at(&drawing, 1, x, y), colour, "at {x}, {y}");
        }
    }

    /// Returns the numbers of dark pixels left and right of the middle.
    fn dark(anchor: Anchor, text: &str) -> [usize; 2] {
        let text = text.to_owned();
        let text = PictureItem::Text { at: [20.0, 30.0], anchor, size: 12.0, colour: [0, 0, 0], halo: None, text };
        let pixels = opaque(&rasterised(&drawing(vec![text]), 1.0));
        let dark = |of: std::ops::Range<usize>| {
            (0..1600).filter(|pixel| of.contains(&(pixel % 40)) && pixels[3 * pixel] < 128).count()
        };
        [dark(0..20), dark(20..40)]
    }

    #[test]
    fn a_text_stands_where_its_anchor_says() {
        let [left, right] = dark(Anchor::Start, "8 s");
        assert!(left == 0 && right > 10, "{left} {right}");
        let [left, right] = dark(Anchor::End, "8 s");
        assert!(right == 0 && left > 10, "{left} {right}");
        let [left, right] = dark(Anchor::Middle, "8888");
        assert!(left > 10 && left.abs_diff(right) <= 4, "{left} {right}");
    }

    #[test]
    fn a_letter_with_a_hole_keeps_it() {
        let zero = PictureItem::Text {
            at: [20.0, 36.0],
            anchor: Anchor::Middle,
            size: 40.0,
            colour: [0, 0, 0],
            halo: None,
            text: "0".to_owned(),
        };
        let drawing = drawing(vec![zero]);
        let row: Vec<bool> = (0..40).map(|x| at(&drawing, 1, x, 22)[0] < 128).collect();
        let changes = row.windows(2).filter(|two| two[0] != two[1]).count();
        assert_eq!(changes, 4, "light, dark, light in the hole, dark, light: {row:?}");
    }

    #[test]
    fn what_is_no_number_is_not_drawn() {
        let broken = drawing(vec![square(f64::NAN, 20.0, RED, 1.0), square(10.0, 1e300, RED, 1.0)]);
        rasterised(&broken, 1.0);
    }
}
