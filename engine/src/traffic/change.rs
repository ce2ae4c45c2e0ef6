//! Lane changes of traffic cars.
//!
//! The model MOBIL (Kesting, Treiber, Helbing 2007) decides whether a lane change pays, with some preference for the
//! right. If the route asks for a change, only safety counts. During a change, the car is on both lanes.

use super::ahead::{Ahead, View};
use super::idm::safe_speed;
use super::map::Map;
use super::occupancy::{Body, Who};
use super::state::{Car, Change, WALKING};
use crate::road::{LaneId, LaneKind, RoutePosition};
use paracosm_road::Side;

/// The duration in seconds of a lane change that pays, and of one that the route asks for.
const DURATION: f64 = 4.0;
const DURATION_DUE: f64 = 2.5;
/// The weight of other cars' accelerations: p in the paper.
const POLITENESS: f64 = 0.3;
/// The gain in m/s² that a lane change needs, and how much more it needs to the left and less to the right.
const THRESHOLD: f64 = 0.2;
const TO_THE_RIGHT: f64 = 0.1;
/// The hardest braking in m/s² that a lane change may impose on the car behind.
const IMPOSED: f64 = 2.0;
/// The smallest gap in metres to the cars ahead and behind.
const CLEAR: f64 = 2.0;
/// The metres behind an intersection that stay free for cars that come out of it.
const BEHIND_INTERSECTION: f64 = 15.0;
/// The distance in metres to the end of a lane below which a car changes at once to the lane of its route, and the
/// distance above which it overtakes on other lanes.
const AT_ONCE: f64 = 250.0;
const OVERTAKING: f64 = 350.0;
/// The seconds of standing after which a car gives up the lane change that it waits for and drives on.
const GIVEN_UP: f64 = 5.0;

impl Car {
    /// Begins a lane change if the car is not changing lanes. From now on, the car belongs to the new lane.
    pub fn begin_change(&mut self, side: Side, to: LaneId, duration: f64, map: &Map) {
        let lane = self.lane;
        let apart = 0.5 * (map.network.lane(lane).width + map.network.lane(to).width);
        let start = if side == Side::Left { -apart } else { apart };
        self.change = Some(Change { side, from: Some(lane), start, progress: 0.0, duration });
        self.s = map.across(self.s, lane, to);
        self.lane = to;
        // The car gives up its leave to pass a line, because its path changes.
        let front = self.travelled + self.half;
        self.claims.retain(|claim| claim.start < front);
        self.ticket = None;
        self.stuck = 0.0;
        self.path.leave(1);
        if self.path.first() == Some(&to) {
            return;
        }
        if self.itinerary.is_free() {
            self.path.truncate(0);
            self.complete = false;
        } else {
            self.path.put_first(&[lane]);
        }
        self.path.put_first(&[to]);
        self.extend_path(map);
    }
}

impl View<'_> {
    /// Returns the lane change that a car wants to make and may begin now; `None` without such a lane change.
    pub fn wanted_change(&self, index: usize, ahead: &Ahead, dt: f64) -> Option<(Side, LaneId, f64)> {
        let car = &self.cars[index];
        let lane = self.map.network.lane(car.lane);
        if car.change.is_some() || lane.kind != LaneKind::Road {
            return None;
        }
        let left = self.map.length(car.lane) - car.s;
        let due = car.path.get(1).filter(|next| self.map.beside(car.lane, **next));
        if let Some(&due) = due.filter(|_| left < AT_ONCE) {
            let side = if lane.left == Some(due) { Side::Left } else { Side::Right };
            return self.gain(index, due, DURATION_DUE, ahead, dt).map(|_| (side, due, DURATION_DUE));
        }
        if !car.changes_lanes {
            return None;
        }
        let free = car.itinerary.is_free() || left > OVERTAKING;
        let sides = [(Side::Left, lane.left, -TO_THE_RIGHT), (Side::Right, lane.right, TO_THE_RIGHT)];
        let options = sides.into_iter().filter_map(|(side, to, bonus)| {
            let to = to.filter(|to| free || due == Some(to))?;
            let gain = self.gain(index, to, DURATION, ahead, dt)? + bonus;
            (gain > THRESHOLD).then_some((gain, (side, to, DURATION)))
        });
        // The first of equals, which is the change to the left.
        options.reduce(|best, next| if next.0 > best.0 { next } else { best }).map(|(_, change)| change)
    }

    /// Returns the gain of a lane change in m/s²; `None` if the change is not safe.
    fn gain(&self, index: usize, to: LaneId, duration: f64, ahead: &Ahead, dt: f64) -> Option<f64> {
        let car = &self.cars[index];
        let s = self.map.across(car.s, car.lane, to);
        if !self.is_long_enough(car, s, to, duration) {
            return None;
        }
        let bodies = self.occupancy.on(to);
        let behind = bodies.partition_point(|body| body.middle() <= s);
        let (rear, front) = (s - car.half, s + car.half);
        let leader = bodies[behind..].first().map(|body| (body.rear - front, body.speed));
        let leader = leader.or_else(|| {
            let body = self.occupancy.on(self.map.road_after(to)?).first()?;
            Some((self.map.length(to) + body.rear - front, body.speed))
        });
        let follower = bodies[..behind].last().map(|body| (rear - body.front, *body));
        let follower = follower.or_else(|| {
            let before = self.map.road_before(to)?;
            let body = self.occupancy.on(before).last()?;
            Some((rear + self.map.length(before) - body.front, *body))
        });
        let (mut own, mut others) = (car.idm.free(car.speed, car.desired), 0.0);
        if let Some((gap, speed)) = leader {
            if gap < CLEAR || safe_speed(car.speed, gap, speed, car.braking, dt) < car.speed {
                return None;
            }
            own = car.idm.following(car.speed, car.desired, gap, speed);
        }
        if let Some((gap, body)) = follower {
            if gap < CLEAR || safe_speed(body.speed, gap, car.speed, car.braking, dt) < body.speed {
                return None;
            }
            // A body that is not part of the traffic is assumed to drive as this car does.
            let other = body.car().map_or(car, |other| &self.cars[other]);
            let desired = if body.car().is_some() { other.desired } else { body.speed.max(1.0) };
            let after = other.idm.following(body.speed, desired, gap, car.speed);
            let before = match leader {
                Some((ahead, speed)) => other.idm.following(body.speed, desired, gap + 2.0 * car.half + ahead, speed),
                None => other.idm.free(body.speed, desired),
            };
            if after < -IMPOSED {
                return None;
            }
            others += after - before;
        }
        if let Some(Body { who: Who::Car(other), front, .. }) = self.occupancy.behind(index).last() {
            let other = &self.cars[*other as usize];
            let gap = car.s - car.half - front;
            let before = other.idm.following(other.speed, other.desired, gap, car.speed);
            let after = match self.occupancy.ahead_of(index).first() {
                Some(body) => other.idm.following(other.speed, other.desired, body.rear - front, body.speed),
                None => other.idm.free(other.speed, other.desired),
            };
            others += after - before;
        }
        Some(own - ahead.following + POLITENESS * others)
    }

    /// Returns `true` if the lane is long enough to change to it.
    fn is_long_enough(&self, car: &Car, s: f64, to: LaneId, duration: f64) -> bool {
        let needed = car.speed.max(WALKING) * duration + 0.5 * car.idm.acceleration * duration * duration;
        let left = self.map.length(to) - s;
        let goes_on = self.map.road_after(to).map_or(0.0, |next| self.map.length(next));
        let begins = self.map.road_before(to).is_some() || self.map.network.lane(to).predecessors.is_empty();
        let begun = s - car.half;
        left + goes_on > needed + car.half + CLEAR && (begins || begun > BEHIND_INTERSECTION)
    }
}

impl Car {
    /// Finds another way for a car that has waited too long for the lane change that its route asks for. The new way
    /// leads to the end of its lane and from there to the end of the route. If the route has no end, the way leads to
    /// the lane that the car could not reach.
    #[inline]
    pub fn give_up_change(&mut self, dt: f64, map: &Map) {
        if self.speed > 0.1 || self.change.is_some() {
            self.stuck = 0.0;
        } else {
            self.wait_for_change(dt, map);
        }
    }

    fn wait_for_change(&mut self, dt: f64, map: &Map) {
        let due = self.path.get(1).copied().filter(|next| map.beside(self.lane, *next));
        let Some(due) = due else { return };
        self.stuck += dt;
        if self.stuck < GIVEN_UP {
            return;
        }
        self.stuck = 0.0;
        let goal =
            self.itinerary.goal(self.end).unwrap_or(RoutePosition { lane: *self.path.get(2).unwrap_or(&due), s: 0.0 });
        let ways = map.network.lane(self.lane).successors.iter();
        let ways = ways.filter_map(|next| map.network.route(RoutePosition { lane: *next, s: 0.0 }, goal, 50.0));
        let Some(way) = ways.min_by(|a, b| a.length.total_cmp(&b.length)) else { return };
        self.complete = self.end.is_finite();
        self.path.leave(if self.complete { self.path.len() } else { 3 });
        self.path.put_first(&way.lanes);
        self.path.put_first(&[self.lane]);
    }
}
