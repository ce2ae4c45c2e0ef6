//! The lanes of a network, and what lies before, behind, beside and across each.

use super::curve::Curve;

/// A lane of a network: its index in [`RoadNetwork::lanes`](super::RoadNetwork::lanes).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LaneId(pub(super) u32);

impl LaneId {
    pub(super) fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// Its index in [`RoadNetwork::lanes`](super::RoadNetwork::lanes).
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a lane is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LaneKind {
    /// Along a straight or curved road.
    Road,
    /// Straight on over an intersection.
    Straight,
    /// To the left at an intersection.
    Left,
    /// To the right at an intersection.
    Right,
    /// From an arm into a roundabout.
    Entry,
    /// Out of a roundabout into an arm.
    Exit,
    /// Around a roundabout, from an entry to the next exit.
    Ring,
    /// Around a roundabout, past an arm: from where one leaves to where others enter.
    RingAtArm,
}

/// Where two lanes of an intersection are in each other's way: they cross there, or join.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneConflict {
    /// The other lane.
    pub with: LaneId,
    /// From how many metres along this lane on the other is too close.
    pub from: f64,
    /// Up to how many metres along this lane it is.
    pub to: f64,
    /// Whether who comes along this lane lets those on the other go first: at a T who comes from its stem, at a
    /// roundabout who enters; else who turns left before those that come towards it, and everybody before those who
    /// come from the right. Where four roads cross, four cars can each have another at their right.
    pub gives_way: bool,
}

/// A lane: the way of a car, in the direction of its traffic.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// The index of its element in [`RoadNetwork::elements`](super::RoadNetwork::elements).
    pub element: usize,
    /// What it is part of.
    pub kind: LaneKind,
    /// On a road 1, 2, ... from the centre line to the right, along the road, and -1, -2, ... back; in an intersection
    /// the number of the lanes that it joins; in a roundabout 1, 2, ... from the inside.
    pub number: i32,
    /// Its middle.
    pub curve: Curve,
    /// Its width in metres.
    pub width: f64,
    /// The lane of the same direction to its left, where one may change to it.
    pub left: Option<LaneId>,
    /// The lane of the same direction to its right, where one may change to it.
    pub right: Option<LaneId>,
    /// The lanes that begin where it ends.
    pub successors: Vec<LaneId>,
    /// The lanes that end where it begins.
    pub predecessors: Vec<LaneId>,
    /// The lanes of the same intersection that cross it or join it.
    pub conflicts: Vec<LaneConflict>,
}

impl Lane {
    /// Its length in metres.
    pub fn length(&self) -> f64 {
        self.curve.length()
    }

    /// The lanes of the same direction beside it.
    pub fn beside(&self) -> impl Iterator<Item = LaneId> {
        self.left.into_iter().chain(self.right)
    }
}
