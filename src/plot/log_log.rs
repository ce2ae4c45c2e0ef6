//! Values over sizes, both axes logarithmic: a power law is a straight line.
//!
//! Every size has a mark for each curve with a whisker from quartile to quartile; marks of one size stand beside each
//! other, so that whiskers do not cover each other. Curves are told apart by the colours of Okabe and Ito (Color
//! Universal Design, 2008), which differ for any colour vision, and by the shapes of their marks, also in grey.

use super::log_axis::Log;
use super::{FAMILY, GRID, INK};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::*;
use plotters_backend::DrawingErrorKind;

/// The width of a plane and of the legend beside the planes, in pixels of the SVG.
pub(super) const PLANE: u32 = 500;
pub(super) const LEGEND: u32 = 230;

/// A chart: planes side by side, and a legend for all of them.
#[derive(Debug, Clone)]
pub(crate) struct LogLog {
    /// The first line above the planes.
    pub title: String,
    /// The second line, smaller.
    pub note: String,
    /// At least one.
    pub planes: Vec<Plane>,
    /// What stands above the two columns of the legend.
    pub legend: [String; 2],
    /// The lines of the legend.
    pub entries: Vec<Entry>,
    /// What a cross is, if there are any.
    pub cross: Option<String>,
}

/// A line of the legend.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub look: Look,
    pub name: String,
    pub number: String,
}

/// Two logarithmic axes with curves over the same sizes.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    /// What the horizontal axis shows.
    pub x: String,
    /// What the vertical axis shows, written above it.
    pub y: String,
    /// A value with a line of its own.
    pub level: Option<f64>,
    pub curves: Vec<Curve>,
}

/// The values of one curve, all above 0.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    pub look: Look,
    /// Size, value, and the ends of the whisker.
    pub marks: Vec<(f64, f64, [f64; 2])>,
    /// Sizes with values that are drawn as crosses without a line.
    pub crosses: Vec<(f64, f64)>,
}

/// How a curve is told from others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Look {
    pub colour: (u8, u8, u8),
    pub shape: Shape,
    pub filled: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    Circle,
    Square,
    Diamond,
    Triangle,
    Tip,
}

impl Look {
    fn colour(self) -> RGBColor {
        let (r, g, b) = self.colour;
        RGBColor(r, g, b)
    }
}

type Result<B> = std::result::Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// Sizes of text and of marks, in pixels of the SVG.
const TEXT: f64 = 16.0;
const SIDE: f64 = 4.2;
/// How far apart marks of one size are, as a share of the horizontal axis.
const APART: f64 = 0.0075;
/// The width of lines. Half of it is a whole number of pixels in either picture: what the plotter rounds, it rounds
/// alike for lines of any direction.
const LINE: f64 = 2.0;

impl LogLog {
    /// Draws the chart over the whole area, every length in pixels times `scale`.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<B> {
        let px = |length: f64| (length * scale).round() as i32;
        let style = |size: f64| TextStyle::from((FAMILY, size * scale).into_font()).color(&INK);
        let (header, body) = area.split_vertically(px(4.2 * TEXT));
        header.draw(&Text::new(self.title.clone(), (px(14.0), px(0.5 * TEXT)), style(1.15 * TEXT)))?;
        header.draw(&Text::new(self.note.clone(), (px(14.0), px(2.0 * TEXT)), style(0.85 * TEXT)))?;
        let (planes, legend) = body.split_horizontally(px(f64::from(PLANE) * self.planes.len() as f64));
        for (plane, part) in self.planes.iter().zip(planes.split_evenly((1, self.planes.len()))) {
            plane.draw(&part, scale)?;
        }
        self.draw_legend(&legend, scale)
    }

    fn draw_legend<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<B> {
        let px = |length: f64| (length * scale).round() as i32;
        let style = TextStyle::from((FAMILY, 0.85 * TEXT * scale).into_font()).color(&INK);
        let (name_at, number_at) = (px(36.0), px(f64::from(LEGEND) - 18.0));
        let write = |name: &str, number: &str, y: i32| {
            let (width, height) = area.estimate_text_size(number, &style)?;
            // The middle of a line's lower-case letters is a little below that of its box.
            let top = y - (0.42 * f64::from(height)) as i32;
            area.draw(&Text::new(name.to_owned(), (name_at, top), style.clone()))?;
            area.draw(&Text::new(number.to_owned(), (number_at - width as i32, top), style.clone()))
        };
        let line = |i: usize| px(TEXT * (1.2 + 1.55 * i as f64));
        write(&self.legend[0], &self.legend[1], line(0))?;
        for (i, entry) in self.entries.iter().enumerate() {
            let y = line(i + 1);
            let stroke = entry.look.colour().stroke_width(px(LINE) as u32);
            area.draw(&PathElement::new([(px(4.0), y), (px(28.0), y)], stroke))?;
            area.draw(&(EmptyElement::at((px(16.0), y)) + Symbol::of(entry.look, scale)))?;
            write(&entry.name, &entry.number, y)?;
        }
        if let Some(cross) = &self.cross {
            let y = line(self.entries.len() + 2);
            area.draw(&(EmptyElement::at((px(16.0), y)) + Symbol::cross(INK, scale)))?;
            write(cross, "", y)?;
        }
        Ok(())
    }
}

impl Plane {
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<B> {
        let px = |length: f64| (length * scale).round() as u32;
        let style = |size: f64| TextStyle::from((FAMILY, size * scale).into_font()).color(&INK);
        let (x, y) = self.axes();
        area.draw(&Text::new(self.y.clone(), (px(14.0) as i32, 0), style(0.9 * TEXT)))?;
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
            .axis_desc_style(style(0.9 * TEXT))
            .label_style(style(0.8 * TEXT))
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
        // Lines first, then whiskers, then marks: what matters most is never covered.
        for (i, curve) in self.curves.iter().enumerate() {
            let line = curve.marks.iter().map(|(size, value, _)| (beside(i, *size), *value));
            plane.draw(&PathElement::new(line.collect::<Vec<_>>(), curve.look.colour().stroke_width(px(LINE))))?;
        }
        for (i, curve) in self.curves.iter().enumerate() {
            for (size, _, [low, high]) in &curve.marks {
                let at = beside(i, *size);
                let whisker = curve.look.colour().stroke_width(px(LINE));
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
                let cross = Symbol::cross(curve.look.colour(), scale);
                plane.draw(&(EmptyElement::at((beside(i, *size), *value)) + cross))?;
            }
        }
        Ok(())
    }

    /// Axes with room around all that is drawn.
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

/// A mark, `side` pixels from its middle to its end.
struct Symbol {
    /// None is a cross.
    shape: Option<Shape>,
    colour: RGBColor,
    filled: bool,
    side: f64,
}

impl Symbol {
    fn of(look: Look, scale: f64) -> Self {
        Self { shape: Some(look.shape), colour: look.colour(), filled: look.filled, side: SIDE * scale }
    }

    fn cross(colour: RGBColor, scale: f64) -> Self {
        Self { shape: None, colour, filled: true, side: SIDE * scale }
    }

    /// Fills the mark, a share of its size.
    fn fill<B: DrawingBackend>(
        &self,
        backend: &mut B,
        (x, y): (i32, i32),
        share: f64,
        colour: RGBColor,
    ) -> std::result::Result<(), DrawingErrorKind<B::ErrorType>> {
        // Shapes of about the same area.
        let corners: &[(f64, f64)] = match self.shape {
            Some(Shape::Circle) => {
                return backend.draw_circle((x, y), (1.1 * share * self.side).round() as u32, &colour, true);
            }
            Some(Shape::Square) => &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)],
            Some(Shape::Diamond) => &[(0.0, -1.5), (1.5, 0.0), (0.0, 1.5), (-1.5, 0.0)],
            Some(Shape::Triangle) => &[(0.0, -1.4), (1.3, 0.9), (-1.3, 0.9)],
            Some(Shape::Tip) => &[(0.0, 1.4), (1.3, -0.9), (-1.3, -0.9)],
            None => &[],
        };
        let along = |middle: i32, offset: f64| middle + (offset * share * self.side).round() as i32;
        backend.fill_polygon(corners.iter().map(|(right, down)| (along(x, *right), along(y, *down))), &colour)
    }
}

impl<'a> PointCollection<'a, (i32, i32)> for &'a Symbol {
    type Point = (i32, i32);
    type IntoIter = std::iter::Once<(i32, i32)>;

    fn point_iter(self) -> Self::IntoIter {
        std::iter::once((0, 0))
    }
}

impl<B: DrawingBackend> Drawable<B> for Symbol {
    fn draw<I: Iterator<Item = (i32, i32)>>(
        &self,
        mut points: I,
        backend: &mut B,
        _: (u32, u32),
    ) -> std::result::Result<(), DrawingErrorKind<B::ErrorType>> {
        let Some((x, y)) = points.next() else { return Ok(()) };
        if self.shape.is_none() {
            let (side, stroke) =
                ((0.95 * self.side).round() as i32, self.colour.stroke_width((0.45 * self.side) as u32));
            backend.draw_line((x - side, y - side), (x + side, y + side), &stroke)?;
            return backend.draw_line((x - side, y + side), (x + side, y - side), &stroke);
        }
        self.fill(backend, (x, y), 1.0, self.colour)?;
        if self.filled { Ok(()) } else { self.fill(backend, (x, y), 0.5, WHITE) }
    }
}
