//! Writes a picture as the text of an SVG file.

use super::drawing::{Anchor, Colour, Contour, Drawing, Paint, PathSegment, PictureItem, Pixel};
use crate::xml::xml_text;
use std::fmt::Write;

/// The font that pictures are made for. A viewer without this font takes another.
const FONT: &str = "Open Sans, sans-serif";

impl Drawing {
    /// Returns the picture as the text of an SVG file.
    pub fn svg(&self) -> String {
        let [width, height] = [self.width, self.height].map(number);
        let mut svg = Svg { text: String::new() };
        svg.line(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FONT}\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\">"
        ));
        svg.marks(&self.marks);
        svg.line(format_args!("</svg>"));
        xml_text(svg.text)
    }
}

/// The text of an SVG file in the making.
struct Svg {
    text: String,
}

impl Svg {
    fn line(&mut self, what: std::fmt::Arguments) {
        self.text.write_fmt(format_args!("{what}\n")).expect("a string takes all that is written");
    }

    fn marks(&mut self, marks: &[PictureItem]) {
        for mark in marks {
            match mark {
                PictureItem::Fill { contour, paint } => {
                    self.line(format_args!("<path {} d=\"{}\"/>", painted("fill", paint), path(contour)));
                }
                PictureItem::Stroke { contour, paint, width, dash } => {
                    let dash = dash.map_or(String::new(), |[dash, gap]| {
                        format!(" stroke-dasharray=\"{} {}\"", number(dash), number(gap))
                    });
                    self.line(format_args!(
                        "<path fill=\"none\" {} stroke-width=\"{}\"{dash} d=\"{}\"/>",
                        painted("stroke", paint),
                        number(*width),
                        path(contour)
                    ));
                }
                PictureItem::Text { at, anchor, size, colour, halo, text } => {
                    let anchor = match anchor {
                        Anchor::Start => "",
                        Anchor::Middle => " text-anchor=\"middle\"",
                        Anchor::End => " text-anchor=\"end\"",
                    };
                    let halo = halo.map_or(String::new(), |halo| {
                        let (halo, width) = (hex(halo), number(0.25 * size));
                        format!(" stroke=\"{halo}\" stroke-width=\"{width}\" paint-order=\"stroke\"")
                    });
                    let [x, y] = at.map(place);
                    let (size, fill) = (number(*size), hex(*colour));
                    let text = text.replace('&', "&amp;").replace('<', "&lt;");
                    self.line(format_args!(
                        "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{fill}\"{anchor}{halo}>{text}</text>"
                    ));
                }
                PictureItem::Inset { at, drawing } => {
                    let [x, y, width, height] = [at[0], at[1], drawing.width, drawing.height].map(number);
                    self.line(format_args!("<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\">"));
                    self.marks(&drawing.marks);
                    self.line(format_args!("</svg>"));
                }
            }
        }
    }
}

fn painted(what: &str, paint: &Paint) -> String {
    let colour = hex(paint.colour);
    if paint.opacity < 1.0 {
        format!("{what}=\"{colour}\" {what}-opacity=\"{}\"", number(paint.opacity))
    } else {
        format!("{what}=\"{colour}\"")
    }
}

fn path(contour: &Contour) -> String {
    let mut text = String::new();
    let mut points = |command: &str, points: &[Pixel]| {
        text.push_str(command);
        for (i, [x, y]) in points.iter().enumerate() {
            let space = if i > 0 { " " } else { "" };
            write!(text, "{space}{} {}", place(*x), place(*y)).expect("a string takes all that is written");
        }
    };
    for segment in &contour.segments {
        match *segment {
            PathSegment::Move(to) => points("M", &[to]),
            PathSegment::Line(to) => points("L", &[to]),
            PathSegment::Cubic(a, b, to) => points("C", &[a, b, to]),
            PathSegment::Close => points("Z", &[]),
        }
    }
    text
}

/// Formats a share or a width, rounded to a hundredth.
fn number(value: f64) -> String {
    trimmed(format!("{value:.2}"))
}

/// Formats a coordinate, rounded to a tenth of a pixel.
fn place(value: f64) -> String {
    trimmed(format!("{value:.1}"))
}

/// Removes trailing zeros from a formatted number.
fn trimmed(text: String) -> String {
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}
