//! Colours the dots of a map by a number of each test, and draws a bar that shows which colour stands for which number.

use super::DrawResult;
use super::bar::Bar;
use plotters::coord::Shift;
use plotters::coord::ranged1d::Ranged;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// The numbers of the tests on a failure map, which give the tests' dots their colours.
#[derive(Debug, Clone, PartialEq)]
pub struct Tints {
    /// The name of the quantity that the numbers measure, with its unit.
    pub label: String,
    /// The numbers that have the palest and the darkest colour. A number beyond the range has the colour of that end.
    pub range: (f64, f64),
    /// The numbers of the tests, in the order of the map's marks.
    pub values: Vec<f64>,
}

// The colours go from pale to dark through several hues, so that they are ordered in grey, too. They are some of the
// colours of ColorBrewer's YlGnBu (Brewer).
const COLOURS: [[f64; 3]; 5] =
    [[255.0, 255.0, 204.0], [161.0, 218.0, 180.0], [65.0, 182.0, 196.0], [44.0, 127.0, 184.0], [37.0, 52.0, 148.0]];

/// The number of colours that the bar shows.
const STEPS: usize = 40;

impl Tints {
    /// Returns the red, green and blue of a number in a range. A number beyond the range has the colour of that end.
    pub fn shade(value: f64, range: (f64, f64)) -> [u8; 3] {
        let share = ((value - range.0) / (range.1 - range.0)).clamp(0.0, 1.0);
        let place = share * (COLOURS.len() - 1) as f64;
        let below = (place as usize).min(COLOURS.len() - 2);
        let between = place - below as f64;
        [0, 1, 2].map(|i| (COLOURS[below][i] + between * (COLOURS[below + 1][i] - COLOURS[below][i])).round() as u8)
    }

    /// Returns the colour of a number.
    pub(super) fn colour(&self, value: f64) -> RGBColor {
        let [red, green, blue] = Self::shade(value, self.range);
        RGBColor(red, green, blue)
    }

    /// Draws the bar along the left side of an area, from `top` to `bottom`, with round numbers beside it.
    pub(super) fn draw_bar<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        along: (i32, i32),
        text: f64,
    ) -> DrawResult<B> {
        let (low, high) = self.range;
        let numbers = RangedCoordf64::from(low..high).key_points(6);
        let ticks = numbers.into_iter().map(|number| ((number - low) / (high - low), number.to_string())).collect();
        let colour = |share: f64| self.colour(low + share * (high - low));
        Bar { label: &self.label, steps: STEPS, ticks }.draw(area, along, colour, text)
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
