//! The lanes of a network, with their neighbours: the lanes before, behind, beside and across each lane.

use super::curve::Curve;

/// The identifier of a lane: its index in [`RoadNetwork::lanes`](super::RoadNetwork::lanes).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LaneId(pub(super) u32);

impl LaneId {
    pub(super) fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// Returns the index of the lane in [`RoadNetwork::lanes`](super::RoadNetwork::lanes).
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The kind of a lane: the part of the road network that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LaneKind {
    /// A lane along a straight or curved road.
    Road,
    /// A lane straight on over an intersection.
    Straight,
    /// A lane to the left at an intersection.
    Left,
    /// A lane to the right at an intersection.
    Right,
    /// A lane from an arm into a roundabout.
    Entry,
    /// A lane out of a roundabout into an arm.
    Exit,
    /// A lane around a roundabout, from an entry to the next exit.
    Ring,
    /// A lane around a roundabout, past an arm: from the exit to the entry of the arm.
    RingAtArm,
}

/// A conflict of two lanes of an intersection: the lanes cross or join, so that cars on them can touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneConflict {
    /// The other lane.
    pub with: LaneId,
    /// The place in metres along this lane from which on the other lane is too close.
    pub from: f64,
    /// The place in metres along this lane up to which the other lane is too close.
    pub to: f64,
    /// `true` if a car on this lane lets cars on the other lane go first. At a T a car from the stem gives way, at a
    /// roundabout a car that enters, or leaves from an inner lane. Elsewhere a car that turns left gives way to cars
    /// that come towards it, and every car gives way to cars from the right. Where four roads cross, each of four cars
    /// can have another car at its right.
    pub gives_way: bool,
}

/// A lane, which is the path of a car in the direction of its traffic.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// The index of the lane's element in [`RoadNetwork::elements`](super::RoadNetwork::elements).
    pub element: usize,
    /// The kind of the lane.
    pub kind: LaneKind,
    /// The number of the lane: on a road 1, 2, ... from the centre line to the right, and -1, -2, ... for the opposite
    /// direction; in an intersection that of the lanes that it joins; in a roundabout 1, 2, ... from the inside.
    pub number: i32,
    /// The middle of the lane.
    pub curve: Curve,
    /// The width of the lane in metres.
    pub width: f64,
    /// The next lane to the left in the same direction, if cars may change to it.
    pub left: Option<LaneId>,
    /// The next lane to the right in the same direction, if cars may change to it.
    pub right: Option<LaneId>,
    /// The lanes that begin at the end of this lane.
    pub successors: Vec<LaneId>,
    /// The lanes that end at the beginning of this lane.
    pub predecessors: Vec<LaneId>,
    /// The conflicts with lanes of the same intersection that cross or join this lane.
    pub conflicts: Vec<LaneConflict>,
}

impl Lane {
    /// Returns the length of the lane in metres.
    pub fn length(&self) -> f64 {
        self.curve.length()
    }

    /// Returns the neighbouring lanes of the same direction.
    pub fn beside(&self) -> impl Iterator<Item = LaneId> {
        self.left.into_iter().chain(self.right)
    }
}
