//! The markings that the look `textured` adds to a road: lines along kerbs, and arrows before intersections.

use nalgebra::Vector2;
use paracosm_engine::road::{Lane, LaneId, LaneKind, RoadNetwork, Strip, Surface};

/// The distances from the kerb of the sides of an edge line, in metres.
const EDGE: [f64; 2] = [0.25, 0.37];
/// The greatest curvature in 1/m of a kerb that has an edge line; kerbs around corners have none.
const STRAIGHT: f64 = 0.03;
/// The distances in metres from the end of a lane to the tips of its arrows.
const TIPS: [f64; 2] = [7.0, 30.0];
/// The length of an arrow in metres, and the distance that it keeps from zebra crossings.
const LENGTH: f64 = 4.0;
const FROM_ZEBRA: f64 = 5.0;

/// The parts of an arrow as convex polygons. Corners are metres before the tail of the arrow, and metres to the left,
/// counter-clockwise as seen from above.
type Shape = &'static [&'static [[f64; 2]]];

const AHEAD: Shape =
    &[&[[0.0, -0.08], [2.7, -0.08], [2.7, 0.08], [0.0, 0.08]], &[[2.7, -0.30], [4.0, 0.0], [2.7, 0.30]]];
const TO_LEFT: Shape = &[
    &[[0.0, -0.08], [1.7, -0.08], [1.7, 0.08], [0.0, 0.08]],
    &[[1.7, -0.08], [2.5, 0.32], [2.32, 0.44], [1.6, 0.08]],
    &[[1.95, 0.50], [2.75, 0.22], [2.85, 0.95]],
];
const TO_RIGHT: Shape = &[
    &[[0.0, -0.08], [1.7, -0.08], [1.7, 0.08], [0.0, 0.08]],
    &[[1.6, -0.08], [2.32, -0.44], [2.5, -0.32], [1.7, 0.08]],
    &[[2.75, -0.22], [1.95, -0.50], [2.85, -0.95]],
];

/// Returns the lines along the kerbs of a network.
pub(super) fn edge_lines(network: &RoadNetwork) -> Vec<Strip> {
    let mut strips = network.strips();
    // A road lies to the left of its kerbs. The kerbs of islands lie the other way round, or have no road beside them.
    strips.retain(|strip| {
        strip.surface == Surface::Kerb && strip.left == 0.0 && strip.curve.curvature().abs() < STRAIGHT
    });
    let line = |kerb: Strip| Strip { surface: Surface::EdgeLine, right: EDGE[0], left: EDGE[1], ..kerb };
    strips.into_iter().map(line).collect()
}

/// Returns the parts of all arrows of a network as convex polygons, counter-clockwise as seen from above.
pub(super) fn arrows(network: &RoadNetwork) -> Vec<Vec<Vector2<f64>>> {
    let of_lane = |id: LaneId| {
        let lane = network.lane(id);
        let zebras = network.crossings().iter().flat_map(|crossing| &crossing.lanes).filter(move |(on, _)| *on == id);
        let zebras: Vec<f64> = zebras.map(|(_, at)| *at).collect();
        let tails = TIPS.map(|tip| lane.length() - tip - LENGTH);
        let free = move |tail: &f64| {
            *tail > LENGTH
                && zebras.iter().all(|zebra| *zebra < tail - FROM_ZEBRA || *zebra > tail + LENGTH + FROM_ZEBRA)
        };
        let shapes = shapes(network, lane);
        tails.into_iter().filter(free).flat_map(move |tail| {
            let place = move |[along, left]: &[f64; 2]| lane.curve.beside(tail + along, *left);
            shapes.clone().into_iter().flatten().map(move |part| part.iter().map(place).collect())
        })
    };
    network.ids().flat_map(of_lane).collect()
}

/// Returns the arrows on a lane: where cars may go from its end, if the road has several lanes in the direction.
fn shapes(network: &RoadNetwork, lane: &Lane) -> Vec<Shape> {
    let several = lane.beside().next().is_some();
    let leads = |kind: LaneKind| several && lane.successors.iter().any(|next| network.lane(*next).kind == kind);
    let all = [(LaneKind::Left, TO_LEFT), (LaneKind::Straight, AHEAD), (LaneKind::Right, TO_RIGHT)];
    all.into_iter().filter(|(kind, _)| leads(*kind)).map(|(_, shape)| shape).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_engine::road::{CrossIntersection, RoadSegment};

    #[test]
    fn every_part_of_an_arrow_is_counter_clockwise() {
        for part in [AHEAD, TO_LEFT, TO_RIGHT].into_iter().flatten() {
            for i in 0..part.len() {
                let [a, b, c] = [0, 1, 2].map(|more| Vector2::from(part[(i + more) % part.len()]));
                assert!((b - a).perp(&(c - b)) > 0.0, "{part:?} at {i}");
            }
        }
    }

    #[test]
    fn arrows_lie_on_roads_of_several_lanes_before_intersections_only() {
        let alone = RoadSegment::new(200.0).lanes(4).build().expect("a sound road");
        assert!(arrows(&alone).is_empty());
        let cross = |lanes: i32| {
            let arm = |name: &str| RoadSegment::new(100.0).lanes(lanes).named(name);
            let cross = CrossIntersection::new().lanes(lanes);
            let cross = cross.connect("one", arm("east"), "one").connect("three", arm("west"), "one");
            cross.build().expect("the arms meet the crossing")
        };
        assert!(arrows(&cross(2)).is_empty());
        let found = arrows(&cross(6));
        // Two arrows or more on each of three lanes of both arms, of two parts or more.
        assert!(found.len() >= 24, "{} parts", found.len());
        // From the east, cars drive on the northern side.
        let sides = found.iter().flatten().filter(|point| point.x.abs() > 15.0);
        assert!(sides.clone().count() > 0 && sides.into_iter().all(|point| point.x * point.y > 0.0));
    }

    #[test]
    fn edge_lines_lie_within_the_kerbs_and_not_around_corners() {
        let road = RoadSegment::new(200.0).build().expect("a sound road");
        let lines = edge_lines(&road);
        assert_eq!(lines.len(), 2);
        assert!(lines.iter().all(|line| line.right > 0.0 && line.curve.length() > 199.0));
    }
}
