//! Draws the letters of texts as outlines, placed to a fraction of a pixel.

use crate::birds_eye::{Anchor, Pixel};
use ab_glyph::{Font, FontRef, OutlineCurve, Point};
use tiny_skia::{Path, PathBuilder};

/// Returns the outlines of the letters of a text at its anchor, with `size` pixels to the em.
pub(super) fn letters(font: &FontRef, text: &str, [x, y]: Pixel, anchor: Anchor, size: f64) -> Option<Path> {
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
            // Usually each curve begins where the last one ended. If it does not, a new part of the letter begins.
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
