//! A picture of a road network from above, with ways and bodies on it.

use super::body::{body, class_colour};
use super::drawing::{Colour, Contour, Drawing, Paint, PathSegment};
use super::ground::{ground, lanes};
use super::legend::scale_bar;
use super::view::View;
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, Class};
use paracosm_engine::road::{Bounds, RoadNetwork, Route};

/// The width or height of a picture in pixels, whichever is greater, without its margins.
const SIZE: f64 = 1200.0;
/// The largest scale in pixels per metre, for small networks.
const LARGEST_SCALE: f64 = 16.0;
/// The margin around the network in pixels, and the further margin below it for the scale bar.
const MARGIN: f64 = 28.0;
const FOOT: f64 = 34.0;
/// The accuracy in metres of the edges of the picture.
const FAITHFUL: f64 = 0.1;

/// A bird's-eye picture of a road network, with routes and bodies.
#[derive(Debug, Clone)]
pub struct RoadPicture<'a> {
    network: &'a RoadNetwork,
    lanes: bool,
    routes: Vec<(Route, Colour)>,
    bodies: Vec<(Pose, Body, Colour)>,
}

impl<'a> RoadPicture<'a> {
    /// Makes a bird's-eye picture of a road network without routes and bodies.
    pub fn of(network: &'a RoadNetwork) -> Self {
        Self { network, lanes: false, routes: Vec::new(), bodies: Vec::new() }
    }

    /// Adds the middle line of every lane to the picture, with an arrow.
    pub fn lanes(mut self) -> Self {
        self.lanes = true;
        self
    }

    /// Adds a route to the picture, as a line of the given colour.
    pub fn route(mut self, route: &Route, colour: Colour) -> Self {
        self.routes.push((route.clone(), colour));
        self
    }

    /// Adds a vehicle with a length and a width in metres to the picture, with its front marked.
    pub fn body(mut self, pose: Pose, length: f64, width: f64, colour: Colour) -> Self {
        self.bodies.push((pose, Body::block(Class::Car, length, width, 1.0), colour));
        self
    }

    /// Adds a thing to the picture, in the colour of its class.
    pub fn thing(mut self, body: Body, pose: Pose) -> Self {
        self.bodies.push((pose, body, class_colour(body.class)));
        self
    }

    /// Returns the picture as the text of an SVG file.
    pub fn svg(&self) -> String {
        self.drawing().svg()
    }

    /// Returns the picture.
    pub fn drawing(&self) -> Drawing {
        let strips = self.network.strips();
        let sides = strips.iter().map(|strip| strip.sides(FAITHFUL));
        let bounds = Bounds::around(sides.flat_map(|(right, left)| right.into_iter().chain(left)));
        let scale = (SIZE / (bounds.max - bounds.min).max()).min(LARGEST_SCALE);
        let mut bounds = bounds.grown(MARGIN / scale);
        bounds.min.y -= FOOT / scale;
        let view = View { bounds, scale };
        let [width, height] = view.size();
        let mut marks = ground(&view, self.network);
        if self.lanes {
            marks.extend(lanes(&view, self.network));
        }
        for (way, colour) in &self.routes {
            let paint = Paint { colour: *colour, opacity: 0.85 };
            marks.push(route(&view, self.network, way).stroke(paint, 1.3 * scale));
        }
        for (pose, of, colour) in &self.bodies {
            marks.extend(body(&view, of, pose, *colour, 1.0));
        }
        scale_bar(&mut marks, [MARGIN, height - 0.5 * (MARGIN + FOOT)], scale);
        Drawing { width, height, marks }
    }
}

/// Draws a route along the middles of its lanes. A change to a lane beside takes half of what is left of both lanes.
fn route(view: &View, network: &RoadNetwork, route: &Route) -> Contour {
    let curve = |index: usize| &network.lane(route.lanes[index]).curve;
    let mut from = route.start / curve(0).length();
    let mut contour = Contour { segments: vec![PathSegment::Move(view.at(curve(0).point(route.start)))] };
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
                    contour.segments.push(PathSegment::Line(view.at(a + (b - a) * aside)));
                }
                from = to;
            }
            next => {
                let end = if next.is_some() { here.length() } else { route.end };
                for piece in here.pieces(from * here.length(), end) {
                    view.along(&mut contour, &piece, 0.0, [0.0, piece.length()]);
                }
                from = 0.0;
            }
        }
    }
    contour
}

/// Returns points of a lane change that is straight at both ends, each with its share of the length and of the lateral
/// movement.
fn sideways() -> impl Iterator<Item = (f64, f64)> {
    (1..=16).map(|i| f64::from(i) / 16.0).map(|share| (share, share * share * (3.0 - 2.0 * share)))
}
