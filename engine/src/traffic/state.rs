//! A car as it drives.

use super::car::{Itinerary, TrafficCar};
use super::idm::{Idm, hardest_braking};
use super::map::{LATERAL, Map};
use crate::geometry::wrapped;
use crate::geometry::{Pose, Side};
use crate::road::LaneId;
use std::collections::VecDeque;

/// Speed in m/s above which a lane change takes the time that it is to take; below, it takes as long a way as at this.
pub(super) const WALKING: f64 = 5.0;

/// Metres that somebody may want to drive around a roundabout.
const LONGEST_ROUND: f64 = 500.0;

/// The next line on the path of a car.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ask {
    /// Which lane of the path it belongs to, and how far ahead of the car's middle that begins.
    pub index: usize,
    pub base: f64,
    /// From the front to the line.
    pub distance: f64,
    /// Whether the car has leave to pass it.
    pub held: bool,
    /// Whether nobody waits before it, or right behind it.
    pub first: bool,
}

/// The right to a lane of an intersection.
#[derive(Debug, Clone, Copy)]
pub(super) struct Claim {
    pub lane: LaneId,
    /// How far the car will have come when its middle is at the beginning of the lane.
    pub start: f64,
    /// The same of the first lane of those that were claimed with it.
    pub entry: f64,
    /// Claims are served in this order; those that were given together share it.
    pub turn: u64,
    /// Whether the car is sure to leave it soon.
    pub sure: bool,
}

/// A lane change.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    pub side: Side,
    /// The lane that is being left.
    pub from: Option<LaneId>,
    /// How far to the left of its place on the new lane it began.
    pub start: f64,
    /// From 0 to 1.
    pub progress: f64,
    /// Seconds.
    pub duration: f64,
}

#[derive(Debug)]
pub(super) struct Car {
    pub half: f64,
    pub width: f64,
    pub idm: Idm,
    /// The hardest that it can brake on this road, in m/s².
    pub braking: f64,
    /// The share of the comfortable speed that the road lets it drive at in bends.
    pub grip: f64,
    /// How far to the left of the middle of its lane it keeps.
    keeps: f64,
    pub desired: f64,
    /// The speed that it is given from outside.
    pub given: Option<f64>,
    pub heedless: bool,
    pub changes_lanes: bool,
    pub itinerary: Itinerary,
    /// Where its route ends, once its path holds the last lane.
    pub end: f64,
    pub lane: LaneId,
    /// Where its middle is along the lane.
    pub s: f64,
    pub speed: f64,
    pub acceleration: f64,
    pub travelled: f64,
    /// Its lane and those to come. Each is a successor of the one before, or lies beside it.
    pub path: VecDeque<LaneId>,
    /// Whether the path holds all that there is.
    pub complete: bool,
    /// Whether it has driven out of the network.
    pub gone: bool,
    pub claims: Vec<Claim>,
    /// Since when it has been waiting for a lane of an intersection.
    pub ticket: Option<(LaneId, f64)>,
    /// Metres from its front to where it is going to stop of its own accord.
    pub wall: f64,
    pub change: Option<Change>,
    /// When it next thinks about a lane change.
    pub next_thought: f64,
    /// Seconds that it has stood where it should have changed lanes.
    pub stuck: f64,
}

impl Car {
    pub fn new(car: &TrafficCar, index: usize, seed: u64) -> Self {
        let (itinerary, end) = Itinerary::of(car, index, seed);
        let mut path = VecDeque::with_capacity(64);
        path.push_back(car.start.lane);
        Self {
            half: 0.5 * car.length,
            width: car.width,
            idm: car.idm,
            braking: hardest_braking(f64::INFINITY),
            grip: 1.0,
            keeps: car.offset,
            desired: car.desired,
            given: None,
            heedless: car.heedless,
            changes_lanes: car.changes_lanes,
            itinerary,
            end,
            lane: car.start.lane,
            s: car.start.s,
            speed: car.speed,
            acceleration: 0.0,
            travelled: 0.0,
            path,
            complete: false,
            gone: false,
            claims: Vec::with_capacity(16),
            ticket: None,
            wall: f64::INFINITY,
            change: None,
            // Not all at the same tick: the golden ratio's sequence.
            next_thought: (index as f64 * 0.618_033_988_749_895).fract(),
            stuck: 0.0,
        }
    }

    /// Drives on a road with this friction coefficient from now on.
    pub fn set_friction(&mut self, friction: f64) {
        self.braking = hardest_braking(friction);
        self.grip = (self.braking / LATERAL).min(1.0).sqrt();
    }

    /// The deceleration in m/s² at which it likes to brake, and can.
    pub fn deceleration(&self) -> f64 {
        self.idm.deceleration.min(self.braking)
    }

    /// The greatest speed in m/s that it may have after the next step, but for some acceleration: who is given one does
    /// not come to it little by little.
    pub fn soon(&self) -> f64 {
        self.given.unwrap_or(0.0).max(self.speed)
    }

    /// How far ahead it looks, in metres.
    pub fn horizon(&self) -> f64 {
        let speed = self.soon();
        self.half + 30.0 + speed * (2.0 + 0.6 * speed / self.deceleration())
    }

    /// How far from a line it asks for leave to pass it, so that it need not brake where it gets it at once.
    pub fn asking_distance(&self) -> f64 {
        let speed = self.soon();
        5.0 + speed * (1.0 + 0.5 * speed / self.deceleration())
    }

    /// Adds lanes to the path up to the horizon.
    pub fn extend_path(&mut self, map: &Map) {
        let mut ahead = -self.s;
        for pair in 0..self.path.len() {
            let changed = self.path.get(pair + 1).is_some_and(|next| map.beside(self.path[pair], *next));
            ahead += if changed { 0.0 } else { map.length(self.path[pair]) };
        }
        // More than the horizon, so that this is not to be done at every tick, and as far as a road, so that it is
        // known where an intersection is left.
        let enough = self.horizon() + 50.0;
        while !self.complete {
            let last = self.path[self.path.len() - 1];
            if ahead > enough && (map.is_road(last) || ahead > enough + LONGEST_ROUND) {
                return;
            }
            match self.itinerary.next(last, &map.network) {
                Some(lane) => {
                    self.path.push_back(lane);
                    ahead += map.length(lane);
                }
                None => self.complete = true,
            }
        }
    }

    /// The claim on a lane of the path that begins `base` metres ahead of the car's middle.
    pub fn claim(&self, lane: LaneId, base: f64) -> Option<&Claim> {
        self.claims.iter().find(|claim| claim.lane == lane && (claim.start - self.travelled - base).abs() < 1.0)
    }

    /// Gives back the claims that begin with the lane of `ask`; false if they begin with one before it.
    pub fn give_back(&mut self, ask: &Ask) -> bool {
        let claim = self.claim(self.path[ask.index], ask.base).copied();
        let Some(claim) = claim.filter(|claim| claim.start == claim.entry) else { return false };
        self.claims.retain(|other| other.turn != claim.turn);
        true
    }

    /// Whether it is sure to leave all that it has claimed soon.
    pub fn is_sure(&self) -> bool {
        self.claims.iter().all(|claim| claim.sure)
    }

    /// Where its rear is along a lane that it has a claim on.
    pub fn rear_on(&self, claim: &Claim) -> f64 {
        self.travelled - claim.start - self.half
    }

    /// Moves on by a step of `dt` to this speed.
    pub fn drive(&mut self, speed: f64, dt: f64, map: &Map) {
        self.acceleration = (speed - self.speed) / dt;
        let way = 0.5 * (self.speed + speed) * dt;
        self.speed = speed;
        self.s += way;
        self.travelled += way;
        if let Some(change) = &mut self.change {
            change.progress += dt / change.duration * (speed / WALKING).min(1.0);
            if change.progress >= 1.0 {
                self.change = None;
            }
        }
        let before = self.lane;
        while self.s >= map.length(self.lane) {
            let next = self.path.get(1).filter(|next| !map.beside(self.lane, **next));
            let Some(&next) = next else { break };
            self.s -= map.length(self.lane);
            self.path.pop_front();
            self.lane = next;
            if let Some(change) = &mut self.change {
                let lane = map.network.lane(next);
                change.from = if change.side == Side::Left { lane.right } else { lane.left };
            }
        }
        if !self.claims.is_empty() {
            let rear = self.travelled - self.half;
            self.claims.retain(|claim| rear - claim.start <= map.length(claim.lane));
        }
        if self.lane != before {
            self.extend_path(map);
        }
        self.gone = self.complete && self.end.is_infinite() && self.path.len() == 1 && {
            self.s > map.length(self.lane) + self.half
        };
    }

    /// Metres to the left of the middle of its lane, and how fast that grows in m/s.
    pub fn offset(&self) -> (f64, f64) {
        let Some(change) = &self.change else { return (self.keeps, 0.0) };
        // The path of least jerk from rest to rest.
        let p = change.progress;
        let share = p * p * p * (10.0 - p * (15.0 - 6.0 * p));
        let rate = 30.0 * p * p * (1.0 - p) * (1.0 - p) / change.duration * (self.speed / WALKING).min(1.0);
        (self.keeps + change.start * (1.0 - share), -change.start * rate)
    }

    pub fn pose(&self, map: &Map) -> Pose {
        let curve = &map.network.lane(self.lane).curve;
        let (offset, rate) = self.offset();
        let along = curve.heading(self.s);
        let heading = if rate == 0.0 { along } else { wrapped(along + libm::atan2(rate, self.speed)) };
        Pose { position: curve.beside(self.s, offset), heading }
    }
}
