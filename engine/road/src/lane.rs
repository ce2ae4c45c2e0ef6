//! The lanes of a network, with their neighbours: the lanes before, behind, beside and across each lane.

use super::centreline::Centreline;

/// The identifier of a lane, which is the lane's index in [`RoadNetwork::lanes`](super::RoadNetwork::lanes).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LaneId(pub(super) u32);

impl LaneId {
    #[inline]
    pub(super) fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// Returns the index of the lane in [`RoadNetwork::lanes`](super::RoadNetwork::lanes).
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The kind of a lane, by the part of the road network to which the lane belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LaneKind {
    /// A lane along a straight or curved road.
    Road,
    /// A lane that leads straight on over an intersection.
    Straight,
    /// A lane that turns left at an intersection.
    Left,
    /// A lane that turns right at an intersection.
    Right,
    /// A lane that leads from an arm into a roundabout.
    Entry,
    /// A lane that leads out of a roundabout into an arm.
    Exit,
    /// A lane around a roundabout, from an entry to the next exit.
    Ring,
    /// A lane around a roundabout past an arm, from the exit to the entry of the arm.
    RingAtArm,
}

/// A conflict between two lanes that cross or join in an intersection, so that cars on the lanes can touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneConflict {
    /// The lane with which this lane is in conflict.
    pub with: LaneId,
    /// The beginning of the stretch of this lane that is too close to the other lane, in metres along this lane.
    pub from: f64,
    /// The end of the stretch of this lane that is too close to the other lane, in metres along this lane.
    pub to: f64,
    /// `true` if a car on this lane lets cars on the other lane go first. At a T a car from the stem gives way, at a
    /// roundabout a car that enters, or leaves from an inner lane. Elsewhere a car that turns left gives way to cars
    /// that come towards it, and every car gives way to cars from the right. Where four roads cross, each of four cars
    /// can have another car at its right.
    pub gives_way: bool,
}

/// A stretch of a lane on which a speed limit holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLimit {
    /// The beginning of the stretch, in metres along the lane.
    pub from: f64,
    /// The end of the stretch, in metres along the lane.
    pub to: f64,
    /// The greatest speed that is allowed, in m/s.
    pub speed: f64,
}

/// A lane of a road or an intersection, as a path in the direction of its traffic.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// The index of the lane's element in [`RoadNetwork::elements`](super::RoadNetwork::elements).
    pub element: usize,
    /// The kind of the lane, for example a lane that turns left at an intersection.
    pub kind: LaneKind,
    /// The number of the lane among the parallel lanes. On a road, lanes 1, 2, ... lie right of the centre line, lanes
    /// -1, -2, ... left; in an intersection, it is the number of the joined lanes; in a roundabout, 1 is innermost.
    pub number: i32,
    /// The line along the middle of the lane.
    pub curve: Centreline,
    /// The width of the lane in metres; in the middle of its length, if the width changes.
    pub width: f64,
    /// The widths along the lane if the width changes: places in metres along the lane, each with the width there, between
    /// which the width changes evenly. Empty if the width is the same everywhere.
    pub widths: Vec<[f64; 2]>,
    /// The next lane to the left in the same direction; `None` if cars may not change to the left.
    pub left: Option<LaneId>,
    /// The next lane to the right in the same direction; `None` if cars may not change to the right.
    pub right: Option<LaneId>,
    /// The lanes that begin at the end of this lane.
    pub successors: Vec<LaneId>,
    /// The lanes that end at the beginning of this lane.
    pub predecessors: Vec<LaneId>,
    /// The conflicts with lanes of the same intersection that cross or join this lane.
    pub conflicts: Vec<LaneConflict>,
    /// The stretches with a speed limit, in the order of their places. Stretches without a known limit are left out.
    pub limits: Vec<SpeedLimit>,
}

impl Lane {
    /// Returns the length of the lane in metres.
    #[inline]
    pub fn length(&self) -> f64 {
        self.curve.length()
    }

    /// Returns the width in metres at a place in metres along the lane.
    pub fn width_at(&self, s: f64) -> f64 {
        let next = self.widths.partition_point(|[place, _]| *place <= s);
        match [next.checked_sub(1), Some(next)].map(|index| self.widths.get(index?)) {
            [None, None] => self.width,
            [Some([_, width]), None] | [None, Some([_, width])] => *width,
            [Some([from, a]), Some([to, b])] => a + (b - a) * (s - from) / (to - from),
        }
    }

    /// Returns the speed limit in m/s at a place in metres along the lane; `None` if no limit is known there.
    pub fn limit_at(&self, s: f64) -> Option<f64> {
        let next = self.limits.partition_point(|limit| limit.from <= s);
        let limit = self.limits.get(next.checked_sub(1)?)?;
        (s <= limit.to).then_some(limit.speed)
    }

    /// Returns the next lane to the left and the next lane to the right, if cars may change to these lanes.
    #[inline]
    pub fn beside(&self) -> impl Iterator<Item = LaneId> {
        self.left.into_iter().chain(self.right)
    }
}
