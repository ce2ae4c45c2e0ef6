//! Draws a slice of a hole: a box over two parameters, and the tests around it.

use super::map::{Axis, Ends};
use super::mark::{BLUE, GREY, RED};
use super::{DrawResult, GRID, INK, ink};
use plotters::coord::Shift;
use plotters::prelude::*;

/// A chart of a box over two linear axes, with tests around it.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// The label and the range of the horizontal axis.
    pub x: Axis,
    /// The label and the range of the vertical axis.
    pub y: Axis,
    /// The ends of the box along both axes.
    pub sides: [[f64; 2]; 2],
    /// The tests that could lie in the box: along all other axes they do.
    pub between: Vec<[f64; 2]>,
    /// Tests that lie beside the box along another axis.
    pub others: Vec<[f64; 2]>,
    /// A test that fails in the box; `None` if the chart shows none.
    pub fails: Option<[f64; 2]>,
}

/// Slices of one hole, with a text above them.
#[derive(Debug, Clone, PartialEq)]
pub struct Slices {
    /// The title, which is the first line.
    pub title: String,
    /// The note below the title, in smaller letters.
    pub note: String,
    /// The slices.
    pub panels: Vec<Slice>,
}

/// The number of slices beside each other.
const COLUMNS: usize = 3;
/// The width and the height of a slice, in pixels of the SVG.
const SIZE: (u32, u32) = (420, 360);
/// The least width of a picture, in pixels of the SVG, so that the text has room.
const LEAST: u32 = 640;
/// The height of the text above the slices, in pixels of the SVG.
const HEADER: u32 = 58;
/// The size of text in pixels of the SVG.
const TEXT: f64 = 14.0;
/// The colour of the box.
const HOLE: RGBColor = RGBColor(0xff, 0xe3, 0xb3);

impl Slices {
    fn columns(&self) -> usize {
        COLUMNS.min(self.panels.len())
    }

    /// Returns the width and the height of the picture, in pixels of the SVG.
    pub(super) fn size(&self) -> (u32, u32) {
        let rows = self.panels.len().div_ceil(self.columns()) as u32;
        ((SIZE.0 * self.columns() as u32).max(LEAST), SIZE.1 * rows + HEADER)
    }

    /// Draws the slices over the whole area, every length in pixels times `scale`.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> DrawResult<B> {
        let px = |length: f64| (length * scale).round() as i32;
        let (header, body) = area.split_vertically(px(f64::from(HEADER)));
        header.draw(&Text::new(self.title.clone(), (px(14.0), px(0.7 * TEXT)), ink(1.15 * TEXT * scale)))?;
        header.draw(&Text::new(self.note.clone(), (px(14.0), px(2.4 * TEXT)), ink(0.9 * TEXT * scale)))?;
        let rows = self.panels.len().div_ceil(self.columns());
        let parts = body.split_evenly((rows, self.columns()));
        self.panels.iter().zip(parts).try_for_each(|(panel, part)| panel.draw(&part, scale))
    }
}

impl Slice {
    /// Draws the chart over the whole area, every length in pixels times `scale`.
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> DrawResult<B> {
        let px = |length: f64| (length * scale).round() as u32;
        let mut chart = ChartBuilder::on(area)
            .margin_top(px(0.8 * TEXT))
            .margin_right(px(1.4 * TEXT))
            .margin_left(px(0.4 * TEXT))
            .margin_bottom(px(0.4 * TEXT))
            .x_label_area_size(px(2.8 * TEXT))
            .y_label_area_size(px(3.8 * TEXT))
            .build_cartesian_2d(Ends(self.x.range), Ends(self.y.range))?;
        let [[left, right], [bottom, top]] = self.sides;
        let corners = [(left, bottom), (right, top)];
        chart.draw_series([Rectangle::new(corners, HOLE.filled())])?;
        chart
            .configure_mesh()
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .axis_desc_style(ink(TEXT * scale))
            .label_style(ink(0.8 * TEXT * scale))
            .axis_style(INK.stroke_width(px(1.0)))
            .bold_line_style(GRID.stroke_width(px(1.0)))
            .light_line_style(TRANSPARENT)
            .x_labels(6)
            .y_labels(6)
            .draw()?;
        let dots = |tests: &[[f64; 2]], radius: f64, colour: RGBColor| {
            let dot = |&[x, y]: &[f64; 2]| Circle::new((x, y), px(radius), colour.filled());
            tests.iter().map(dot).collect::<Vec<_>>()
        };
        chart.draw_series(dots(&self.others, 1.6, GREY))?;
        chart.draw_series([Rectangle::new(corners, INK.stroke_width(px(1.5)))])?;
        chart.draw_series(dots(&self.between, 3.2, BLUE))?;
        let cross = |&[x, y]: &[f64; 2]| Cross::new((x, y), px(6.0), RED.stroke_width(px(3.0)));
        chart.draw_series(self.fails.iter().map(cross))?;
        Ok(())
    }
}
