//! Facts about lanes that traffic needs at every tick, computed once for each network.

use crate::road::{Lane, LaneId, LaneKind, RoadNetwork};
use std::ops::Range;
use std::sync::Arc;

/// The comfortable lateral acceleration in bends, in m/s².
pub(super) const LATERAL: f64 = 2.5;
/// The share of a lane's width that the middles of two lanes are apart when the lanes count as parted.
const APART: f64 = 0.75;
/// The distance in metres between the places at which parting lanes are examined.
const STEP: f64 = 0.25;
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

#[derive(Debug)]
struct Facts {
    length: f64,
    /// The comfortable speed in m/s.
    speed: f64,
    /// The place where cars wait, in metres along the lane; negative if it lies before the beginning of the lane.
    line: f64,
    road: bool,
    through: bool,
    rivals: Range<u32>,
    forks: Range<u32>,
}

/// A network, with the facts that traffic needs.
#[derive(Debug)]
pub(super) struct Map {
    pub network: Arc<RoadNetwork>,
    lanes: Vec<Facts>,
    rivals: Vec<Rival>,
    forks: Vec<Fork>,
}

impl Map {
    pub fn new(network: Arc<RoadNetwork>) -> Self {
        let (mut lanes, mut rivals, mut forks) = (Vec::with_capacity(network.lanes().len()), Vec::new(), Vec::new());
        for (id, lane) in network.ids().zip(network.lanes()) {
            let first = (rivals.len() as u32, forks.len() as u32);
            rivals.extend(lane.conflicts.iter().map(|conflict| {
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
            }));
            for before in &lane.predecessors {
                for other in network.lane(*before).successors.iter().filter(|other| **other != id) {
                    if forks[first.1 as usize..].iter().all(|fork: &Fork| fork.lane != *other) {
                        let apart = (parted(&network, id, *other), parted(&network, *other, id));
                        forks.push(Fork { lane: *other, apart });
                    }
                }
            }
            let at_its_beginning = matches!(lane.kind, LaneKind::Straight | LaneKind::Left | LaneKind::Right);
            let zone = rivals[first.0 as usize..].iter().map(|rival| rival.from).fold(f64::INFINITY, f64::min);
            let road = lane.kind == LaneKind::Road;
            let wide = |lane: &Lane| lane.beside().next().is_some();
            let from_wide = lane.predecessors.iter().any(|before| wide(network.lane(*before)));
            lanes.push(Facts {
                length: lane.length(),
                speed: (LATERAL / lane.curve.curvature().abs()).sqrt(),
                line: if at_its_beginning { -BEFORE_LINE } else { zone - BEFORE_ZONE },
                road,
                through: !road && (wide(lane) || from_wide),
                rivals: first.0..rivals.len() as u32,
                forks: first.1..forks.len() as u32,
            });
        }
        Self { network, lanes, rivals, forks }
    }

    pub fn length(&self, lane: LaneId) -> f64 {
        self.lanes[lane.index()].length
    }

    /// Returns the comfortable speed on a lane in m/s; infinite on a straight lane.
    pub fn speed(&self, lane: LaneId) -> f64 {
        self.lanes[lane.index()].speed
    }

    /// Returns the place where cars wait before they enter a conflict with another lane, in metres along the lane.
    pub fn line(&self, lane: LaneId) -> f64 {
        self.lanes[lane.index()].line
    }

    /// Returns `true` if the lane runs along a road.
    pub fn is_road(&self, lane: LaneId) -> bool {
        self.lanes[lane.index()].road
    }

    /// Returns `true` if cars do not stop between the previous lane and this lane, as in a wide roundabout.
    pub fn is_through(&self, lane: LaneId) -> bool {
        self.lanes[lane.index()].through
    }

    pub fn rivals(&self, lane: LaneId) -> &[Rival] {
        let range = &self.lanes[lane.index()].rivals;
        &self.rivals[range.start as usize..range.end as usize]
    }

    pub fn forks(&self, lane: LaneId) -> &[Fork] {
        let range = &self.lanes[lane.index()].forks;
        &self.forks[range.start as usize..range.end as usize]
    }

    /// Returns `true` if two lanes run side by side.
    pub fn beside(&self, lane: LaneId, other: LaneId) -> bool {
        self.network.lane(lane).beside().any(|beside| beside == other)
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
    let apart = |s: &f64| {
        let point = lane.curve.point(*s);
        (other.curve.point(other.curve.nearest(point)) - point).norm() >= APART * lane.width
    };
    (0..=steps).map(place).find(apart).unwrap_or(lane.length())
}
