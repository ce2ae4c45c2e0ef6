//! Draws figures for one column of a paper: 8.5 cm wide, with text of 6 to 7 points, as SVG with text as text.
//!
//! A figure has no title, because a paper has the title in the caption. Its panels have letters.

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn<T = ()> = Result<T, Box<dyn Error + Send + Sync>>;

/// The width of a figure in tenths of a pixel, of which an inch has 96: 8.5 cm.
const WIDTH: i32 = 3213;
/// The width in pixels at which a browser shows a figure.
const SHOWN: i32 = 680;
/// The sizes of text: 7 points for names, and 6 points for numbers. The plotter writes sizes that are smaller by this factor.
const NAME: f64 = 93.0 * WRITTEN;
const NUMBER: f64 = 81.0 * WRITTEN;
const WRITTEN: f64 = 1.24;
const FAMILY: &str = "Open Sans, Helvetica, Arial, sans-serif";

pub const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const GRID: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);
/// The colours of Okabe and Ito, which people with any sight for colours tell apart.
pub const BLUE: RGBColor = RGBColor(0x00, 0x72, 0xb2);
pub const ORANGE: RGBColor = RGBColor(0xd5, 0x5e, 0x00);
pub const GREEN: RGBColor = RGBColor(0x00, 0x9e, 0x73);
pub const PINK: RGBColor = RGBColor(0xcc, 0x79, 0xa7);
pub const SKY: RGBColor = RGBColor(0x56, 0xb4, 0xe9);
pub const YELLOW: RGBColor = RGBColor(0xe6, 0x9f, 0x00);
pub const GREY: RGBColor = RGBColor(0x99, 0x99, 0x99);
/// Colours for curves, in the order of their use.
pub const CURVES: [RGBColor; 8] = [BLUE, ORANGE, GREEN, PINK, SKY, YELLOW, INK, GREY];
/// The pale colour of a region where tests fail.
pub const FAILING: RGBColor = RGBColor(0xfa, 0xd4, 0xc0);

/// An axis of a panel.
#[derive(Clone)]
pub struct Axis {
    /// The quantity, with its unit in parentheses.
    pub label: String,
    pub range: (f64, f64),
    /// The places of the numbers.
    pub ticks: Vec<f64>,
    /// The number that is written at a place.
    written: fn(f64) -> String,
    /// A second number below each number of a horizontal axis, such as a visibility.
    pub second: Option<fn(f64) -> String>,
}

impl Axis {
    /// Makes an axis with numbers at equal distances.
    pub fn new(label: &str, range: (f64, f64), step: f64) -> Self {
        let steps = ((range.1 - range.0) / step + 1e-9).floor() as usize;
        let ticks = (0..=steps).map(|i| range.0 + i as f64 * step).collect();
        Self { label: label.to_owned(), range, ticks, written: short, second: None }
    }

    /// Makes an axis of decimal logarithms from the first to the last of these numbers.
    ///
    /// # Panics
    /// There is no number.
    pub fn logarithmic(label: &str, numbers: &[f64]) -> Self {
        let ticks: Vec<f64> = numbers.iter().map(|number| libm::log10(*number)).collect();
        let range = (ticks[0], ticks[ticks.len() - 1]);
        Self { label: label.to_owned(), range, ticks, written: |power| short(libm::pow(10.0, power)), second: None }
    }

    pub fn at(mut self, ticks: &[f64]) -> Self {
        self.ticks = ticks.to_vec();
        self
    }

    /// Adds the visibility in metres below each density of fog.
    pub fn with_visibility(mut self) -> Self {
        self.second = Some(visibility);
        self
    }

    fn share(&self, value: f64) -> f64 {
        (value - self.range.0) / (self.range.1 - self.range.0)
    }
}

/// Returns the visibility in a density of fog, such as `1.4 km` (docs/cameras.md has the formula).
fn visibility(fog: f64) -> String {
    if fog <= 0.0 {
        return "clear".to_owned();
    }
    let metres = 9990.0 / (libm::pow(1000.0, fog) - 1.0);
    match metres {
        100.0..1000.0 => format!("{:.0} m", 10.0 * (metres / 10.0).round()),
        1000.0.. => format!("{:.1} km", metres / 1000.0),
        _ => format!("{metres:.0} m"),
    }
}

/// A mark of a point.
#[derive(Clone, Copy)]
pub enum Mark {
    Dot(f64),
    Cross(f64),
    /// A ring, which marks a place among other marks.
    Ring(f64),
}

/// Something that a panel shows. Later layers lie above earlier ones.
pub enum Layer {
    /// Filled rectangles between two corners.
    Cells(Vec<[(f64, f64); 2]>, RGBColor),
    /// A band between a lower and an upper curve.
    Band(Vec<(f64, f64, f64)>, RGBColor),
    Points(Vec<(f64, f64)>, Mark, RGBColor),
    /// Dots, each with a colour of its own.
    Tinted(Vec<(f64, f64, RGBColor)>, f64),
    Line(Vec<(f64, f64)>, RGBColor),
    Dashed(Vec<(f64, f64)>, RGBColor),
}

/// A part of a figure with two axes.
pub struct Panel {
    /// The name above the panel, such as `(a) random, 25 tests`.
    pub name: String,
    pub x: Axis,
    pub y: Axis,
    pub layers: Vec<Layer>,
}

/// The look of an entry of the legend.
pub enum Key {
    Mark(Mark, RGBColor),
    Line(RGBColor),
    Dashed(RGBColor),
    Area(RGBColor),
}

/// A bar that shows which colour stands for which number.
pub struct Bar {
    pub label: String,
    pub range: (f64, f64),
    pub ticks: Vec<f64>,
    pub colour: fn(f64) -> RGBColor,
}

/// A figure: panels in rows, and a legend above them.
pub struct Figure {
    pub columns: usize,
    /// The height of each panel's plane, as a share of the width of the panel.
    pub shape: f64,
    pub panels: Vec<Panel>,
    pub legend: Vec<(Key, String)>,
    pub bar: Option<Bar>,
}

/// The width of all figures in units of their drawing, which text is measured in, too.
#[cfg(test)]
pub fn width() -> f64 {
    f64::from(WIDTH)
}

fn text(size: f64, h: HPos, v: VPos) -> TextStyle<'static> {
    TextStyle::from((FAMILY, size).into_font()).color(&INK).pos(Pos::new(h, v))
}

/// The room that a text takes, roughly: this font has no wider letters on average.
fn length(of: &str, size: f64) -> i32 {
    (0.43 * size * of.chars().count() as f64) as i32
}

fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// The room of an entry of the legend, besides its text.
const ENTRY: i32 = 280;
/// The room above the plane of a panel, for its name, and below it: for numbers, for second numbers, for the label, and between rows.
const ABOVE: i32 = 130;
const NUMBERS: i32 = 130;
const SECOND: i32 = 100;
const LABEL: i32 = 140;
const GAP: i32 = 60;
/// The overlap of rectangles that have a side in common.
const OVERLAP: i32 = 4;

impl Figure {
    /// Returns the figure as the text of an SVG file.
    pub fn svg(&self) -> Drawn<String> {
        let legend = self.legend_rows();
        let top = 40 + 120 * legend.len() as i32;
        let right = if self.bar.is_some() { 420 } else { 0 };
        let wide = (WIDTH - right) / self.columns as i32;
        let plane = (self.shape * f64::from(wide)) as i32;
        let (mut places, mut y) = (Vec::new(), top);
        for row in self.panels.chunks(self.columns) {
            places.push(y);
            y += plane + row.iter().map(|panel| self.room(panel)).max().unwrap_or(0);
        }
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, (WIDTH as u32, y as u32)).into_drawing_area();
            area.fill(&WHITE)?;
            for (row, entries) in legend.iter().enumerate() {
                Self::draw_legend(&area, entries, 70 + 120 * row as i32)?;
            }
            for (i, panel) in self.panels.iter().enumerate() {
                let corner = ((i % self.columns) as i32 * wide, places[i / self.columns]);
                let labels = [self.is_labelled(panel), i % self.columns == 0];
                panel.draw(&area, corner, (wide, plane), labels)?;
            }
            if let Some(bar) = &self.bar {
                bar.draw(&area, WIDTH - right + 60, (top + ABOVE, top + ABOVE + plane))?;
            }
            area.present()?;
        }
        let old = format!("width=\"{WIDTH}\" height=\"{y}\"");
        Ok(svg.replacen(&old, &format!("width=\"{SHOWN}\" height=\"{}\"", y * SHOWN / WIDTH), 1))
    }

    /// Returns `true` if the label of a panel's horizontal axis is not below another panel of its column, too.
    fn is_labelled(&self, panel: &Panel) -> bool {
        let place = self.panels.iter().position(|other| std::ptr::eq(other, panel)).unwrap_or(0);
        self.panels.get(place + self.columns).is_none_or(|below| below.x.label != panel.x.label)
    }

    /// Returns the room above and below the plane of a panel.
    fn room(&self, panel: &Panel) -> i32 {
        let second = if panel.x.second.is_some() { SECOND } else { 0 };
        let label = if self.is_labelled(panel) { LABEL } else { 0 };
        ABOVE + NUMBERS + second + label + GAP
    }

    /// Divides the legend into rows that fit the width.
    fn legend_rows(&self) -> Vec<Vec<&(Key, String)>> {
        let (mut rows, mut x): (Vec<Vec<&(Key, String)>>, i32) = (Vec::new(), 0);
        for entry in &self.legend {
            let own = ENTRY + length(&entry.1, NUMBER);
            if rows.is_empty() || x + own > WIDTH {
                rows.push(Vec::new());
                x = 0;
            }
            x += own;
            rows.last_mut().expect("there is a row").push(entry);
        }
        rows
    }

    fn draw_legend(area: &Area<'_>, entries: &[&(Key, String)], y: i32) -> Drawn {
        let mut x = 60;
        for (key, name) in entries {
            match key {
                Key::Mark(mark, colour) => mark.draw(area, (x + 70, y), *colour)?,
                Key::Line(colour) => line(area, &[(x, y), (x + 140, y)], *colour)?,
                Key::Dashed(colour) => dashes(area, &[(x, y), (x + 140, y)], *colour)?,
                Key::Area(colour) => area.draw(&Rectangle::new([(x, y - 35), (x + 140, y + 35)], colour.filled()))?,
            }
            area.draw(&Text::new(name.clone(), (x + 180, y), text(NUMBER, HPos::Left, VPos::Center)))?;
            x += ENTRY + length(name, NUMBER);
        }
        Ok(())
    }
}

impl Mark {
    fn draw(self, area: &Area<'_>, (x, y): (i32, i32), colour: RGBColor) -> Drawn {
        match self {
            Self::Dot(size) => area.draw(&Circle::new((x, y), size as i32, colour.filled()))?,
            Self::Ring(size) => area.draw(&Circle::new((x, y), size as i32, colour.stroke_width(14)))?,
            Self::Cross(size) => {
                let size = size as i32;
                for ends in [[(x - size, y - size), (x + size, y + size)], [(x - size, y + size), (x + size, y - size)]]
                {
                    area.draw(&PathElement::new(ends, colour.stroke_width(12)))?;
                }
            }
        }
        Ok(())
    }
}

fn line(area: &Area<'_>, points: &[(i32, i32)], colour: RGBColor) -> Drawn {
    Ok(area.draw(&PathElement::new(points.to_vec(), colour.stroke_width(14)))?)
}

fn dashes(area: &Area<'_>, points: &[(i32, i32)], colour: RGBColor) -> Drawn {
    Ok(area.draw(&DashedPathElement::new(points.iter().copied(), 50, 35, colour.stroke_width(14)))?)
}

impl Panel {
    /// Draws the panel with its corner at a place. The labels of its axes are drawn if they are wanted.
    fn draw(
        &self,
        area: &Area<'_>,
        (left, top): (i32, i32),
        (wide, plane): (i32, i32),
        [label_x, label_y]: [bool; 2],
    ) -> Drawn {
        let last = self.x.ticks.last().map_or(0, |tick| length(&(self.x.written)(*tick), NUMBER));
        let margin = if self.x.second.is_some() { 140 } else { 70.max(last / 2 + 20) };
        let (x0, x1) = (left + 330, left + wide - margin);
        let (y0, y1) = (top + ABOVE, top + ABOVE + plane);
        let across = |x: f64| x0 + (self.x.share(x) * f64::from(x1 - x0)).round() as i32;
        let up = |y: f64| y1 - (self.y.share(y) * f64::from(y1 - y0)).round() as i32;
        let place = |(x, y): (f64, f64)| (across(x), up(y));
        area.draw(&Text::new(self.name.clone(), (x0, y0 - 70), text(NAME, HPos::Left, VPos::Center)))?;
        for layer in &self.layers {
            if let Layer::Cells(cells, colour) = layer {
                for corners in cells {
                    let [a, b] = corners.map(place);
                    // Neighbours overlap a little, so that no line is seen between them.
                    let below = (b.0.max(a.0) + OVERLAP, a.1.max(b.1) + OVERLAP);
                    area.draw(&Rectangle::new([(a.0.min(b.0), a.1.min(b.1)), below], colour.filled()))?;
                }
            }
        }
        for tick in &self.x.ticks {
            let x = across(*tick);
            area.draw(&PathElement::new([(x, y0), (x, y1)], GRID.stroke_width(5)))?;
            area.draw(&Text::new((self.x.written)(*tick), (x, y1 + 30), text(NUMBER, HPos::Center, VPos::Top)))?;
            if let Some(second) = self.x.second {
                area.draw(&Text::new(second(*tick), (x, y1 + 30 + SECOND), text(NUMBER, HPos::Center, VPos::Top)))?;
            }
        }
        for tick in &self.y.ticks {
            let y = up(*tick);
            area.draw(&PathElement::new([(x0, y), (x1, y)], GRID.stroke_width(5)))?;
            area.draw(&Text::new((self.y.written)(*tick), (x0 - 30, y), text(NUMBER, HPos::Right, VPos::Center)))?;
        }
        area.draw(&PathElement::new([(x0, y0), (x0, y1), (x1, y1)], INK.stroke_width(8)))?;
        self.layers.iter().try_for_each(|layer| layer.draw(area, &place))?;
        if label_x {
            let second = if self.x.second.is_some() { SECOND } else { 0 };
            let at = (i32::midpoint(x0, x1), y1 + NUMBERS + second + 20);
            area.draw(&Text::new(self.x.label.clone(), at, text(NAME, HPos::Center, VPos::Top)))?;
        }
        if label_y {
            let style = text(NAME, HPos::Center, VPos::Top).transform(FontTransform::Rotate270);
            area.draw(&Text::new(self.y.label.clone(), (left + 20, i32::midpoint(y0, y1)), style))?;
        }
        Ok(())
    }
}

impl Layer {
    fn draw(&self, area: &Area<'_>, place: &dyn Fn((f64, f64)) -> (i32, i32)) -> Drawn {
        match self {
            Self::Cells(..) => {}
            Self::Band(points, colour) => {
                let (above, below): (Vec<_>, Vec<_>) =
                    points.iter().map(|(x, low, high)| (place((*x, *high)), place((*x, *low)))).unzip();
                let around: Vec<(i32, i32)> = above.into_iter().chain(below.into_iter().rev()).collect();
                area.draw(&Polygon::new(around, colour.mix(0.25)))?;
            }
            Self::Points(points, mark, colour) => {
                points.iter().try_for_each(|point| mark.draw(area, place(*point), *colour))?;
            }
            Self::Tinted(points, size) => {
                for (x, y, colour) in points {
                    Mark::Dot(*size).draw(area, place((*x, *y)), *colour)?;
                }
            }
            Self::Line(points, colour) => {
                line(area, &points.iter().map(|point| place(*point)).collect::<Vec<_>>(), *colour)?;
            }
            Self::Dashed(points, colour) => {
                dashes(area, &points.iter().map(|point| place(*point)).collect::<Vec<_>>(), *colour)?;
            }
        }
        Ok(())
    }
}

impl Bar {
    const STEPS: i32 = 40;

    fn draw(&self, area: &Area<'_>, left: i32, (top, bottom): (i32, i32)) -> Drawn {
        let at = |share: f64| bottom - (share * f64::from(bottom - top)).round() as i32;
        for step in 0..Self::STEPS {
            let [low, high] = [step, step + 1].map(|step| f64::from(step) / f64::from(Self::STEPS));
            let value = self.range.0 + f64::midpoint(low, high) * (self.range.1 - self.range.0);
            area.draw(&Rectangle::new(
                [(left, at(high)), (left + 90, at(low) + OVERLAP)],
                (self.colour)(value).filled(),
            ))?;
        }
        for tick in &self.ticks {
            let y = at((tick - self.range.0) / (self.range.1 - self.range.0));
            area.draw(&Text::new(short(*tick), (left + 110, y), text(NUMBER, HPos::Left, VPos::Center)))?;
        }
        let style = text(NAME, HPos::Center, VPos::Bottom).transform(FontTransform::Rotate270);
        Ok(area.draw(&Text::new(self.label.clone(), (left + 370, i32::midpoint(top, bottom)), style))?)
    }
}
