//! Draws shares over sizes as clouds of marks: the horizontal axis is logarithmic, the vertical axis goes from 0 to 1.

use super::frame::{PlotFrame, TEXT};
use super::log_axis::Log;
use super::symbol::Symbol;
use super::{GRID, INK, ink};
use paracosm_generators::Look;
use plotters::coord::Shift;
use plotters::prelude::*;

/// The width of the plane, in pixels of the SVG.
pub(super) const PLANE: u32 = 640;

/// A chart of shares from 0 to 1 over sizes, such as recall over dispersion.
#[derive(Debug, Clone)]
pub struct Shares {
    /// The title, the note and the legend of the chart.
    pub frame: PlotFrame,
    /// The label of the horizontal axis, which shows the sizes.
    pub x: String,
    /// The label of the vertical axis, which shows the shares; the label is written above the axis.
    pub y: String,
    /// The least and the greatest size on the horizontal axis, both above 0.
    pub range: (f64, f64),
    /// The series of marks in the chart. Later series are drawn over earlier series.
    pub series: Vec<Series>,
}

/// A series of marks in a chart of shares, with its line in the legend.
#[derive(Debug, Clone)]
pub struct Series {
    /// The shape and the colour of the marks.
    pub look: Look,
    /// The size and the share at which each mark is drawn.
    pub marks: Vec<(f64, f64)>,
}

type Result<B> = std::result::Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

impl Shares {
    /// Draws the chart over the whole area, every length in pixels times `scale`.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<B> {
        let (plane, legend) = self.frame.split(area, PLANE, scale)?;
        let px = |length: f64| (length * scale).round() as u32;
        plane.draw(&Text::new(self.y.clone(), (px(14.0) as i32, 0), ink(0.9 * TEXT * scale)))?;
        let mut chart = ChartBuilder::on(&plane)
            .margin_top(px(1.9 * TEXT))
            .margin_right(px(1.4 * TEXT))
            .margin_bottom(px(0.6 * TEXT))
            .x_label_area_size(px(2.8 * TEXT))
            .y_label_area_size(px(3.8 * TEXT))
            .build_cartesian_2d(Log::from_to(self.range.0, self.range.1, 0.03), -0.02..1.02)?;
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_labels(6)
            .y_label_formatter(&|share| format!("{share:.1}"))
            .axis_desc_style(ink(0.9 * TEXT * scale))
            .label_style(ink(0.8 * TEXT * scale))
            .axis_style(INK.stroke_width(px(1.0)))
            .bold_line_style(GRID.stroke_width(px(1.0)))
            .light_line_style(TRANSPARENT)
            .draw()?;
        let plane = chart.plotting_area();
        for series in &self.series {
            for &mark in &series.marks {
                plane.draw(&(EmptyElement::at(mark) + Symbol::of(series.look, scale)))?;
            }
        }
        self.frame.draw_legend(&legend, scale)
    }
}
