//! Draws curves over an axis, such as speeds over time. Curves are told apart by the colours of Okabe and Ito, as in
//! other charts, and without colour by the names above the chart.

use super::DrawResult;
use super::map::{Axis, Ends};
use super::{GRID, HPos, INK, ink, level};
use plotters::coord::Shift;
use plotters::prelude::*;

/// A chart of curves over two linear axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Lines {
    /// The title of the chart, which is the first line.
    pub title: String,
    /// The note below the title of the chart, in smaller letters.
    pub note: String,
    /// The label and the range of the horizontal axis.
    pub x: Axis,
    /// The label and the range of the vertical axis.
    pub y: Axis,
    /// The curves with their names and points; at most six curves. A value that is not finite leaves a gap in its
    /// curve.
    pub curves: Vec<(String, Vec<(f64, f64)>)>,
}

const COLOURS: [RGBColor; 6] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0xe6, 0x9f, 0x00),
];

/// The size of text in pixels of the SVG.
const TEXT: f64 = 15.0;

impl Lines {
    /// Draws the chart over the whole area, every length in pixels times `scale`.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> DrawResult<B> {
        let px = |length: f64| (length * scale).round() as u32;
        let (header, body) = area.split_vertically(px(5.6 * TEXT));
        let left = px(0.8 * TEXT) as i32;
        header.draw(&Text::new(self.title.clone(), (left, px(0.5 * TEXT) as i32), ink(1.15 * TEXT * scale)))?;
        header.draw(&Text::new(self.note.clone(), (left, px(2.0 * TEXT) as i32), ink(0.85 * TEXT * scale)))?;
        self.draw_names(&header, px(4.4 * TEXT) as i32, scale)?;
        let mut chart = ChartBuilder::on(&body)
            .margin_right(px(1.6 * TEXT))
            .margin_left(px(0.5 * TEXT))
            .margin_bottom(px(0.5 * TEXT))
            .x_label_area_size(px(2.8 * TEXT))
            .y_label_area_size(px(3.8 * TEXT))
            .build_cartesian_2d(Ends(self.x.range), Ends(self.y.range))?;
        chart
            .configure_mesh()
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .axis_desc_style(ink(TEXT * scale))
            .label_style(ink(0.85 * TEXT * scale))
            .axis_style(INK.stroke_width(px(1.0)))
            .bold_line_style(GRID.stroke_width(px(1.0)))
            .light_line_style(TRANSPARENT)
            .x_labels(10)
            .y_labels(8)
            .draw()?;
        for ((_, points), colour) in self.curves.iter().zip(COLOURS) {
            let known = points.split(|point| !point.1.is_finite()).filter(|run| !run.is_empty());
            let paths = known.map(|run| PathElement::new(run.to_vec(), colour.stroke_width(px(2.0))));
            chart.draw_series(paths)?;
        }
        Ok(())
    }

    fn draw_names<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, y: i32, scale: f64) -> DrawResult<B> {
        let style = level(0.9 * TEXT * scale, HPos::Left);
        let px = |length: f64| (length * scale).round() as i32;
        let mut x = px(TEXT);
        for ((name, _), colour) in self.curves.iter().zip(COLOURS) {
            area.draw(&PathElement::new([(x, y), (x + px(24.0), y)], colour.stroke_width(px(2.0) as u32)))?;
            x += px(30.0);
            let (width, _) = area.estimate_text_size(name, &style)?;
            area.draw(&Text::new(name.clone(), (x, y), style.clone()))?;
            x += width as i32 + px(1.6 * TEXT);
        }
        Ok(())
    }
}
