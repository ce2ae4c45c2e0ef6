//! Where on the lanes a position is.

use super::bounds::Bounds;
use super::lane::{Lane, LaneId};
use super::network::RoadNetwork;
use super::route::RoutePosition;
use crate::geometry::Pose;
use nalgebra::Vector2;

/// A position as seen from a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LanePosition {
    /// The lane.
    pub lane: LaneId,
    /// How many metres along the lane the nearest point of its middle lies.
    pub s: f64,
    /// How many metres to the left of that point the position lies, across the lane.
    pub offset: f64,
    /// The heading of the lane there, in (-π, π].
    pub heading: f64,
    /// Metres to that point: more than the offset is wide where the position lies beyond an end of the lane.
    pub distance: f64,
}

impl LanePosition {
    /// The place on the lane.
    pub fn place(&self) -> RoutePosition {
        RoutePosition { lane: self.lane, s: self.s }
    }
}

impl RoadNetwork {
    /// The lane whose middle is nearest to a position, the first of them among equals. Nothing can be said of a
    /// position that is not finite.
    pub fn project(&self, position: Vector2<f64>) -> LanePosition {
        let nearest = self.tree.nearest(position, |lane| Some(self.distance_squared(lane, position)));
        let lane = nearest.expect("a network has lanes");
        self.project_onto(LaneId(lane), position)
    }

    /// The same among the lanes that lead where a pose faces: to less than a right angle at their nearest points. None
    /// where no lane does.
    pub fn project_along(&self, pose: &Pose) -> Option<LanePosition> {
        let forward = pose.forward();
        let lane = self.tree.nearest(pose.position, |index| {
            let curve = &self.lanes()[index as usize].curve;
            let at = curve.at(curve.nearest(pose.position));
            (at.forward().dot(&forward) > 0.0).then(|| (at.position - pose.position).norm_squared())
        })?;
        Some(self.project_onto(LaneId(lane), pose.position))
    }

    /// A position as seen from this lane.
    ///
    /// # Panics
    /// It is a lane of another network, which has more.
    pub fn project_onto(&self, lane: LaneId, position: Vector2<f64>) -> LanePosition {
        let curve = &self.lane(lane).curve;
        let s = curve.nearest(position);
        let at = curve.at(s);
        let beyond = position - at.position;
        LanePosition { lane, s, offset: at.forward().perp(&beyond), heading: at.heading, distance: beyond.norm() }
    }

    /// The lanes that come near a box, all that meet it among them, in no particular order. `open` is what the search
    /// needs to remember; used again, it spares an allocation.
    pub(crate) fn lanes_near(&self, target: &Bounds, open: &mut Vec<usize>, mut visit: impl FnMut(LaneId)) {
        self.tree.visit_near(target, open, |lane| visit(LaneId(lane)));
    }

    fn distance_squared(&self, lane: u32, position: Vector2<f64>) -> f64 {
        let Lane { curve, .. } = &self.lanes()[lane as usize];
        (curve.point(curve.nearest(position)) - position).norm_squared()
    }
}
