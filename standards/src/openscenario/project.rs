//! The place on a map of a position in the world.

use super::place::Place;
use crate::opendrive::{End, Lane, Map, Road};
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::road::wrapped;

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
    let on_road = |index: usize| {
        let road = &map.roads[index];
        Foot::on(index, refined(road, nearest(road, pose.position), pose.position), pose, map)
    };
    let found = (0..map.roads.len()).filter_map(on_road);
    let found = found.min_by(|a, b| a.is_off.cmp(&b.is_off).then(a.t.abs().total_cmp(&b.t.abs())));
    Some(found?.place(pose, map))
}

/// Returns the place of a pose on the road of another place nearby; `None` if no lane of this road is under the pose.
pub(super) fn project_near(pose: &Pose, near: &Place, map: &Map) -> Option<Place> {
    let s = refined(&map.roads[near.road], near.s, pose.position);
    Some(Foot::on(near.road, s, pose, map)?.place(pose, map))
}

/// The place along the reference line of a road that is nearest to a position on the road.
struct Foot {
    road: usize,
    s: f64,
    /// The distance from the reference line to the left in metres.
    t: f64,
    /// `true` if the position is in a gap of the road.
    is_off: bool,
}

impl Foot {
    /// Returns the foot at `s` of a pose; `None` if no lane of the road is under the pose.
    fn on(index: usize, s: f64, pose: &Pose, map: &Map) -> Option<Self> {
        let road = &map.roads[index];
        let t = road.line.at(s).to_local(pose.position).y;
        let away = (road.point(s, t) - pose.position).norm();
        let section = road.section_at(s);
        let outer = |lane: Option<&Lane>| road.border(section, lane.map_or(0, |lane| lane.number), s);
        let lanes = &road.sections[section].lanes;
        let (left, right) = (outer(lanes.first())?, outer(lanes.last())?);
        let beside = (t - left).max(right - t).max(0.0);
        let ends = s <= 0.0 && road.link(End::Start).is_none() || s >= road.length && road.link(End::End).is_none();
        let most = if ends { ON } else { IN_GAP };
        (away <= most && beside <= 0.0).then_some(Self { road: index, s, t, is_off: away > ON })
    }

    fn place(&self, pose: &Pose, map: &Map) -> Place {
        let mut place = Place { road: self.road, s: self.s, lane: 0, offset: 0.0, turn: 0.0 };
        place.offset = self.t - place.t(map);
        let lane = place.lane_below(map);
        place.enter(lane, map);
        place.turn = wrapped(pose.heading - place.pose(map).heading);
        place
    }
}

/// Returns a place along the reference line of a road from which Newton's method finds the nearest place to a position.
fn nearest(road: &Road, position: Vector2<f64>) -> f64 {
    let mut nearest = (f64::INFINITY, 0);
    for (i, milestone) in road.milestones.iter().enumerate() {
        let distance = (milestone - position).norm_squared();
        if distance < nearest.0 {
            nearest = (distance, i);
        }
    }
    road.length * nearest.1 as f64 / (road.milestones.len() - 1) as f64
}

/// Returns the place along the reference line of a road that is nearest to a position, by Newton's method from `s`.
fn refined(road: &Road, mut s: f64, position: Vector2<f64>) -> f64 {
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
