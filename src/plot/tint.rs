//! A number of each test as the tint of its dot on a map, and a bar that says which tint means what.

use super::map::Result;
use super::{FAMILY, INK};
use plotters::coord::Shift;
use plotters::prelude::*;

/// A number of every test of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Tints {
    /// Its name with its unit.
    pub label: String,
    /// From the palest to the darkest; what lies beyond is as an end.
    pub range: (f64, f64),
    /// In the order of the map's marks.
    pub values: Vec<f64>,
}

// From pale to dark in one hue after another, and so in grey, too: some of the colours of ColorBrewer's YlGnBu (Brewer).
const COLOURS: [[f64; 3]; 5] =
    [[255.0, 255.0, 204.0], [161.0, 218.0, 180.0], [65.0, 182.0, 196.0], [44.0, 127.0, 184.0], [37.0, 52.0, 148.0]];

/// So many tints does the bar show.
const STEPS: usize = 40;

impl Tints {
    /// The colour of a number.
    pub(super) fn colour(&self, value: f64) -> RGBColor {
        let share = ((value - self.range.0) / (self.range.1 - self.range.0)).clamp(0.0, 1.0);
        let place = share * (COLOURS.len() - 1) as f64;
        let below = (place as usize).min(COLOURS.len() - 2);
        let between = place - below as f64;
        let channel = |i: usize| COLOURS[below][i] + between * (COLOURS[below + 1][i] - COLOURS[below][i]);
        RGBColor(channel(0).round() as u8, channel(1).round() as u8, channel(2).round() as u8)
    }

    /// Draws the bar along the left side of an area, from `top` to `bottom`, with its label to the right.
    pub(super) fn draw_bar<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        (top, bottom): (i32, i32),
        text: f64,
    ) -> Result<B> {
        let width = text.round() as i32;
        let y = |share: f64| bottom - (share * f64::from(bottom - top)).round() as i32;
        let value = |share: f64| self.range.0 + share * (self.range.1 - self.range.0);
        for step in 0..STEPS {
            let (low, high) = (step as f64 / STEPS as f64, (step + 1) as f64 / STEPS as f64);
            let colour = self.colour(value(0.5 * (low + high)));
            area.draw(&Rectangle::new([(0, y(high)), (width, y(low))], colour.filled()))?;
        }
        area.draw(&Rectangle::new([(0, top), (width, bottom)], INK.stroke_width(1)))?;
        let style = TextStyle::from((FAMILY, 0.85 * text).into_font()).color(&INK);
        for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let number = format!("{:.0}", value(share));
            let (_, height) = area.estimate_text_size(&number, &style)?;
            let right = width + width / 2;
            area.draw(&PathElement::new([(width, y(share)), (width + width / 3, y(share))], INK.stroke_width(1)))?;
            area.draw(&Text::new(number, (right, y(share) - (0.42 * f64::from(height)) as i32), style.clone()))?;
        }
        let style = style.transform(FontTransform::Rotate90);
        let (length, _) = area.estimate_text_size(&self.label, &style)?;
        area.draw(&Text::new(self.label.clone(), ((3.7 * text) as i32, (top + bottom - length as i32) / 2), style))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_larger_number_has_a_darker_tint() {
        let tints = Tints { label: String::new(), range: (0.0, 200.0), values: vec![] };
        let brightness = |value: f64| {
            let RGBColor(red, green, blue) = tints.colour(value);
            u32::from(red) + u32::from(green) + u32::from(blue)
        };
        let steps: Vec<u32> = (0..=20).map(|i| brightness(10.0 * f64::from(i))).collect();
        assert!(steps.windows(2).all(|pair| pair[0] > pair[1]), "{steps:?}");
        assert_eq!((brightness(-5.0), brightness(500.0)), (steps[0], steps[20]));
    }
}
