//! The place on a map of a position in the world.

use super::place::Place;
use crate::opendrive::{End, Map, Road};
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::road::wrapped;

/// The distance in metres between the places along a road at which the search begins.
const SPACING: f64 = 5.0;
/// The greatest number of steps of Newton's method.
const STEPS: usize = 20;
/// The greatest distance in metres from a place on a road of a position on the road. Files give positions to a millimetre.
const ON: f64 = 1e-3;
/// The greatest distance in metres from a place on a road of a position in a gap of the road: between pieces of the reference line that
/// do not quite meet, or between two roads.
const IN_GAP: f64 = 0.1;

/// Returns the place of a pose on the nearest road whose lanes are under the pose; `None` if there is none. A position beyond an end
/// where no road goes on is on no road.
pub(super) fn project(pose: &Pose, map: &Map) -> Option<Place> {
    let on_road = |(index, road): (usize, &Road)| {
        let s = nearest(road, pose.position);
        let here = road.line.at(s);
        let t = here.to_local(pose.position).y;
        let away = (road.point(s, t) - pose.position).norm();
        let section = road.section_at(s);
        let outer = |lane: Option<&crate::opendrive::Lane>| road.border(section, lane.map_or(0, |lane| lane.number), s);
        let lanes = &road.sections[section].lanes;
        let (left, right) = (outer(lanes.first())?, outer(lanes.last())?);
        let beside = (t - left).max(right - t).max(0.0);
        let ends = s <= 0.0 && road.link(End::Start).is_none() || s >= road.length && road.link(End::End).is_none();
        let is_on = away <= ON;
        let most = if ends { ON } else { IN_GAP };
        (away <= most && beside <= 0.0).then_some((!is_on, t.abs(), index, s, t))
    };
    let found = map.roads.iter().enumerate().filter_map(on_road);
    let found = found.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let (_, _, road, s, t) = found?;
    let mut place = Place { road, s, lane: 0, offset: 0.0, turn: 0.0 };
    place.offset = t - place.t(map);
    let lane = place.lane_below(map);
    place.enter(lane, map);
    place.turn = wrapped(pose.heading - place.pose(map).heading);
    Some(place)
}

/// Returns the place along the reference line of a road that is nearest to a position.
fn nearest(road: &Road, position: Vector2<f64>) -> f64 {
    let count = (road.length / SPACING).ceil().max(1.0) as usize;
    let places = (0..=count).map(|i| road.length * i as f64 / count as f64);
    let distance = |s: &f64| (road.line.at(*s).position - position).norm_squared();
    let mut s = places.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0.0);
    for _ in 0..STEPS {
        let local = road.line.at(s).to_local(position);
        let rate = road.line.rate(s) * (1.0 - road.line.curvature(s) * local.y).max(0.1);
        let next = (s + local.x / rate).clamp(0.0, road.length);
        if (next - s).abs() < 1e-9 {
            break;
        }
        s = next;
    }
    s
}
