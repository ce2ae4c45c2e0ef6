//! Draws the probability of failure behind the marks of a failure map: shades, a line at one half, hatching where it is
//! undecided on which side of one half the probability is, grey where tests cannot be built, and the legend of these.

use super::DrawResult;
use super::bar::Bar;
use super::contour::contour;
use super::{HPos, INK, level};
use paracosm_analysis::failure_estimate::{FailureEstimate, decided};
use paracosm_generators::FailingShare;
use plotters::coord::Shift;
use plotters::prelude::*;

/// The number of different shades. Neighbouring cells of one shade are drawn as one rectangle.
const SHADES: usize = 20;

/// The colours of places where all tests pass and where all tests fail, with white between them. They are pale ends of
/// Paul Tol's sunset scheme, so that marks stand out.
const PASSING: [f64; 3] = [171.0, 206.0, 230.0];
const FAILING: [f64; 3] = [250.0, 178.0, 140.0];

const HATCH: RGBColor = RGBColor(0xa8, 0xa8, 0xa8);

/// The colour of places where most tests cannot be built.
const INVALID: RGBColor = RGBColor(0xd4, 0xd4, 0xd4);

/// Returns the colour that represents a probability.
fn colour(probability: f64) -> RGBColor {
    let shade = ((probability * SHADES as f64) as usize).min(SHADES - 1);
    let off = (shade as f64 + 0.5) / SHADES as f64 * 2.0 - 1.0;
    let end = if off < 0.0 { PASSING } else { FAILING };
    let channel = |i: usize| (255.0 + (end[i] - 255.0) * off.abs()).round() as u8;
    RGBColor(channel(0), channel(1), channel(2))
}

/// A grid of cells with a node at each of their corners, in the pixels of an area.
struct Cells<'a> {
    estimate: &'a FailureEstimate,
    size: (f64, f64),
}

impl<'a> Cells<'a> {
    fn over<B: DrawingBackend>(area: &DrawingArea<B, Shift>, estimate: &'a FailureEstimate) -> Self {
        let (width, height) = area.dim_in_pixel();
        Self { estimate, size: (f64::from(width - 1), f64::from(height - 1)) }
    }

    fn columns(&self) -> usize {
        self.estimate.x.len() - 1
    }

    fn rows(&self) -> usize {
        self.estimate.y.len() - 1
    }

    /// Returns the pixel of a position on the grid, whose first row is at the bottom.
    fn pixel(&self, (i, j): (f64, f64)) -> (i32, i32) {
        let x = i / self.columns() as f64 * self.size.0;
        let y = (1.0 - j / self.rows() as f64) * self.size.1;
        (x.round() as i32, y.round() as i32)
    }

    /// Returns the estimates at the corners of a grid cell; `None` if at most one corner is valid.
    fn corners(&self, i: usize, j: usize) -> Option<Vec<&FailingShare>> {
        let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
        let known: Vec<_> = corners.iter().filter_map(|&(i, j)| self.estimate.at(i, j)).collect();
        (known.len() > 1).then_some(known)
    }

    /// Returns the colour of the mean probability at the corners of a grid cell.
    fn colour(&self, i: usize, j: usize) -> RGBColor {
        let mean = |known: Vec<&FailingShare>| known.iter().map(|share| share.mean).sum::<f64>() / known.len() as f64;
        self.corners(i, j).map_or(INVALID, |known| colour(mean(known)))
    }

    /// Returns `true` if the estimate at a corner of a grid cell is not decided.
    fn is_open(&self, i: usize, j: usize) -> bool {
        self.corners(i, j).is_some_and(|known| known.iter().any(|share| decided(share).is_none()))
    }
}

/// Draws the shades of an estimate over a whole area, whose sides are the axes.
pub(super) fn draw_shades<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    estimate: &FailureEstimate,
) -> DrawResult<B> {
    let cells = Cells::over(area, estimate);
    let at = |i: usize, j: usize| cells.pixel((i as f64, j as f64));
    for j in 0..cells.rows() {
        for (i, end, shade) in runs(cells.columns(), |i| Some(cells.colour(i, j))) {
            area.draw(&Rectangle::new([at(i, j + 1), at(end, j)], shade.filled()))?;
        }
    }
    Ok(())
}

/// Draws the line at one half and the hatching over the same area; lengths are multiplied by `scale`.
pub(super) fn draw_lines<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    estimate: &FailureEstimate,
    scale: f64,
) -> DrawResult<B> {
    let cells = Cells::over(area, estimate);
    let at = |i: usize, j: usize| cells.pixel((i as f64, j as f64));
    // The hatching runs along the diagonals; on a fine grid only some diagonals are drawn. A run of undecided cells is
    // one stroke.
    let every = cells.columns().div_ceil(30);
    for diagonal in (1 - cells.rows() as isize..cells.columns() as isize).step_by(every) {
        let begin = (-diagonal).max(0) as usize;
        let column = |step: usize| (begin + step).wrapping_add_signed(diagonal);
        let steps = (cells.rows() - begin).min(cells.columns() - column(0));
        let open = |step: usize| cells.is_open(column(step), begin + step).then_some(());
        for (first, end, ()) in runs(steps, open) {
            let ends = [at(column(first), begin + first), at(column(end), begin + end)];
            area.draw(&PathElement::new(ends, HATCH.stroke_width(scale.round() as u32)))?;
        }
    }
    let probability = |i, j| estimate.at(i, j).map_or(f64::NAN, |share| share.mean);
    for line in contour(estimate.x.len(), estimate.y.len(), 0.5, probability) {
        let pixels: Vec<(i32, i32)> = line.into_iter().map(|place| cells.pixel(place)).collect();
        area.draw(&PathElement::new(pixels, INK.stroke_width((2.0 * scale).round() as u32)))?;
    }
    Ok(())
}

/// Returns the runs of equal values, each with its first index and the index after its last. Places without a value
/// belong to no run.
fn runs<T: PartialEq>(len: usize, value: impl Fn(usize) -> Option<T>) -> Vec<(usize, usize, T)> {
    let mut runs: Vec<(usize, usize, T)> = Vec::new();
    for at in 0..len {
        match (runs.last_mut(), value(at)) {
            (Some((_, end, last)), Some(value)) if *end == at && *last == value => *end = at + 1,
            (_, Some(value)) => runs.push((at, at + 1, value)),
            (_, None) => {}
        }
    }
    runs
}

/// Draws the bar of shades along the left side of an area, from `top` to `bottom`.
pub(super) fn draw_bar<B: DrawingBackend>(area: &DrawingArea<B, Shift>, along: (i32, i32), text: f64) -> DrawResult<B> {
    let ticks = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| (share, format!("{:.0} %", 100.0 * share)));
    Bar { label: "probability of failure", steps: SHADES, ticks: ticks.into() }.draw(area, along, colour, text)
}

/// The kinds of samples in the legend.
#[derive(PartialEq)]
enum Key {
    Line,
    Hatch,
    Grey,
}

/// Draws the legend of the line, of the hatching and, if there is any, of the grey, beginning at a place.
pub(super) fn draw_key<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    estimate: &FailureEstimate,
    (mut x, y): (i32, i32),
    text: f64,
    scale: f64,
) -> DrawResult<B> {
    let (side, stroke) = ((0.4 * text).round() as i32, scale.round() as u32);
    let style = level(0.9 * text, HPos::Left);
    let keys = [("50 % fail", Key::Line), ("undecided", Key::Hatch), ("invalid", Key::Grey)];
    for (label, key) in keys.into_iter().filter(|(_, key)| *key != Key::Grey || estimate.invalid() > 0.0) {
        match key {
            Key::Line => area.draw(&PathElement::new([(x, y), (x + 3 * side, y)], INK.stroke_width(2 * stroke)))?,
            Key::Hatch => {
                for left in (0..3).map(|step| x + step * side) {
                    let ends = [(left, y + side), (left + side, y - side)];
                    area.draw(&PathElement::new(ends, HATCH.stroke_width(stroke)))?;
                }
            }
            Key::Grey => area.draw(&Rectangle::new([(x, y - side), (x + 3 * side, y + side)], INVALID.filled()))?,
        }
        x += 4 * side;
        let (width, _) = area.estimate_text_size(label, &style)?;
        area.draw(&Text::new(label, (x, y), style.clone()))?;
        x += width as i32 + (1.8 * text) as i32;
    }
    Ok(())
}
