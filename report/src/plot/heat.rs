//! Draws numbers over the pixels of an image, such as how much each pixel matters to a driver that sees the image.
//!
//! The image is grey where the number is zero. Other pixels take colours of Okabe and Ito: orange if the number is
//! positive, blue if it is negative.

use super::DrawResult;
use super::{INK, ink};
use plotters::coord::Shift;
use plotters::prelude::*;

/// A chart of an image with a number for each pixel, shown by colour.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// The title of the image, which is the first line above the image.
    pub title: String,
    /// The note below the title of the image, in smaller letters.
    pub note: String,
    /// The width of the image in pixels.
    pub width: u32,
    /// The red, green and blue of each pixel, row by row from the top left.
    pub rgb: Vec<u8>,
    /// The number of each pixel, which determines the pixel's colour. If the list is empty, the image is shown in its
    /// own colours.
    pub values: Vec<f64>,
    /// The least absolute value of a pixel's number that gives the full colour.
    pub most: f64,
}

const MORE: [f64; 3] = [213.0, 94.0, 0.0];
const LESS: [f64; 3] = [0.0, 114.0, 178.0];

/// The size of text, and of a pixel of the image, in pixels of the SVG.
const TEXT: f64 = 15.0;
const CELL: u32 = 4;
/// The room above the image and on its other sides.
const HEADER: u32 = 50;
const MARGIN: u32 = 12;

impl HeatMap {
    /// Returns the width and height of the image with its margins, in pixels of the SVG.
    pub(super) fn size(&self) -> (u32, u32) {
        (self.width * CELL + 2 * MARGIN, self.rows() * CELL + HEADER + MARGIN)
    }

    fn rows(&self) -> u32 {
        (self.rgb.len() / 3) as u32 / self.width
    }

    /// Returns the colour in which a pixel is drawn.
    fn colour(&self, pixel: usize) -> RGBColor {
        let [red, green, blue] = [0, 1, 2].map(|channel| self.rgb[3 * pixel + channel]);
        let Some(value) = self.values.get(pixel) else { return RGBColor(red, green, blue) };
        // The grey is paler than the image, so that the colours stand out.
        let luma = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
        let grey = 110.0 + 0.57 * luma;
        let strength = (value.abs() / self.most).min(1.0);
        let full = if *value > 0.0 { MORE } else { LESS };
        let [red, green, blue] = full.map(|channel| (grey + strength * (channel - grey)).round() as u8);
        RGBColor(red, green, blue)
    }

    /// Draws the image over the whole area, every length in pixels times `scale`.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> DrawResult<B> {
        let px = |length: f64| (length * f64::from(scale)).round() as i32;
        let style = |size: f64| ink(size * f64::from(scale));
        let left = (MARGIN * scale) as i32;
        area.draw(&Text::new(self.title.clone(), (left, px(0.5 * TEXT)), style(TEXT)))?;
        area.draw(&Text::new(self.note.clone(), (left, px(1.8 * TEXT)), style(0.8 * TEXT)))?;
        let place =
            |column: u32, row: u32| (((MARGIN + column * CELL) * scale) as i32, ((HEADER + row * CELL) * scale) as i32);
        for row in 0..self.rows() {
            // Neighbouring pixels of one colour are drawn as one rectangle, so that the SVG stays small.
            let mut first = 0;
            while first < self.width {
                let colour = |column: u32| self.colour((row * self.width + column) as usize);
                let end = (first..self.width).find(|column| colour(*column) != colour(first)).unwrap_or(self.width);
                area.draw(&Rectangle::new([place(first, row), place(end, row + 1)], colour(first).filled()))?;
                first = end;
            }
        }
        let around = [place(0, 0), place(self.width, self.rows())];
        area.draw(&Rectangle::new(around, INK.stroke_width(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_takes_the_colour_of_its_numbers_sign_and_is_grey_without_any() {
        let heat = HeatMap {
            title: String::new(),
            note: String::new(),
            width: 4,
            rgb: [200, 10, 10].repeat(4),
            values: vec![0.0, 2.0, -2.0, 0.5],
            most: 1.0,
        };
        let [zero, more, less, half] = [0, 1, 2, 3].map(|pixel| heat.colour(pixel));
        assert!(zero.0 == zero.1 && zero.1 == zero.2, "{zero:?}");
        assert_eq!((more, less), (RGBColor(213, 94, 0), RGBColor(0, 114, 178)));
        assert!(zero.0 < half.0 && half.0 < more.0, "{half:?}");
        let image = HeatMap { values: vec![], ..heat };
        assert_eq!(image.colour(0), RGBColor(200, 10, 10));
    }
}
