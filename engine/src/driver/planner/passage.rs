//! The passages on the way of the car: the stretches on which it is in conflict with other lanes, from the map.

use crate::observation::Navigation;
use crate::road::{LaneId, RoadNetwork};
use paracosm_road::Pose;

/// The metres for which lanes are followed back from a conflict: some 6 s at 50 km/h.
const LOOKS_BACK: f64 = 90.0;

/// A conflict of the car's way with another lane; `from` and `to` are places in metres along the way.
#[derive(Debug)]
pub(super) struct Conflict {
    pub from: f64,
    pub to: f64,
    pub gives_way: bool,
    /// The stretch of the other lane that is in conflict, in metres along that lane.
    pub theirs: (f64, f64),
    /// The ends of both lanes, on the way and on the other lane, if they lead to the same lane.
    pub joins: Option<(f64, f64)>,
    /// The other lane and the lanes that lead to it, each with the metres from its beginning to that of the other lane.
    lanes: Vec<(LaneId, f64)>,
}

/// Conflicts that the car passes without a stop.
#[derive(Debug)]
pub(super) struct Passage {
    pub conflicts: Vec<Conflict>,
    /// The places in metres along the way at which the passage begins and ends.
    pub from: f64,
    pub to: f64,
    /// The comfortable speed in m/s.
    pub speed: f64,
}

impl Conflict {
    /// Returns the place of a body in metres along the other lane, negative on the lanes that lead to it; `None`
    /// elsewhere.
    pub fn place(&self, body: &Pose, network: &RoadNetwork) -> Option<f64> {
        self.lanes.iter().find_map(|(lane, before)| Some(network.place_on_lane(*lane, body)? - before))
    }
}

/// Finds the passages on a way, in order. Conflicts with less than `room` metres between them belong to the same
/// passage. `lateral` is the comfortable lateral acceleration in m/s².
pub(super) fn passages(navigation: &Navigation, room: f64, lateral: f64) -> Vec<Passage> {
    let Navigation { network, way, .. } = navigation;
    let mut conflicts = Vec::new();
    for (begin, id) in way.lane_pieces() {
        let lane = network.lane(id);
        // The way may begin in the middle of its first lane.
        let offset = begin - network.project_onto(id, way.at(begin).position).s;
        for conflict in &lane.conflicts {
            let there = network.lane(conflict.with);
            let Some(theirs) = there.conflicts.iter().find(|theirs| theirs.with == id) else { continue };
            let joins = lane.successors.iter().any(|next| there.successors.contains(next));
            conflicts.push(Conflict {
                from: offset + conflict.from,
                to: offset + conflict.to,
                gives_way: conflict.gives_way,
                theirs: (theirs.from, theirs.to),
                joins: joins.then(|| (offset + lane.length(), there.length())),
                lanes: leading_to(network, conflict.with, theirs.from),
            });
        }
    }
    conflicts.sort_by(|a, b| a.from.total_cmp(&b.from));
    let mut passages: Vec<Passage> = Vec::new();
    for conflict in conflicts {
        match passages.last_mut().filter(|last| conflict.from < last.to + room) {
            Some(last) => {
                last.to = last.to.max(conflict.to);
                last.conflicts.push(conflict);
            }
            None => {
                let (from, to) = (conflict.from, conflict.to);
                passages.push(Passage { conflicts: vec![conflict], from, to, speed: f64::INFINITY });
            }
        }
    }
    for passage in &mut passages {
        let metres = (passage.to - passage.from).ceil() as usize;
        let curvatures = (0..=metres).map(|i| way.curvature(passage.from + i as f64).abs());
        passage.speed = (lateral / curvatures.fold(0.0, f64::max)).sqrt();
    }
    passages
}

/// Returns a lane and the lanes that lead to it, each with the metres from its beginning to the beginning of the lane.
/// `from` is the place on the lane that the search looks back from.
fn leading_to(network: &RoadNetwork, lane: LaneId, from: f64) -> Vec<(LaneId, f64)> {
    let mut lanes = vec![(lane, 0.0)];
    let mut next = 0;
    while let Some(&(lane, before)) = lanes.get(next) {
        next += 1;
        if before + from < LOOKS_BACK {
            for &earlier in &network.lane(lane).predecessors {
                if lanes.iter().all(|(known, _)| *known != earlier) {
                    lanes.push((earlier, before + network.lane(earlier).length()));
                }
            }
        }
    }
    lanes
}
