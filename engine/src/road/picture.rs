//! A road network from above, as SVG: true arcs, in metres, with a scale.

use super::bounds::Bounds;
use super::curve::Curve;
use super::lane::{Lane, LaneKind};
use super::network::Network;
use super::route::Route;
use super::strip::{Strip, Surface};
use crate::scenario::Pose;
use nalgebra::Vector2;
use std::fmt::Write;

/// Width or height of a picture in pixels, whichever is greater, without its margins.
const SIZE: f64 = 1200.0;
/// The largest number of pixels to a metre, for small networks.
const LARGEST_SCALE: f64 = 16.0;
/// Pixels around the network, and below it for the scale.
const MARGIN: f64 = 28.0;
const FOOT: f64 = 34.0;
/// To how many metres the edges of the picture are right.
const FAITHFUL: f64 = 0.1;
/// What is thinner than this many pixels is left out.
const THINNEST: f64 = 0.1;

const GROUND: &str = "#e4eadb";
const INK: &str = "#333333";

/// Red, green and blue.
pub type Colour = [u8; 3];

/// A network from above, and what is shown on it.
#[derive(Debug, Clone)]
pub struct RoadPicture<'a> {
    network: &'a Network,
    lanes: bool,
    routes: Vec<(Route, Colour)>,
    bodies: Vec<(Pose, [f64; 2], Colour)>,
}

impl<'a> RoadPicture<'a> {
    /// The network alone.
    pub fn of(network: &'a Network) -> Self {
        Self { network, lanes: false, routes: Vec::new(), bodies: Vec::new() }
    }

    /// Shows the middle of every lane with an arrow.
    pub fn lanes(mut self) -> Self {
        self.lanes = true;
        self
    }

    /// Shows a way.
    pub fn route(mut self, route: &Route, colour: Colour) -> Self {
        self.routes.push((route.clone(), colour));
        self
    }

    /// Shows a body, a car for example, of this length and width in metres, with its front marked.
    pub fn body(mut self, pose: Pose, length: f64, width: f64, colour: Colour) -> Self {
        self.bodies.push((pose, [length, width], colour));
        self
    }

    /// The picture as the text of an SVG file.
    pub fn svg(&self) -> String {
        let mut strips = self.network.strips();
        let sides = strips.iter().map(|strip| strip.sides(FAITHFUL));
        let bounds = Bounds::around(sides.flat_map(|(right, left)| right.into_iter().chain(left)));
        let extent = bounds.max - bounds.min;
        let scale = (SIZE / extent.max()).min(LARGEST_SCALE);
        strips.retain(|strip| (strip.left - strip.right) * scale > THINNEST);
        let (width, height) = (extent.x * scale + 2.0 * MARGIN, extent.y * scale + 2.0 * MARGIN + FOOT);
        let mut svg = Svg { text: String::new() };
        svg.line(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\">"
        ));
        svg.line(format_args!("<rect width=\"100%\" height=\"100%\" fill=\"{GROUND}\"/>"));
        let (left, top) = (MARGIN - scale * bounds.min.x, MARGIN + scale * bounds.max.y);
        svg.line(format_args!(
            "<g transform=\"matrix({scale:.5} 0 0 {:.5} {left:.3} {top:.3})\" stroke-linejoin=\"round\">",
            -scale
        ));
        for of_one in strips.chunk_by(|a, b| a.surface == b.surface) {
            svg.surface(of_one, scale);
        }
        if self.lanes {
            svg.lanes(self.network.lanes());
        }
        for (route, colour) in &self.routes {
            svg.route(self.network, route, *colour);
        }
        for (pose, size, colour) in &self.bodies {
            svg.body(pose, *size, *colour);
        }
        svg.line(format_args!("</g>"));
        svg.scale(scale, height - 0.5 * (MARGIN + FOOT));
        svg.line(format_args!("</svg>"));
        svg.text
    }
}

/// The colour of a surface.
fn fill(surface: Surface) -> &'static str {
    match surface {
        Surface::Sidewalk => "#d6d2ca",
        Surface::Carriageway => "#5b5f66",
        Surface::Island => "#b9cda2",
        Surface::Kerb => "#aaa59b",
        Surface::CentreLine | Surface::LaneLine | Surface::EdgeLine => "#e9e7df",
        Surface::StopLine | Surface::GiveWayLine | Surface::Zebra => "#f6f4ee",
    }
}

/// The colour of a lane's middle.
fn lane_colour(lane: &Lane) -> &'static str {
    match lane.kind {
        LaneKind::Road => "#8ecae6",
        LaneKind::Straight | LaneKind::Ring | LaneKind::RingAtArm => "#ffd166",
        LaneKind::Left | LaneKind::Entry => "#ef8a8a",
        LaneKind::Right | LaneKind::Exit => "#9be08a",
    }
}

/// The text of an SVG file in the making.
struct Svg {
    text: String,
}

impl Svg {
    fn write(&mut self, what: std::fmt::Arguments) {
        self.text.write_fmt(what).expect("a string takes all that is written");
    }

    fn line(&mut self, what: std::fmt::Arguments) {
        self.write(format_args!("{what}\n"));
    }

    /// All strips of one surface as one shape.
    fn surface(&mut self, strips: &[Strip], scale: f64) {
        let surface = strips[0].surface;
        let colour = fill(surface);
        self.write(format_args!("<path fill=\"{colour}\""));
        // Ground is drawn half a pixel wider, so that no seam shows between elements.
        if matches!(surface, Surface::Sidewalk | Surface::Carriageway) {
            self.write(format_args!(" stroke=\"{colour}\" stroke-width=\"{:.3}\"", 1.0 / scale));
        }
        self.write(format_args!(" d=\""));
        for strip in strips.iter().flat_map(Strip::solid_parts) {
            let end = strip.curve.length();
            self.point('M', strip.curve.beside(0.0, strip.right));
            self.along(&strip.curve, strip.right, [0.0, end]);
            self.point('L', strip.curve.beside(end, strip.left));
            self.along(&strip.curve, strip.left, [end, 0.0]);
            self.write(format_args!("Z"));
        }
        self.line(format_args!("\"/>"));
    }

    fn point(&mut self, command: char, point: Vector2<f64>) {
        self.write(format_args!("{command}{:.2} {:.2}", point.x, point.y));
    }

    /// On beside a curve, in arcs of less than half a circle.
    fn along(&mut self, curve: &Curve, offset: f64, [from, to]: [f64; 2]) {
        if curve.curvature() == 0.0 {
            return self.point('L', curve.beside(to, offset));
        }
        let radius = (1.0 / curve.curvature() - offset).abs();
        let sweep = u8::from((to > from) == (curve.curvature() > 0.0));
        let pieces = ((curve.curvature() * (to - from)).abs() / 2.0).ceil().max(1.0);
        for piece in 1..=pieces as usize {
            let end = curve.beside(from + (to - from) * piece as f64 / pieces, offset);
            self.write(format_args!("A{radius:.2} {radius:.2} 0 0 {sweep} {:.2} {:.2}", end.x, end.y));
        }
    }

    /// The middles of lanes, with an arrow in the middle of each.
    fn lanes(&mut self, lanes: &[Lane]) {
        for lane in lanes {
            let colour = lane_colour(lane);
            self.write(format_args!("<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"0.25\" d=\""));
            self.point('M', lane.curve.point(0.0));
            self.along(&lane.curve, 0.0, [0.0, lane.length()]);
            self.line(format_args!("\"/>"));
            let middle = lane.curve.at(0.5 * lane.length());
            self.write(format_args!("<path fill=\"{colour}\" d=\""));
            for (command, x, y) in [('M', 0.9, 0.0), ('L', -0.5, 0.55), ('L', -0.5, -0.55)] {
                let corner = Pose { position: Vector2::new(x, y), heading: 0.0 };
                self.point(command, middle.then(&corner).position);
            }
            self.line(format_args!("Z\"/>"));
        }
    }

    /// The way along the middles of its lanes; where it changes to a lane beside, over half of what is left of both.
    fn route(&mut self, network: &Network, route: &Route, colour: Colour) {
        self.write(format_args!(
            "<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\" stroke-linecap=\"round\" \
             stroke-opacity=\"0.85\" d=\"",
            hex(colour)
        ));
        let curve = |index: usize| &network.lane(route.lanes[index]).curve;
        let mut from = route.start / curve(0).length();
        self.point('M', curve(0).point(route.start));
        for index in 0..route.lanes.len() {
            let here = curve(index);
            match route.lanes.get(index + 1) {
                Some(next) if network.lane(route.lanes[index]).beside().any(|beside| beside == *next) => {
                    let last = index + 2 == route.lanes.len();
                    let until = if last { route.end / curve(index + 1).length() } else { 1.0 };
                    let to = 0.5 * (from + until);
                    for (share, aside) in sideways() {
                        let along = from + (to - from) * share;
                        let [a, b] = [here, curve(index + 1)].map(|curve| curve.point(along * curve.length()));
                        self.point('L', a + (b - a) * aside);
                    }
                    from = to;
                }
                next => {
                    let end = if next.is_some() { here.length() } else { route.end };
                    self.along(here, 0.0, [from * here.length(), end]);
                    from = 0.0;
                }
            }
        }
        self.line(format_args!("\"/>"));
    }

    /// A rounded box with a window behind its front.
    fn body(&mut self, pose: &Pose, [length, width]: [f64; 2], colour: Colour) {
        let (x, y) = (pose.position.x, pose.position.y);
        let (left, bottom) = (-0.5 * length, -0.5 * width);
        let degrees = pose.heading.to_degrees();
        self.line(format_args!("<g transform=\"translate({x:.3} {y:.3}) rotate({degrees:.3})\">"));
        let round = 0.25 * width;
        self.line(format_args!(
            "<rect x=\"{left:.3}\" y=\"{bottom:.3}\" width=\"{length:.3}\" height=\"{width:.3}\" rx=\"{round:.3}\" \
             fill=\"{}\" stroke=\"#ffffff\" stroke-width=\"0.12\"/>",
            hex(colour)
        ));
        self.line(format_args!(
            "<rect x=\"{:.3}\" y=\"{:.3}\" width=\"{:.3}\" height=\"{:.3}\" rx=\"{:.3}\" fill=\"#ffffff\" \
             fill-opacity=\"0.55\"/>",
            0.12 * length,
            0.8 * bottom,
            0.14 * length,
            0.8 * width,
            0.3 * round
        ));
        self.line(format_args!("</g>"));
    }

    /// A bar of a round number of metres, a hundred pixels or somewhat more long.
    fn scale(&mut self, scale: f64, y: f64) {
        let wanted = 100.0 / scale;
        let tens = [1.0, 10.0, 100.0, 1000.0, 10_000.0].into_iter();
        let metres =
            tens.flat_map(|ten| [ten, 2.0 * ten, 5.0 * ten]).find(|metres| *metres >= wanted).unwrap_or(wanted);
        let (from, to) = (MARGIN, MARGIN + metres * scale);
        self.line(format_args!(
            "<path fill=\"none\" stroke=\"{INK}\" stroke-width=\"1.5\" d=\"M{from} {:.1}V{:.1}H{to:.1}V{:.1}\"/>",
            y - 5.0,
            y,
            y - 5.0
        ));
        self.line(format_args!(
            "<text x=\"{:.1}\" y=\"{:.1}\" font-family=\"Open Sans, sans-serif\" font-size=\"14\" \
             fill=\"{INK}\">{metres} m</text>",
            to + 8.0,
            y + 1.0
        ));
    }
}

/// How far aside a lane change is at shares of its way: it begins and ends straight.
fn sideways() -> impl Iterator<Item = (f64, f64)> {
    (1..=16).map(|i| f64::from(i) / 16.0).map(|share| (share, share * share * (3.0 - 2.0 * share)))
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}
