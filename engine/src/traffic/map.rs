//! Facts about lanes that traffic needs at every tick, computed once for each network.

use crate::road::{Lane, LaneId, LaneKind, RoadNetwork, SpeedLimit};
use std::sync::Arc;

/// The comfortable lateral acceleration in bends, in m/s².
pub(super) const LATERAL: f64 = 2.5;
/// The share of a lane's width that the middles of two lanes are apart when the lanes count as parted.
const APART: f64 = 0.75;
/// The distance in metres between the places at which parting lanes are examined.
const STEP: f64 = 0.25;
/// A distance in metres far above all rounding.
const ROUNDING: f64 = 1e-6;
/// The metres before the lane of an intersection, and before a zone in a roundabout, where cars wait.
const BEFORE_LINE: f64 = 0.5;
pub(super) const BEFORE_ZONE: f64 = 1.0;

/// The zone in which a lane conflicts with another lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rival {
    pub lane: LaneId,
    /// The place on this lane in metres beyond which a car blocks the other lane.
    pub from: f64,
    /// The beginning and the end of the zone of the other lane in which a car blocks this lane, in metres.
    pub other: (f64, f64),
    /// `true` if this lane gives way to the other lane. `given_way` is `true` if the other lane gives way to this lane.
    pub gives_way: bool,
    pub given_way: bool,
    /// `true` if both lanes lead to the same lane.
    pub merges: bool,
}

/// A lane that begins at the same place as this lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fork {
    pub lane: LaneId,
    /// The places in metres along this lane and along the other lane up to which the lanes are too close.
    pub apart: (f64, f64),
}

/// The facts about a lane.
#[derive(Debug)]
pub(super) struct Facts {
    /// The length of the lane in metres.
    pub length: f64,
    /// The comfortable speed in m/s; infinite on a straight lane.
    pub speed: f64,
    /// The place where cars wait before they enter a conflict with another lane, in metres along the lane; negative if
    /// it lies before the beginning of the lane.
    pub line: f64,
    /// The stretches with a speed limit.
    pub limits: Box<[SpeedLimit]>,
    pub rivals: Box<[Rival]>,
    pub forks: Box<[Fork]>,
    beside: [Option<LaneId>; 2],
    pub kind: LaneKind,
    /// `true` if cars do not stop between the previous lane and this lane, as in a wide roundabout.
    pub through: bool,
}

/// A network, with the facts that traffic needs.
#[derive(Debug)]
pub(super) struct Map {
    pub network: Arc<RoadNetwork>,
    lanes: Vec<Facts>,
}

impl Facts {
    /// Returns `true` if another lane runs beside this lane.
    pub fn is_beside(&self, other: LaneId) -> bool {
        self.beside.contains(&Some(other))
    }
}

impl Map {
    pub fn new(network: Arc<RoadNetwork>) -> Self {
        let mut lanes = Vec::with_capacity(network.lanes().len());
        for (id, lane) in network.ids().zip(network.lanes()) {
            let rivals = lane.conflicts.iter().map(|conflict| {
                let other = network.lane(conflict.with);
                let back = other.conflicts.iter().find(|back| back.with == id);
                let back = back.expect("two lanes are in each other's way");
                Rival {
                    lane: conflict.with,
                    from: conflict.from,
                    other: (back.from, back.to),
                    gives_way: conflict.gives_way,
                    given_way: back.gives_way,
                    merges: lane.successors.iter().any(|next| other.successors.contains(next)),
                }
            });
            let rivals: Box<[Rival]> = rivals.collect();
            let mut forks: Vec<Fork> = Vec::new();
            for before in &lane.predecessors {
                for other in network.lane(*before).successors.iter().filter(|other| **other != id) {
                    if forks.iter().all(|fork| fork.lane != *other) {
                        let apart = (parted(&network, id, *other), parted(&network, *other, id));
                        forks.push(Fork { lane: *other, apart });
                    }
                }
            }
            let at_its_beginning = matches!(lane.kind, LaneKind::Straight | LaneKind::Left | LaneKind::Right);
            let zone = rivals.iter().map(|rival| rival.from).fold(f64::INFINITY, f64::min);
            let road = lane.kind == LaneKind::Road;
            let wide = |lane: &Lane| lane.beside().next().is_some();
            let from_wide = lane.predecessors.iter().any(|before| wide(network.lane(*before)));
            lanes.push(Facts {
                length: lane.length(),
                speed: (LATERAL / lane.curve.greatest_curvature()).sqrt(),
                line: if at_its_beginning { -BEFORE_LINE } else { zone - BEFORE_ZONE },
                limits: lane.limits.as_slice().into(),
                rivals,
                forks: forks.into(),
                beside: [lane.left, lane.right],
                kind: lane.kind,
                through: !road && (wide(lane) || from_wide),
            });
        }
        Self { network, lanes }
    }

    pub fn lane(&self, lane: LaneId) -> &Facts {
        &self.lanes[lane.index()]
    }

    pub fn length(&self, lane: LaneId) -> f64 {
        self.lane(lane).length
    }

    /// Returns `true` if the lane runs along a road.
    pub fn is_road(&self, lane: LaneId) -> bool {
        self.lane(lane).kind == LaneKind::Road
    }

    /// Returns `true` if two lanes run side by side.
    pub fn beside(&self, lane: LaneId, other: LaneId) -> bool {
        self.lane(lane).is_beside(other)
    }

    /// Returns the only successor of this lane if the successor runs along a road; otherwise `None`.
    pub fn road_after(&self, lane: LaneId) -> Option<LaneId> {
        self.only_road(&self.network.lane(lane).successors)
    }

    /// Returns the only predecessor of this lane if the predecessor runs along a road; otherwise `None`.
    pub fn road_before(&self, lane: LaneId) -> Option<LaneId> {
        self.only_road(&self.network.lane(lane).predecessors)
    }

    fn only_road(&self, lanes: &[LaneId]) -> Option<LaneId> {
        match lanes {
            [only] if self.is_road(*only) => Some(*only),
            _ => None,
        }
    }

    /// Converts a place on a lane to the corresponding place on a neighbouring lane.
    pub fn across(&self, s: f64, from: LaneId, to: LaneId) -> f64 {
        s * self.length(to) / self.length(from)
    }
}

/// Returns the distance in metres along a lane over which the lane `other` from the same place is too close.
fn parted(network: &RoadNetwork, lane: LaneId, other: LaneId) -> f64 {
    let (lane, other) = (network.lane(lane), network.lane(other));
    let steps = (lane.length() / STEP).ceil() as usize;
    let place = |i: usize| lane.length() * i as f64 / steps as f64;
    let mut i = 0;
    while i <= steps {
        let point = lane.curve.point(place(i));
        let missing = APART * lane.width - (other.curve.point(other.curve.nearest(point)) - point).norm();
        if missing <= 0.0 {
            return place(i);
        }
        // Within the missing metres along the lane, the lanes cannot part. The lane's places are at most STEP apart.
        i += (((missing - ROUNDING) / STEP) as usize).max(1);
    }
    lane.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::road::{Composite, Roundabout, grid_city};

    #[test]
    fn lanes_part_at_the_first_place_of_the_grid_that_is_far_enough_away() {
        let roundabout: Composite = Roundabout::new().lanes(2).arms(5).into();
        for network in [grid_city(2, 2, 60.0, 2), roundabout].map(|city| city.build().unwrap()) {
            let map = Map::new(network.clone());
            for (id, lane) in network.ids().zip(network.lanes()) {
                for fork in &map.lane(id).forks {
                    let other = network.lane(fork.lane);
                    let steps = (lane.length() / STEP).ceil() as usize;
                    let mut places = (0..=steps).map(|i| lane.length() * i as f64 / steps as f64);
                    let parted = places.find(|s| {
                        let point = lane.curve.point(*s);
                        (other.curve.point(other.curve.nearest(point)) - point).norm() >= APART * lane.width
                    });
                    assert_eq!(fork.apart.0, parted.unwrap_or(lane.length()));
                }
            }
        }
    }
}
