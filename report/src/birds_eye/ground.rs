//! Draws the ground: roads with their markings.

use super::drawing::{Colour, Contour, Paint, PathSegment, PictureItem};
use super::view::View;
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::road::{Lane, LaneKind, RoadNetwork, Strip, Surface};

/// The least width in pixels of a strip. Thinner strips are left out.
const THINNEST: f64 = 0.2;
/// The least scale, in pixels per metre, at which lanes have arrows.
const LEAST_SCALE: f64 = 2.0;
/// The distance in metres between two arrows on a lane.
const ARROWS: f64 = 40.0;

const GROUND: Colour = [0xe4, 0xea, 0xdb];
const ARROW: Paint = Paint { colour: [0xff, 0xff, 0xff], opacity: 0.3 };

/// Returns the colour in which a surface of the ground is drawn.
pub(crate) fn colour(surface: Surface) -> Colour {
    match surface {
        Surface::Sidewalk => [0xd6, 0xd2, 0xca],
        Surface::Carriageway => [0x5b, 0x5f, 0x66],
        Surface::Island => [0xb9, 0xcd, 0xa2],
        Surface::Kerb => [0xaa, 0xa5, 0x9b],
        Surface::CentreLine | Surface::LaneLine | Surface::EdgeLine => [0xe9, 0xe7, 0xdf],
        Surface::StopLine | Surface::GiveWayLine | Surface::Zebra => [0xf6, 0xf4, 0xee],
    }
}

/// Draws the ground that a view shows: all strips of a surface as one shape.
pub(super) fn ground(view: &View, network: &RoadNetwork) -> Vec<PictureItem> {
    let [width, height] = view.size();
    let mut marks = vec![Contour::rectangle([0.0, 0.0], [width, height]).fill(GROUND)];
    let mut strips = network.strips();
    // A road of many kilometres is thinner than that, and is drawn as a thin line.
    let is_road = |strip: &Strip| matches!(strip.surface, Surface::Carriageway);
    strips.retain(|strip| is_road(strip) || (strip.left - strip.right) * view.scale > THINNEST);
    for of_one in strips.chunk_by(|a, b| a.surface == b.surface) {
        let parts = of_one.iter().flat_map(Strip::solid_parts).filter(|part| {
            let aside = part.left.abs().max(part.right.abs());
            part.curve.bounds().grown(aside).meets(&view.bounds)
        });
        let mut contour = Contour::default();
        for part in parts {
            let end = part.curve.length();
            contour.segments.push(PathSegment::Move(view.at(part.curve.beside(0.0, part.right))));
            view.along(&mut contour, &part.curve, part.right, [0.0, end]);
            contour.segments.push(PathSegment::Line(view.at(part.curve.beside(end, part.left))));
            view.along(&mut contour, &part.curve, part.left, [end, 0.0]);
            contour.segments.push(PathSegment::Close);
        }
        let surface = of_one[0].surface;
        if contour.segments.is_empty() {
            continue;
        }
        // Ground is drawn half a pixel wider, so that no seam shows between elements.
        if matches!(surface, Surface::Sidewalk | Surface::Carriageway) {
            marks.push(contour.clone().stroke(colour(surface), 1.0));
        }
        marks.push(contour.fill(colour(surface)));
    }
    marks
}

/// Draws arrows on the lanes of roads, in the direction of their traffic, if they would not be too small.
pub(super) fn directions(view: &View, network: &RoadNetwork) -> PictureItem {
    let mut contour = Contour::default();
    let large = view.scale >= LEAST_SCALE;
    for lane in network.lanes().iter().filter(|lane| large && lane.kind == LaneKind::Road) {
        let count = (lane.length() / ARROWS).floor().max(1.0);
        for i in 0..count as usize {
            let here = lane.curve.at(lane.length() * (i as f64 + 0.5) / count);
            if view.shows(here.position, 3.0) {
                let corners = [(2.0, 0.0), (0.6, 0.55), (0.6, 0.15), (-2.0, 0.15)];
                let other = corners.iter().rev().map(|(x, y)| (*x, -y)).take(3);
                arrow(&mut contour, view, &here, corners.into_iter().chain(other));
            }
        }
    }
    contour.fill(ARROW)
}

/// Draws the middle of every lane with an arrow on it, in a colour for the kind of the lane.
pub(super) fn lanes(view: &View, network: &RoadNetwork) -> Vec<PictureItem> {
    let marks = network.lanes().iter().flat_map(|lane| {
        let mut head = Contour::default();
        let corners = [(0.9, 0.0), (-0.5, 0.55), (-0.5, -0.55)];
        arrow(&mut head, view, &lane.curve.at(0.5 * lane.length()), corners);
        let colour = lane_colour(lane);
        [view.line(&lane.curve).stroke(colour, 0.25 * view.scale), head.fill(colour)]
    });
    marks.collect()
}

/// Adds a polygon whose corners are given in metres ahead and to the left of a pose.
fn arrow(contour: &mut Contour, view: &View, here: &Pose, corners: impl IntoIterator<Item = (f64, f64)>) {
    let corner = |(x, y)| view.at(seen_from(here, x, y));
    contour.segments.extend(Contour::polygon(corners.into_iter().map(corner)).segments);
}

/// Returns the colour in which the middle of a lane is drawn.
fn lane_colour(lane: &Lane) -> Colour {
    match lane.kind {
        LaneKind::Road => [0x8e, 0xca, 0xe6],
        LaneKind::Straight | LaneKind::Ring | LaneKind::RingAtArm => [0xff, 0xd1, 0x66],
        LaneKind::Left | LaneKind::Entry => [0xef, 0x8a, 0x8a],
        LaneKind::Right | LaneKind::Exit => [0x9b, 0xe0, 0x8a],
    }
}

/// Returns the point of the ground that is `ahead` metres ahead of a pose and `left` metres to its left.
pub(super) fn seen_from(pose: &Pose, ahead: f64, left: f64) -> Vector2<f64> {
    pose.position + pose.forward() * ahead + pose.left() * left
}
