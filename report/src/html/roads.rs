//! The roads of a run, as polygons for a canvas.

use super::whole::{Points, centimetres};
use paracosm_engine::road::{Bounds, RoadNetwork, Surface};
use serde::Serialize;

/// The accuracy in metres of the edges of roads.
const FAITHFUL: f64 = 0.1;

/// All polygons with one surface.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize)]
pub(super) struct Ground {
    surface: &'static str,
    polygons: Vec<Points>,
}

/// Returns the surfaces of the roads near some bounds, in the order of drawing.
pub(super) fn near(network: &RoadNetwork, bounds: &Bounds) -> Vec<Ground> {
    let mut all: Vec<Ground> = Vec::new();
    for strip in network.strips() {
        let parts = strip.solid_parts().into_iter().filter(|part| {
            let aside = part.left.abs().max(part.right.abs());
            part.curve.bounds().grown(aside).meets(bounds)
        });
        let polygons: Vec<Points> =
            parts.map(|part| centimetres(part.outline(FAITHFUL).iter().map(|point| [point.x, point.y]))).collect();
        if polygons.is_empty() {
            continue;
        }
        match all.last_mut().filter(|last| last.surface == name(strip.surface)) {
            Some(last) => last.polygons.extend(polygons),
            None => all.push(Ground { surface: name(strip.surface), polygons }),
        }
    }
    all
}

fn name(surface: Surface) -> &'static str {
    match surface {
        Surface::Sidewalk => "sidewalk",
        Surface::Carriageway => "carriageway",
        Surface::Island => "island",
        Surface::Kerb => "kerb",
        Surface::CentreLine | Surface::LaneLine | Surface::EdgeLine => "line",
        Surface::StopLine | Surface::GiveWayLine | Surface::Zebra => "mark",
    }
}
