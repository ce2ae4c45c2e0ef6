//! Draws pictures, as SVG for papers and as PNG for everything else.
//!
//! The same code draws both. The PNG has twice the size, so that it is sharp on any screen. The crate plotters draws
//! failure maps and charts, for PNG on a canvas of our own; the engine draws pictures of worlds and runs. The font is
//! part of the program, so that pictures look the same on a machine without fonts.

mod animation;
mod bar;
mod contour;
mod drawn;
mod frame;
mod heat;
mod log_axis;
mod log_log;
mod map;
mod map_files;
mod mark;
mod raster;
mod shade;
mod shares;
mod slice;
mod survival;
mod symbol;
mod tint;
mod wrapped;

use crate::xml::xml_text;
pub use animation::film_gif;
#[cfg(feature = "camera")]
pub use animation::{Colours, Reel};
pub use frame::{Entry, PlotFrame};
pub use heat::HeatMap;
pub use log_log::{LogLog, LogLogCurve, Plane};
pub use map::{Axis, FailureMap};
pub use map_files::MapFiles;
pub use mark::Mark;
pub use raster::drawing_png;
pub use shares::{Series, Shares};
pub use slice::{Slice, Slices};
pub use survival::{Survivals, Waiting};
pub use tint::Tints;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, register_font};
use std::error::Error as StdError;
use std::sync::Once;

/// The result of drawing to a backend.
type DrawResult<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// The font Open Sans, Apache License 2.0 (see its folder).
const FONT: &[u8] = include_bytes!("font/OpenSans-Regular.ttf");
/// The name of the font in pictures. Viewers of an SVG that do not have this font use their own sans-serif font.
const FAMILY: &str = "Open Sans, sans-serif";
/// The size of the PNG as a multiple of the size of the SVG.
const PNG_SCALE: u32 = 2;

const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const GRID: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);

/// Returns the style of a text of this size.
fn ink(size: f64) -> TextStyle<'static> {
    TextStyle::from((FAMILY, size).into_font()).color(&INK)
}

/// Returns the style of a text that is centred vertically on its position.
fn level(size: f64, along: HPos) -> TextStyle<'static> {
    ink(size).pos(Pos::new(along, VPos::Center))
}

/// A picture that consists of failure maps, charts or images in rows.
#[derive(Debug, Clone)]
pub struct Picture {
    panels: Vec<Panel>,
    columns: usize,
    /// The width and the height of each panel, in pixels of the SVG.
    size: (u32, u32),
}

/// A part of a picture.
#[derive(Debug, Clone)]
enum Panel {
    Map(FailureMap),
    LogLog(LogLog),
    Shares(Shares),
    Survivals(Survivals),
    Heat(HeatMap),
    Slices(Slices),
}

type Drawn = Result<(), Box<dyn StdError + Send + Sync>>;

impl Picture {
    /// Makes a picture of one failure map.
    pub fn of(map: FailureMap) -> Self {
        Self { panels: vec![Panel::Map(map)], columns: 1, size: (900, 680) }
    }

    /// Makes a picture of a chart with logarithmic axes.
    pub fn of_log_log(chart: LogLog) -> Self {
        let size = (frame::LEGEND + log_log::PLANE * chart.planes.len() as u32, chart.frame.height());
        Self { panels: vec![Panel::LogLog(chart)], columns: 1, size }
    }

    /// Makes a picture of a chart of shares.
    pub fn of_shares(chart: Shares) -> Self {
        let size = (frame::LEGEND + shares::PLANE, chart.frame.height());
        Self { panels: vec![Panel::Shares(chart)], columns: 1, size }
    }

    /// Makes a picture of a chart of survival curves, which show the share of runs that still wait for an event.
    pub fn of_survivals(chart: Survivals) -> Self {
        let size = (frame::LEGEND + survival::PLANE, frame::HEADER + chart.height());
        Self { panels: vec![Panel::Survivals(chart)], columns: 1, size }
    }

    /// Makes a picture of several images of equal size, in rows of `columns` images.
    ///
    /// # Panics
    /// Panics if there is no image or no column.
    pub fn of_images(columns: usize, images: Vec<HeatMap>) -> Self {
        assert!(columns > 0 && !images.is_empty(), "a picture shows something");
        let size = images[0].size();
        Self { panels: images.into_iter().map(Panel::Heat).collect(), columns, size }
    }

    /// Makes a picture of the slices of a hole.
    ///
    /// # Panics
    /// Panics if there is no slice.
    pub fn of_slices(slices: Slices) -> Self {
        assert!(!slices.panels.is_empty(), "a picture shows something");
        let size = slices.size();
        Self { panels: vec![Panel::Slices(slices)], columns: 1, size }
    }

    fn extent(&self) -> (u32, u32) {
        let rows = self.panels.len().div_ceil(self.columns);
        (self.size.0 * self.columns as u32, self.size.1 * rows as u32)
    }

    /// Returns the picture as the text of an SVG file.
    ///
    /// # Errors
    /// Returns an error if the plotter fails.
    pub fn svg(&self) -> Result<String, Box<dyn StdError + Send + Sync>> {
        let mut text = String::new();
        let area = SVGBackend::with_string(&mut text, self.extent()).into_drawing_area();
        self.draw(&area, 1)?;
        drop(area);
        Ok(xml_text(text))
    }

    /// Returns the picture as the contents of a PNG file.
    ///
    /// # Errors
    /// Returns an error if the plotter or the encoder fails.
    pub fn png(&self) -> Result<Vec<u8>, Box<dyn StdError + Send + Sync>> {
        let (width, height) = self.extent();
        let (width, height) = (width * PNG_SCALE, height * PNG_SCALE);
        let mut pixels = raster::sheet(width, height);
        self.draw(&raster::Canvas::on(&mut pixels).into_drawing_area(), PNG_SCALE)?;
        encode_png(width, height, &raster::opaque(&pixels))
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Drawn
    where
        B::ErrorType: 'static,
    {
        with_font();
        let drawn: Result<(), DrawingAreaErrorKind<B::ErrorType>> = (|| {
            area.fill(&WHITE)?;
            let rows = self.panels.len().div_ceil(self.columns);
            for (panel, part) in self.panels.iter().zip(area.split_evenly((rows, self.columns))) {
                match panel {
                    Panel::Map(map) => map.draw(&part, f64::from(scale))?,
                    Panel::LogLog(chart) => chart.draw(&part, f64::from(scale))?,
                    Panel::Shares(chart) => chart.draw(&part, f64::from(scale))?,
                    Panel::Survivals(chart) => chart.draw(&part, f64::from(scale))?,
                    Panel::Heat(image) => image.draw(&part, scale)?,
                    Panel::Slices(slices) => slices.draw(&part, f64::from(scale))?,
                }
            }
            area.present()
        })();
        drawn.map_err(Into::into)
    }
}

/// Registers the font that is part of the program with the plotter.
fn with_font() {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(|| {
        let registered = register_font(FAMILY, FontStyle::Normal, FONT);
        assert!(registered.is_ok(), "the font in the program is a font");
    });
}

/// Returns the contents of a PNG file with the given pixels, each as red, green and blue.
fn encode_png(width: u32, height: u32, pixels: &[u8]) -> Result<Vec<u8>, Box<dyn StdError + Send + Sync>> {
    let mut file = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut file, width, height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_compression(::png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(file)
}
