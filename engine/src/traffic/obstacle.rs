//! Places bodies that are not part of the traffic on its lanes.
//!
//! A body is on a lane if its rectangle reaches into the strip that cars need, or will soon. Predictions are along
//! straight lines, measured across the lane, so that a body that follows a bend beside the lane comes no nearer. A
//! vehicle that has to give way is expected to do so, until it is almost in the way. A person who walks over a zebra
//! crossing, or is about to, is on all of its lanes except those behind the person.

use super::map::Map;
use super::occupancy::{Body, Who};
use crate::road::{Bounds, Centreline, Crossing, LaneId, RoadNetwork};
use nalgebra::Vector2;
use paracosm_road::{Frame, Pose};

/// A body for which traffic cars stop, such as the ego vehicle, a pedestrian, or an object that stands in the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle {
    /// The position of the body's middle, and the body's heading.
    pub pose: Pose,
    /// The length of the body in metres.
    pub length: f64,
    /// The width of the body in metres.
    pub width: f64,
    /// The velocity of the body in m/s.
    pub velocity: Vector2<f64>,
}

/// The seconds for which the motion of a body is predicted.
const FORESEEN: f64 = 4.0;
/// The same for a vehicle that has to give way: within this time it can no longer wait.
const CANNOT_WAIT: f64 = 0.5;
/// The cosine of the largest angle at which a vehicle drives along a lane.
const ALONG: f64 = 0.7;
/// The metres on either side of a lane's middle that have to be clear for a car to pass, beyond the car's half width.
const CLEARANCE: f64 = 0.3;
/// The seconds before a person steps onto a zebra crossing in which cars already let the person go first.
const ABOUT_TO_ENTER: f64 = 2.0;
/// The metres beside a zebra crossing where people still walk.
const BESIDE_ZEBRA: f64 = 1.0;
/// The metres before a zebra crossing where cars stop.
const BEFORE_ZEBRA: f64 = 1.0;
/// The greatest length of a pedestrian in metres. A longer body is a vehicle.
const LONGEST_PEDESTRIAN: f64 = 2.5;
/// The speed in m/s below which a person stands.
const STANDING: f64 = 0.1;

/// Returns half the size of an obstacle along and across a direction.
fn extents(obstacle: &Obstacle, heading: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(obstacle.pose.heading - heading);
    let (sin, cos) = (sin.abs(), cos.abs());
    let (length, width) = (0.5 * obstacle.length, 0.5 * obstacle.width);
    (length * cos + width * sin, length * sin + width * cos)
}

/// Reused memory for the lanes near an obstacle.
#[derive(Debug, Default)]
pub(super) struct Near {
    lanes: Vec<LaneId>,
    feet: Vec<Foot>,
    open: Vec<usize>,
    /// The lanes that the obstacle drives along, and their successors.
    own: Vec<LaneId>,
}

/// The place of a lane that is nearest to the middle of an obstacle.
#[derive(Debug, Clone, Copy)]
struct Foot {
    /// The place in metres along the lane.
    s: f64,
    frame: Frame,
    /// The middle of the obstacle as seen from the place, in metres ahead and to the left.
    local: Vector2<f64>,
}

impl Foot {
    fn of(point: Vector2<f64>, curve: &Centreline) -> Self {
        let s = curve.nearest(point);
        let frame = curve.frame(s);
        Self { s, frame, local: frame.to_local(point) }
    }
}

/// Adds the bodies by which an obstacle occupies the lanes of a network, for cars up to `half_width`.
pub(super) fn place(obstacle: &Obstacle, map: &Map, half_width: f64, near: &mut Near, bodies: &mut Vec<Body>) {
    let from = obstacle.pose.position;
    let to = from + obstacle.velocity * FORESEEN;
    let around = 0.5 * (obstacle.length + obstacle.width) + half_width + CLEARANCE;
    let bounds = Bounds { min: from.inf(&to).add_scalar(-around), max: from.sup(&to).add_scalar(around) };
    let Near { lanes, feet, open, own } = near;
    lanes.clear();
    map.network.lanes_near(&bounds, open, |lane| lanes.push(lane));
    lanes.sort_unstable();
    feet.clear();
    feet.extend(lanes.iter().map(|lane| Foot::of(from, &map.network.lane(*lane).curve)));
    own.clear();
    if obstacle.length > LONGEST_PEDESTRIAN {
        let forward = obstacle.pose.forward();
        for (id, foot) in lanes.iter().zip(&*feet) {
            let lane = map.network.lane(*id);
            if drives_along(obstacle, forward, foot, lane.width_at(foot.s)) {
                own.push(*id);
                own.extend(&lane.successors);
            }
        }
    }
    for (lane, foot) in lanes.iter().zip(&*feet) {
        let Some((soon, body)) = on_lane(obstacle, map, *lane, foot, half_width + CLEARANCE) else { continue };
        let mut rivals = map.lane(*lane).rivals.iter().filter(|rival| own.contains(&rival.lane)).peekable();
        let waits = rivals.peek().is_some() && rivals.all(|rival| rival.given_way && !rival.gives_way);
        bodies.extend((!waits || soon <= CANNOT_WAIT).then_some(body));
    }
    for crossing in map.network.crossings() {
        on_crossing(obstacle, crossing, &map.network, bodies);
    }
}

/// Returns `true` if an obstacle that faces `forward` drives along a lane and has its middle on the lane.
fn drives_along(obstacle: &Obstacle, forward: Vector2<f64>, foot: &Foot, width: f64) -> bool {
    let along = foot.frame.ahead().dot(&forward);
    along > ALONG && foot.local.x.abs() < 0.5 * obstacle.length && foot.local.y.abs() < 0.5 * width
}

/// Returns the body by which an obstacle occupies a lane, and the seconds until it does; `None` if it does not.
fn on_lane(obstacle: &Obstacle, map: &Map, lane: LaneId, foot: &Foot, clear: f64) -> Option<(f64, Body)> {
    let (forward, local) = (foot.frame.ahead(), foot.local);
    let (along_speed, aside_speed) = (forward.dot(&obstacle.velocity), forward.perp(&obstacle.velocity));
    let curve = &map.network.lane(lane).curve;
    let (along, across) = extents(obstacle, curve.heading(foot.s));
    let missing = local.y.abs() - across - clear;
    let soon = if missing <= 0.0 {
        0.0
    } else if aside_speed * local.y < 0.0 {
        missing / aside_speed.abs()
    } else {
        return None;
    };
    let middle = foot.s + local.x + along_speed * soon;
    let (rear, front) = (middle - along, middle + along);
    let body = Body { lane, rear, front, speed: along_speed, who: Who::Foreign { soon } };
    (soon <= FORESEEN && front > 0.0 && rear < curve.length()).then_some((soon, body))
}

fn on_crossing(obstacle: &Obstacle, crossing: &Crossing, network: &RoadNetwork, bodies: &mut Vec<Body>) {
    let end = crossing.path.length();
    let start = crossing.path.start();
    let offset = obstacle.pose.position - start.position;
    let reach = end + 2.0 * (ABOUT_TO_ENTER + LONGEST_PEDESTRIAN) + obstacle.velocity.norm() * ABOUT_TO_ENTER;
    if obstacle.length > LONGEST_PEDESTRIAN || offset.norm_squared() > reach * reach {
        return;
    }
    let local = start.to_local(obstacle.pose.position);
    let speed = start.forward().dot(&obstacle.velocity);
    let (along, across) = extents(obstacle, start.heading);
    if local.y.abs() - across > 0.5 * crossing.width + BESIDE_ZEBRA {
        return;
    }
    // The parts that it stands on, and the place where it will be after `ABOUT_TO_ENTER` seconds.
    let (right, left) = (local.x - along, local.x + along);
    let steps = speed * ABOUT_TO_ENTER;
    if left + steps.max(0.0) < 0.0 || right + steps.min(0.0) > end {
        return;
    }
    let mut edge = 0.0;
    for &(lane, s) in &crossing.lanes {
        let width = network.lane(lane).width;
        let behind = (speed > STANDING && edge + width < right) || (speed < -STANDING && edge > left);
        if !behind {
            let half = 0.5 * crossing.width;
            bodies.push(Body { lane, rear: s - half - BEFORE_ZEBRA, front: s + half, speed: 0.0, who: Who::Zebra });
        }
        edge += width;
    }
}
