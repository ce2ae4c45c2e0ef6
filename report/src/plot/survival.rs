//! Draws Kaplan-Meier curves, which show the share of runs that still wait for an event, over the number of tests that
//! a run has spent. The axis of the number of tests begins at 0. A table below the curves gives the numbers of waiting
//! runs.
//!
//! The horizontal axis is linear, so that the area under a curve is the restricted mean that the legend shows.

use super::frame::{PlotFrame, TEXT};
use super::map::Ends;
use super::symbol::{LINE, Symbol, rgb};
use super::{GRID, HPos, INK, ink, level};
use paracosm_generators::Look;
use plotters::coord::Shift;
use plotters::prelude::*;

/// The width and the height of the plane, in pixels of the SVG.
pub(super) const PLANE: u32 = 640;
const HEIGHT: u32 = 440;

/// The room left and right of the horizontal axis, and the distance of the lines of the table.
const LEFT: f64 = 3.8 * TEXT;
const RIGHT: f64 = 1.4 * TEXT;
const ROW: f64 = 1.25 * TEXT;

/// Half the length of the tick that marks a censored curve, in pixels.
const TICK: f64 = 6.0;

/// The greatest number of steps of the axis.
const STEPS: usize = 6;

/// A chart of survival curves, which show the share of runs that still wait for an event, with a table.
#[derive(Debug, Clone)]
pub struct Survivals {
    /// The title, the note and the legend of the chart.
    pub frame: PlotFrame,
    /// The label of the horizontal axis, and the label of the vertical axis, which is written above the axis.
    pub axes: [String; 2],
    /// The heading of the table below the survival curves.
    pub numbers: String,
    /// The greatest value of the horizontal axis, which begins at 0.
    pub horizon: f64,
    /// The survival curves, in the order of the legend.
    pub curves: Vec<Waiting>,
}

/// The survival curve of a group of runs that wait for an event.
#[derive(Debug, Clone)]
pub struct Waiting {
    /// The shape of the mark and the colour of the curve.
    pub look: Look,
    /// The times at which the curve falls, in ascending order, each with the share of waiting runs from then on.
    pub steps: Vec<(f64, f64)>,
    /// The time at which the wait of each run ends; infinite if the wait does not end.
    pub ends: Vec<f64>,
    /// True if a run was stopped before its event occurred, although the event might have occurred later.
    pub censored: bool,
}

type Result<B> = std::result::Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

impl Survivals {
    /// Returns the height of the curves and the table together, in pixels of the SVG.
    pub(super) fn height(&self) -> u32 {
        HEIGHT + (ROW * (self.curves.len() as f64 + 1.6)) as u32
    }

    /// Draws the chart over the whole area, every length in pixels times `scale`.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<B> {
        let (body, legend) = self.frame.split(area, PLANE, scale)?;
        let px = |length: f64| (length * scale).round() as i32;
        let (plane, table) = body.split_vertically(px(f64::from(HEIGHT)));
        plane.draw(&Text::new(self.axes[1].clone(), (px(14.0), 0), ink(0.9 * TEXT * scale)))?;
        let axis = Ends((0.0, self.horizon));
        let ticks = axis.numbers(STEPS);
        let mut chart = ChartBuilder::on(&plane)
            .margin_top(px(1.9 * TEXT))
            .margin_right(px(RIGHT))
            .x_label_area_size(px(2.8 * TEXT))
            .y_label_area_size(px(LEFT))
            .build_cartesian_2d(axis, 0.0..1.0)?;
        chart
            .configure_mesh()
            .x_desc(&self.axes[0])
            .x_labels(STEPS)
            .y_labels(6)
            .y_label_formatter(&|share| format!("{share:.1}"))
            .axis_desc_style(ink(0.9 * TEXT * scale))
            .label_style(ink(0.8 * TEXT * scale))
            .axis_style(INK.stroke_width(px(1.0) as u32))
            .bold_line_style(GRID.stroke_width(px(1.0) as u32))
            .light_line_style(TRANSPARENT)
            .draw()?;
        let plane = chart.plotting_area();
        for curve in &self.curves {
            let stroke = rgb(curve.look).stroke_width(px(LINE) as u32);
            plane.draw(&PathElement::new(curve.corners(self.horizon), stroke))?;
            if curve.censored {
                let end = EmptyElement::at((self.horizon, curve.at(self.horizon)));
                plane.draw(&(end + PathElement::new([(0, -px(TICK)), (0, px(TICK))], stroke)))?;
            }
        }
        for (index, curve) in self.curves.iter().enumerate() {
            let height = 1.0 - (index as f64 + 0.5) / self.curves.len() as f64;
            plane.draw(&(EmptyElement::at(curve.mark(height, self.horizon)) + Symbol::of(curve.look, scale)))?;
        }
        self.draw_table(&table, &ticks, scale)?;
        self.frame.draw_legend(&legend, scale)
    }

    /// Draws the table of the number of runs in each curve that still wait at each tick of the axis.
    fn draw_table<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, ticks: &[f64], scale: f64) -> Result<B> {
        let px = |length: f64| (length * scale).round() as i32;
        let size = 0.8 * TEXT * scale;
        let line = |i: usize| px(ROW * (i as f64 + 0.6));
        area.draw(&Text::new(self.numbers.clone(), (px(14.0), line(0)), level(size, HPos::Left)))?;
        let width = f64::from(PLANE) - LEFT - RIGHT;
        for (i, curve) in self.curves.iter().enumerate() {
            let y = line(i + 1);
            area.draw(&(EmptyElement::at((px(0.45 * LEFT), y)) + Symbol::of(curve.look, scale)))?;
            for tick in ticks {
                let waiting = curve.ends.iter().filter(|end| *end > tick).count();
                let x = px(LEFT + width * tick / self.horizon);
                area.draw(&Text::new(waiting.to_string(), (x, y), level(size, HPos::Center)))?;
            }
        }
        Ok(())
    }
}

impl Waiting {
    /// Returns `true` if the curve looks the same as another curve.
    pub fn is_same(&self, other: &Self) -> bool {
        self.steps == other.steps && self.censored == other.censored
    }

    /// Returns the share of runs that still wait after a time.
    fn at(&self, time: f64) -> f64 {
        self.steps.iter().take_while(|step| step.0 <= time).last().map_or(1.0, |step| step.1)
    }

    /// Returns the corners of the survival curve. The curve ends where no run waits any more.
    fn corners(&self, horizon: f64) -> Vec<(f64, f64)> {
        let mut corners = vec![(0.0, 1.0)];
        for &(time, share) in self.steps.iter().take_while(|step| step.0 <= horizon) {
            corners.extend([(time, corners[corners.len() - 1].1), (time, share)]);
        }
        let last = corners[corners.len() - 1].1;
        if last > 0.0 {
            corners.push((horizon, last));
        }
        corners
    }

    /// Returns the position of the curve's mark, at which the curve falls to `height`. Every curve has a different
    /// height, so that marks of equal curves stand beside each other. If the curve stays above the height, the place is
    /// towards its end.
    fn mark(&self, height: f64, horizon: f64) -> (f64, f64) {
        let falls = self.steps.iter().find(|step| step.1 <= height && step.0 <= horizon);
        falls.map_or_else(
            || {
                let time = horizon * (1.0 - 0.5 * height);
                (time, self.at(time))
            },
            |step| (step.0, height),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_begins_with_all_and_ends_where_nobody_waits() {
        let look = Look { colour: (0, 0, 0), shape: paracosm_generators::MarkShape::Circle, filled: true };
        let waiting = |steps: &[(f64, f64)]| Waiting { look, steps: steps.to_vec(), ends: vec![], censored: false };
        let all = waiting(&[(1.0, 0.5), (4.0, 0.0)]);
        assert_eq!(all.corners(10.0), [(0.0, 1.0), (1.0, 1.0), (1.0, 0.5), (4.0, 0.5), (4.0, 0.0)]);
        assert_eq!(waiting(&[(1.0, 0.5)]).corners(10.0), [(0.0, 1.0), (1.0, 1.0), (1.0, 0.5), (10.0, 0.5)]);
        assert_eq!((all.mark(0.75, 10.0), all.mark(0.25, 10.0)), ((1.0, 0.75), (4.0, 0.25)));
        assert_eq!(waiting(&[]).mark(0.5, 10.0), (7.5, 1.0));
    }
}
