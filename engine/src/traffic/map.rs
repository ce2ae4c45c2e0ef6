//! What traffic asks about lanes at every tick, found once for a network.

use crate::road::{Lane, LaneId, LaneKind, RoadNetwork};
use std::ops::Range;
use std::sync::Arc;

/// Comfortable lateral acceleration in bends, in m/s².
pub(super) const LATERAL: f64 = 2.5;
/// Lanes that part from one another have done so where their middles are this share of a lane's width apart.
const APART: f64 = 0.75;
/// Metres between the places at which lanes that part are looked at.
const STEP: f64 = 0.25;
/// Metres before the lane of an intersection, and before a zone in a roundabout, where one waits.
const BEFORE_LINE: f64 = 0.5;
pub(super) const BEFORE_ZONE: f64 = 1.0;

/// A zone of a lane that it shares with another lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rival {
    pub lane: LaneId,
    /// From where on along this lane one is in the way of the other.
    pub from: f64,
    /// From where to where along the other lane it is in the way of this one.
    pub other: (f64, f64),
    /// Whether this lane gives way to the other, and the other to this one.
    pub gives_way: bool,
    pub given_way: bool,
    /// Whether both lead to the same lane.
    pub merges: bool,
}

/// A lane that begins where this one does.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fork {
    pub lane: LaneId,
    /// Up to where along this lane and along the other one they are too close.
    pub apart: (f64, f64),
}

#[derive(Debug)]
struct Facts {
    length: f64,
    /// The comfortable speed in m/s.
    speed: f64,
    /// Where one waits: metres along the lane, perhaps before its beginning.
    line: f64,
    road: bool,
    through: bool,
    rivals: Range<u32>,
    forks: Range<u32>,
}

/// A network as traffic sees it.
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

    /// The comfortable speed on a lane: infinite where it is straight.
    pub fn speed(&self, lane: LaneId) -> f64 {
        self.lanes[lane.index()].speed
    }

    /// Where one waits before a lane that has rivals.
    pub fn line(&self, lane: LaneId) -> f64 {
        self.lanes[lane.index()].line
    }

    /// Whether it runs along a road.
    pub fn is_road(&self, lane: LaneId) -> bool {
        self.lanes[lane.index()].road
    }

    /// Whether one does not stop between the lane before it and this one: within a roundabout with several lanes.
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

    /// Whether two lanes run side by side.
    pub fn beside(&self, lane: LaneId, other: LaneId) -> bool {
        self.network.lane(lane).beside().any(|beside| beside == other)
    }

    /// The lane that a road goes on with where this lane ends, if it leads nowhere else.
    pub fn road_after(&self, lane: LaneId) -> Option<LaneId> {
        self.only_road(&self.network.lane(lane).successors)
    }

    /// The lane of a road that leads to this one, if no other does.
    pub fn road_before(&self, lane: LaneId) -> Option<LaneId> {
        self.only_road(&self.network.lane(lane).predecessors)
    }

    fn only_road(&self, lanes: &[LaneId]) -> Option<LaneId> {
        match lanes {
            [only] if self.is_road(*only) => Some(*only),
            _ => None,
        }
    }

    /// A place on a lane as one beside it has it.
    pub fn across(&self, s: f64, from: LaneId, to: LaneId) -> f64 {
        s * self.length(to) / self.length(from)
    }
}

/// How far along a lane the lane `other`, which begins where it does, is too close.
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
