//! The state of a car while it drives.

use super::car::{Itinerary, TrafficCar};
use super::idm::{Idm, hardest_braking};
use super::map::{LATERAL, Map};
use super::path::LanesAhead;
use crate::road::LaneId;
use paracosm_road::wrapped;
use paracosm_road::{Pose, Side};

/// The speed in m/s up to which a lane change takes the same distance. Above, it takes its given duration.
pub(super) const WALKING: f64 = 5.0;

/// The greatest distance in metres that a car may want to drive around a roundabout.
const LONGEST_ROUND: f64 = 500.0;

/// The next line on the path of a car that the car needs permission to pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ask {
    /// The index in the car's path of the lane behind the line; `base` is the distance from the car's middle to it.
    pub index: usize,
    pub base: f64,
    /// The distance from the car's front to the line, in metres.
    pub distance: f64,
    /// `true` if the car has permission to pass the line.
    pub held: bool,
    /// `true` if no other car will stop before the line or right behind it.
    pub first: bool,
}

/// The right of a car to drive on a lane of an intersection.
#[derive(Debug, Clone, Copy)]
pub(super) struct Claim {
    pub lane: LaneId,
    /// The distance that the car will have travelled when its middle is at the beginning of the lane.
    pub start: f64,
    /// The value of `start` of the first lane among the lanes that were claimed together.
    pub entry: f64,
    /// The number of the claim in the order of service; claims that were given together share the number.
    pub turn: u64,
    /// `true` if the car is sure to leave the lane soon.
    pub sure: bool,
}

/// A lane change of a car.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    pub side: Side,
    /// The lane that the car is leaving.
    pub from: Option<LaneId>,
    /// The distance of the car to the left of its place on the new lane at the start of the lane change, in metres.
    pub start: f64,
    /// The progress of the lane change, from 0 to 1.
    pub progress: f64,
    /// The duration of the lane change in seconds.
    pub duration: f64,
}

#[derive(Debug)]
pub(super) struct Car {
    pub half: f64,
    pub width: f64,
    pub idm: Idm,
    /// The hardest braking of the car on this road, in m/s².
    pub braking: f64,
    /// The share of the comfortable speed in bends that the friction of the road allows.
    pub grip: f64,
    /// The distance in metres at which the car drives to the left of the middle of its lane.
    keeps: f64,
    pub desired: f64,
    /// The speed of the car in m/s that a caller has set; `None` if the model drives the car.
    pub given: Option<f64>,
    pub heedless: bool,
    pub changes_lanes: bool,
    pub itinerary: Itinerary,
    /// The end of the car's way in metres along its last lane; infinite for a way without an end.
    pub end: f64,
    pub lane: LaneId,
    /// The place of the car's middle, in metres along the lane.
    pub s: f64,
    pub speed: f64,
    pub acceleration: f64,
    pub travelled: f64,
    pub path: LanesAhead,
    /// `true` if the path holds all lanes of the car's way.
    pub complete: bool,
    /// `true` if the car has driven out of the network.
    pub gone: bool,
    pub claims: Vec<Claim>,
    /// The lane of an intersection for which the car waits, and the time since which the car waits.
    pub ticket: Option<(LaneId, f64)>,
    /// The distance in metres from the car's front to the place where the car will stop by itself.
    pub wall: f64,
    pub change: Option<Change>,
    /// The time of the next decision about a lane change.
    pub next_thought: f64,
    /// The seconds that the car has stood at a place where it should have changed lanes.
    pub stuck: f64,
}

impl Car {
    pub fn new(car: &TrafficCar, index: usize, seed: u64) -> Self {
        let (itinerary, end) = Itinerary::of(car, index, seed);
        Self {
            half: 0.5 * car.length(),
            width: car.width(),
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
            path: LanesAhead::new(car.start.lane),
            complete: false,
            gone: false,
            claims: Vec::with_capacity(16),
            ticket: None,
            wall: f64::INFINITY,
            change: None,
            // The cars do not decide at the same tick: this is the sequence of the golden ratio.
            next_thought: (index as f64 * 0.618_033_988_749_895).fract(),
            stuck: 0.0,
        }
    }

    /// Sets the friction coefficient of the road from now on.
    pub fn set_friction(&mut self, friction: f64) {
        self.braking = hardest_braking(friction);
        self.grip = (self.braking / LATERAL).min(1.0).sqrt();
    }

    /// Returns the deceleration in m/s² at which the car prefers to brake, limited by the road.
    pub fn deceleration(&self) -> f64 {
        self.idm.deceleration.min(self.braking)
    }

    /// Returns the greater of the car's present speed and the speed that a caller has set, in m/s. A set speed applies
    /// at once.
    pub fn soon(&self) -> f64 {
        self.given.unwrap_or(0.0).max(self.speed)
    }

    /// Returns the distance up to which the car takes account of the road ahead, in metres.
    pub fn horizon(&self) -> f64 {
        let speed = self.soon();
        self.half + 30.0 + speed * (2.0 + 0.6 * speed / self.deceleration())
    }

    /// Returns the distance in metres from a line at which the car asks to pass, early enough that it need not brake.
    pub fn asking_distance(&self) -> f64 {
        let speed = self.soon();
        5.0 + speed * (1.0 + 0.5 * speed / self.deceleration())
    }

    /// Extends the path of the car by lanes, up to the distance that the car looks ahead.
    pub fn extend_path(&mut self, map: &Map) {
        let mut ahead = -self.s;
        for pair in 0..self.path.len() {
            let changed = self.path.get(pair + 1).is_some_and(|next| map.beside(self.path[pair], *next));
            ahead += if changed { 0.0 } else { map.length(self.path[pair]) };
        }
        // More than the horizon, so that this is not necessary at every tick, and up to a road, so that the exit of an
        // intersection is known.
        let enough = self.horizon() + 50.0;
        while !self.complete {
            let last = self.path[self.path.len() - 1];
            if ahead > enough && (map.is_road(last) || ahead > enough + LONGEST_ROUND) {
                return;
            }
            match self.itinerary.next(last, &map.network) {
                Some(lane) => {
                    self.path.push(lane);
                    ahead += map.length(lane);
                }
                None => self.complete = true,
            }
        }
    }

    /// Returns the claim on a lane of the path that begins `base` metres ahead of the car's middle.
    pub fn claim(&self, lane: LaneId, base: f64) -> Option<&Claim> {
        self.claims.iter().find(|claim| claim.lane == lane && (claim.start - self.travelled - base).abs() < 1.0)
    }

    /// Gives back the claims that begin with the lane of `ask`. Returns `false` if they begin with an earlier lane.
    pub fn give_back(&mut self, ask: &Ask) -> bool {
        let claim = self.claim(self.path[ask.index], ask.base).copied();
        let Some(claim) = claim.filter(|claim| claim.start == claim.entry) else { return false };
        self.claims.retain(|other| other.turn != claim.turn);
        true
    }

    /// Returns `true` if the car is sure to leave all its claimed lanes soon.
    pub fn is_sure(&self) -> bool {
        self.claims.iter().all(|claim| claim.sure)
    }

    /// Returns the place of the car's rear in metres along a claimed lane.
    pub fn rear_on(&self, claim: &Claim) -> f64 {
        self.travelled - claim.start - self.half
    }

    /// Moves the car on by `dt` seconds, in which its speed changes to `speed`.
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
            self.path.leave(1);
            self.lane = next;
            if let Some(change) = &mut self.change {
                let lane = map.network.lane(next);
                change.from = if change.side == Side::Left { lane.right } else { lane.left };
            }
        }
        let rear = self.travelled - self.half;
        let left = |claim: &Claim| rear - claim.start > map.length(claim.lane);
        if self.claims.iter().any(left) {
            self.claims.retain(|claim| !left(claim));
        }
        if self.lane != before {
            self.extend_path(map);
        }
        self.gone = self.complete && self.end.is_infinite() && self.path.len() == 1 && {
            self.s > map.length(self.lane) + self.half
        };
    }

    /// Returns the distance of the car to the left of the lane's middle, in metres, and the lateral speed in m/s.
    pub fn offset(&self) -> (f64, f64) {
        let Some(change) = &self.change else { return (self.keeps, 0.0) };
        // The curve of least jerk from rest to rest.
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
