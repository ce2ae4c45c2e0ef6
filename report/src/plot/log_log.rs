//! Draws values over sizes with two logarithmic axes, so that a power law is a straight line.
//!
//! At every size, each curve has a mark with a whisker from quartile to quartile. Marks of one size stand beside each
//! other, so that whiskers do not cover each other. Curves are told apart by the colours of Okabe and Ito (Color
//! Universal Design, 2008), which differ for any colour vision, and without colour by the shapes of their marks.

use super::frame::{PlotFrame, TEXT};
use super::log_axis::Log;
use super::symbol::{LINE, Symbol, rgb};
use super::{GRID, INK, ink};
use paracosm_generators::Look;
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::prelude::*;

/// The width of a plane, in pixels of the SVG.
pub(super) const PLANE: u32 = 500;

/// A chart of curves in plotting areas side by side, all with logarithmic axes, and one legend.
#[derive(Debug, Clone)]
pub struct LogLog {
    /// The title, the note and the legend of the chart.
    pub frame: PlotFrame,
    /// The plotting areas from left to right; at least one area.
    pub planes: Vec<Plane>,
}

/// A plotting area with two logarithmic axes and several curves.
#[derive(Debug, Clone)]
pub struct Plane {
    /// The label of the horizontal axis.
    pub x: String,
    /// The label of the vertical axis, which is written above the axis.
    pub y: String,
    /// The value on the vertical axis at which a horizontal line is drawn, if any.
    pub level: Option<f64>,
    /// The curves in the plotting area. Later curves are drawn over earlier curves.
    pub curves: Vec<LogLogCurve>,
}

/// A curve of values above 0, with the spread of each value.
#[derive(Debug, Clone)]
pub struct LogLogCurve {
    /// The shape of the marks and the colour of the curve.
    pub look: Look,
    /// The horizontal position, the value and the two ends of the whisker of each mark.
    pub marks: Vec<(f64, f64, [f64; 2])>,
    /// The horizontal position and the value of each cross. No line joins the crosses.
    pub crosses: Vec<(f64, f64)>,
}

type Result<B> = std::result::Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// The distance between neighbouring marks of one size, as a share of the horizontal axis.
const APART: f64 = 0.0075;
impl LogLog {
    /// Draws the chart over the whole area, every length in pixels times `scale`.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<B> {
        let (planes, legend) = self.frame.split(area, PLANE * self.planes.len() as u32, scale)?;
        for (plane, part) in self.planes.iter().zip(planes.split_evenly((1, self.planes.len()))) {
            plane.draw(&part, scale)?;
        }
        self.frame.draw_legend(&legend, scale)
    }
}

impl Plane {
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<B> {
        let px = |length: f64| (length * scale).round() as u32;
        let (x, y) = self.axes();
        area.draw(&Text::new(self.y.clone(), (px(14.0) as i32, 0), ink(0.9 * TEXT * scale)))?;
        let mut chart = ChartBuilder::on(area)
            .margin_top(px(1.9 * TEXT))
            .margin_right(px(1.4 * TEXT))
            .margin_bottom(px(0.6 * TEXT))
            .x_label_area_size(px(2.8 * TEXT))
            .y_label_area_size(px(3.8 * TEXT))
            .build_cartesian_2d(x.clone(), y.clone())?;
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .axis_desc_style(ink(0.9 * TEXT * scale))
            .label_style(ink(0.8 * TEXT * scale))
            .axis_style(INK.stroke_width(px(1.0)))
            .bold_line_style(GRID.stroke_width(px(1.0)))
            .light_line_style(TRANSPARENT)
            .draw()?;
        let plane = chart.plotting_area();
        if let Some(level) = self.level {
            plane.draw(&PathElement::new([(x.lo, level), (x.hi, level)], INK.stroke_width(px(1.2))))?;
        }
        let many = self.curves.len();
        let step = APART.min(0.5 * x.least_gap() / many as f64);
        let beside = |i: usize, size: f64| x.moved(size, (i as f64 - (many as f64 - 1.0) / 2.0) * step);
        // Lines come first, then whiskers, then marks, so that the most important things are never covered.
        for (i, curve) in self.curves.iter().enumerate() {
            let line = curve.marks.iter().map(|(size, value, _)| (beside(i, *size), *value));
            plane.draw(&PathElement::new(line.collect::<Vec<_>>(), rgb(curve.look).stroke_width(px(LINE))))?;
        }
        for (i, curve) in self.curves.iter().enumerate() {
            for (size, _, [low, high]) in &curve.marks {
                let at = beside(i, *size);
                let whisker = rgb(curve.look).stroke_width(px(LINE));
                plane.draw(&PathElement::new([(at, *low), (at, *high)], whisker))?;
            }
        }
        self.draw_marks(plane, beside, scale)
    }

    fn draw_marks<B: DrawingBackend>(
        &self,
        plane: &DrawingArea<B, Cartesian2d<Log, Log>>,
        beside: impl Fn(usize, f64) -> f64,
        scale: f64,
    ) -> Result<B> {
        for (i, curve) in self.curves.iter().enumerate() {
            for (size, value, _) in &curve.marks {
                plane.draw(&(EmptyElement::at((beside(i, *size), *value)) + Symbol::of(curve.look, scale)))?;
            }
            for (size, value) in &curve.crosses {
                let cross = Symbol::cross(rgb(curve.look), scale);
                plane.draw(&(EmptyElement::at((beside(i, *size), *value)) + cross))?;
            }
        }
        Ok(())
    }

    /// Returns the two axes of the plane, with room around the curves.
    fn axes(&self) -> (Log, Log) {
        let marks = || self.curves.iter().flat_map(|curve| &curve.marks);
        let crosses = || self.curves.iter().flat_map(|curve| &curve.crosses);
        let mut sizes: Vec<f64> = marks().map(|mark| mark.0).collect();
        sizes.sort_by(f64::total_cmp);
        sizes.dedup();
        let values = marks().flat_map(|(_, value, [low, high])| [*value, *low, *high]);
        let values = values.chain(crosses().map(|cross| cross.1)).chain(self.level);
        let (least, most) = values.fold((f64::INFINITY, 0.0_f64), |(lo, hi), value| (lo.min(value), hi.max(value)));
        (Log::over(&sizes, 0.1), Log::from_to(least, most, 0.05))
    }
}
