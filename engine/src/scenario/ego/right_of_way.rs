//! Finds the time until a road user with the right of way reaches the car's place in an intersection.

use super::Ego;
use crate::object::BodyState;
use crate::road::{LaneId, RoadNetwork};

/// Returns the seconds until the first road user with the right of way comes to the car's place in an intersection;
/// infinite if none comes, 0 if one is there already.
///
/// The places are the [conflicts](crate::road::LaneConflict) of the car's lanes in which the car gives way. Other road
/// users count if they are on the conflict's lane or on a lane that leads to it, and have not passed the conflict yet.
pub(super) fn of(ego: &Ego, bodies: &[BodyState], network: &RoadNetwork) -> f64 {
    let (car, others) = (&bodies[0], &bodies[1..]);
    let half = car.body.outline.half_extent().x;
    let mut least = f64::INFINITY;
    for (lane, s) in ego.lanes(network) {
        let here = network.lane(lane);
        let within = here.conflicts.iter().filter(|c| c.gives_way && s + half > c.from && s - half < c.to);
        for conflict in within {
            let there = network.lane(conflict.with);
            // The stretch of the other lane is the conflict as seen from that lane.
            let Some(theirs) = there.conflicts.iter().find(|theirs| theirs.with == lane) else { continue };
            let joins = here.successors.iter().any(|next| there.successors.contains(next));
            for other in others.iter().filter(|other| other.present) {
                let reach = other.body.outline.half_extent().x;
                let Some(s_other) = along(other, conflict.with, network) else { continue };
                let ahead = joins && there.length() - (s_other - reach) <= here.length() - (s + half);
                if ahead || s_other - reach >= theirs.to {
                    continue;
                }
                let way = (theirs.from - s_other - reach).max(0.0);
                least = least.min(if way == 0.0 { 0.0 } else { way / other.velocity.norm() });
            }
        }
    }
    least
}

/// Returns the metres of a body along a lane; negative on a lane that leads to the given lane, `None` elsewhere.
fn along(other: &BodyState, lane: LaneId, network: &RoadNetwork) -> Option<f64> {
    let on = |lane: LaneId| network.place_on_lane(lane, &other.pose);
    let before = || {
        let predecessors = network.lane(lane).predecessors.iter();
        predecessors.filter_map(|&before| Some(on(before)? - network.lane(before).length())).next()
    };
    on(lane).or_else(before)
}
