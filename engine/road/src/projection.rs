//! Projects positions onto lanes.

use super::bounds::Bounds;
use super::lane::{Lane, LaneId};
use super::network::RoadNetwork;
use super::route::RoutePosition;
use crate::geometry::{Pose, wrapped};
use nalgebra::Vector2;

/// A body is on a lane whose middle is this near, in metres, and whose direction differs by at most this, in radians.
const ON_LANE: (f64, f64) = (1.2, 0.6);

/// A position relative to a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LanePosition {
    /// The lane to which the position is relative.
    pub lane: LaneId,
    /// The place of the lane's point nearest to the position, in metres along the lane.
    pub s: f64,
    /// The distance from the lane's nearest point to the position across the lane, in metres, positive to the left.
    pub offset: f64,
    /// The heading of the lane at the point that is nearest to the position, in (-π, π].
    pub heading: f64,
    /// The distance in metres from the lane to the position. Beyond an end of the lane, it exceeds the offset.
    pub distance: f64,
}

impl LanePosition {
    /// Returns the place on the lane that is nearest to the position.
    pub fn place(&self) -> RoutePosition {
        RoutePosition { lane: self.lane, s: self.s }
    }
}

impl RoadNetwork {
    /// Returns a position relative to the lane whose middle is nearest; if several lanes are equally near, the first
    /// lane counts. The result has no meaning if the position is not finite.
    pub fn project(&self, position: Vector2<f64>) -> LanePosition {
        let nearest = self.tree.nearest(position, |lane| Some(self.distance_squared(lane, position)));
        let lane = nearest.expect("a network has lanes");
        self.project_onto(LaneId(lane), position)
    }

    /// Returns the position of a pose relative to the nearest lane in the pose's direction; `None` if there is no such
    /// lane. A lane is in the pose's direction if its direction at its nearest point differs from the pose's heading by
    /// less than a right angle.
    pub fn project_along(&self, pose: &Pose) -> Option<LanePosition> {
        let forward = pose.forward();
        let lane = self.tree.nearest(pose.position, |index| {
            let curve = &self.lanes()[index as usize].curve;
            let s = curve.nearest(pose.position);
            (curve.forward(s).dot(&forward) > 0.0).then(|| (curve.point(s) - pose.position).norm_squared())
        })?;
        Some(self.project_onto(LaneId(lane), pose.position))
    }

    /// Returns a position relative to a given lane.
    ///
    /// # Panics
    /// The lane belongs to another network, which has more lanes.
    pub fn project_onto(&self, lane: LaneId, position: Vector2<f64>) -> LanePosition {
        let curve = &self.lane(lane).curve;
        let s = curve.nearest(position);
        let at = curve.at(s);
        let beyond = position - at.position;
        LanePosition { lane, s, offset: curve.forward(s).perp(&beyond), heading: at.heading, distance: beyond.norm() }
    }

    /// Returns the place in metres along a lane of a body that drives along the lane; `None` if the body is elsewhere or
    /// points in another direction.
    pub fn place_on_lane(&self, lane: LaneId, body: &Pose) -> Option<f64> {
        if self.lane(lane).curve.is_beyond(body.position, ON_LANE.0) {
            return None;
        }
        let seen = self.project_onto(lane, body.position);
        let turned = wrapped(body.heading - seen.heading).abs();
        (seen.distance <= ON_LANE.0 && turned <= ON_LANE.1).then_some(seen.s)
    }

    /// Visits all lanes that meet a box and some lanes that are only near it, in no particular order. `open` is the
    /// memory of the search; if the same memory is used again, the search allocates nothing.
    pub fn lanes_near(&self, target: &Bounds, open: &mut Vec<usize>, mut visit: impl FnMut(LaneId)) {
        self.tree.visit_near(target, open, |lane| visit(LaneId(lane)));
    }

    fn distance_squared(&self, lane: u32, position: Vector2<f64>) -> f64 {
        let Lane { curve, .. } = &self.lanes()[lane as usize];
        (curve.point(curve.nearest(position)) - position).norm_squared()
    }
}
