//! Draws the bar beside a map that shows which colour stands for which number.

use super::DrawResult;
use super::{HPos, INK, Pos, VPos, ink, level};
use plotters::coord::Shift;
use plotters::prelude::*;

/// The bar's label, steps and numbers.
pub(super) struct Bar<'a> {
    pub label: &'a str,
    /// The number of coloured rectangles that form the bar.
    pub steps: usize,
    /// The labels along the bar, each with its position from 0 at the bottom to 1 at the top.
    pub ticks: Vec<(f64, String)>,
}

impl Bar<'_> {
    /// Draws the bar along the left side of an area, from `top` to `bottom`, with its label to the right.
    pub fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        (top, bottom): (i32, i32),
        colour: impl Fn(f64) -> RGBColor,
        text: f64,
    ) -> DrawResult<B> {
        let width = text.round() as i32;
        let y = |share: f64| bottom - (share * f64::from(bottom - top)).round() as i32;
        for step in 0..self.steps {
            let [low, middle, high] = [0.0, 0.5, 1.0].map(|part| (step as f64 + part) / self.steps as f64);
            area.draw(&Rectangle::new([(0, y(high)), (width, y(low))], colour(middle).filled()))?;
        }
        area.draw(&Rectangle::new([(0, top), (width, bottom)], INK.stroke_width(1)))?;
        for (share, number) in &self.ticks {
            let y = y(*share);
            area.draw(&PathElement::new([(width, y), (width + width / 3, y)], INK.stroke_width(1)))?;
            area.draw(&Text::new(number.clone(), (width + width / 2, y), level(0.85 * text, HPos::Left)))?;
        }
        let along = ink(0.85 * text).transform(FontTransform::Rotate90).pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(self.label.to_owned(), ((4.4 * text) as i32, (top + bottom) / 2), along))
    }
}
