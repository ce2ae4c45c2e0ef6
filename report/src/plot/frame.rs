//! Draws what surrounds the planes of a chart: two lines of text above them, and a legend beside them.

use super::symbol::{LINE, Symbol, rgb};
use super::{HPos, INK, ink, level};
use paracosm_generators::Look;
use plotters::coord::Shift;
use plotters::prelude::*;

/// The width of the legend, in pixels of the SVG.
pub(super) const LEGEND: u32 = 230;
/// The height of the text above the planes, in pixels of the SVG.
pub(super) const HEADER: u32 = 67;
/// The size of text, in pixels of the SVG.
pub(super) const TEXT: f64 = 16.0;

/// The title, the note and the legend of a chart.
#[derive(Debug, Clone)]
pub struct PlotFrame {
    /// The title of the chart, which is the first line.
    pub title: String,
    /// The note below the title of the chart, in smaller letters.
    pub note: String,
    /// The headings of the two columns of the chart's legend.
    pub legend: [String; 2],
    /// The lines of the legend, from top to bottom.
    pub entries: Vec<Entry>,
    /// The text in the legend that explains the crosses; `None` if the chart has no crosses.
    pub cross: Option<String>,
}

/// A line of the legend of a chart.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The shape of the mark and the colour of the curve.
    pub look: Look,
    /// The name of the curve.
    pub name: String,
    /// The text of the number beside the name of the curve.
    pub number: String,
}

type Areas<B> = (DrawingArea<B, Shift>, DrawingArea<B, Shift>);
type Result<T, B> = std::result::Result<T, DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// The height of a chart whose legend is short, in pixels of the SVG.
const HEIGHT: u32 = 520;

/// Returns the height of the middle of a line of the legend, in pixels of the SVG.
fn line(number: usize) -> f64 {
    TEXT * (1.2 + 1.55 * number as f64)
}

impl PlotFrame {
    /// Returns the height of the whole chart, in pixels of the SVG, with room for all lines of the legend.
    pub(super) fn height(&self) -> u32 {
        let last = self.entries.len() + if self.cross.is_some() { 2 } else { 0 };
        HEIGHT.max(HEADER + line(last + 1) as u32)
    }

    /// Draws the lines above the planes. Returns the area of the planes, `width` pixels wide, and the area of the
    /// legend.
    pub(super) fn split<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        width: u32,
        scale: f64,
    ) -> Result<Areas<B>, B> {
        let px = |length: f64| (length * scale).round() as i32;
        let (header, body) = area.split_vertically(px(f64::from(HEADER)));
        header.draw(&Text::new(self.title.clone(), (px(14.0), px(0.5 * TEXT)), ink(1.15 * TEXT * scale)))?;
        header.draw(&Text::new(self.note.clone(), (px(14.0), px(2.0 * TEXT)), ink(0.85 * TEXT * scale)))?;
        Ok(body.split_horizontally(px(f64::from(width))))
    }

    /// Draws the legend.
    pub(super) fn draw_legend<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<(), B> {
        let px = |length: f64| (length * scale).round() as i32;
        let size = 0.85 * TEXT * scale;
        let (name_at, number_at) = (px(36.0), px(f64::from(LEGEND) - 18.0));
        let write = |name: &str, number: &str, y: i32| {
            area.draw(&Text::new(name.to_owned(), (name_at, y), level(size, HPos::Left)))?;
            area.draw(&Text::new(number.to_owned(), (number_at, y), level(size, HPos::Right)))
        };
        write(&self.legend[0], &self.legend[1], px(line(0)))?;
        for (i, entry) in self.entries.iter().enumerate() {
            let y = px(line(i + 1));
            let stroke = rgb(entry.look).stroke_width(px(LINE) as u32);
            area.draw(&PathElement::new([(px(4.0), y), (px(28.0), y)], stroke))?;
            area.draw(&(EmptyElement::at((px(16.0), y)) + Symbol::of(entry.look, scale)))?;
            write(&entry.name, &entry.number, y)?;
        }
        if let Some(cross) = &self.cross {
            let y = px(line(self.entries.len() + 2));
            area.draw(&(EmptyElement::at((px(16.0), y)) + Symbol::cross(INK, scale)))?;
            write(cross, "", y)?;
        }
        Ok(())
    }
}
