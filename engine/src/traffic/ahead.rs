//! Finds what lies ahead of a car and how fast the car may drive therefore.
//!
//! A car looks along its path: at the next body on it, at bodies that have turned off but still stick out into it, at
//! cars that have the right to cross or join it first, at bends and speed limits, and at the next line that it needs leave to pass. Each
//! alone gives an acceleration by the model and a safe speed; the smallest values apply.

use super::idm::safe_speed;
use super::lists::Lists;
use super::map::{BEFORE_ZONE, Facts, Map, Rival};
use super::occupancy::{Body, Occupancy, Who};
use super::state::{Ask, Car, Claim};
use crate::road::LaneId;

/// The gap in metres between joining cars, beyond that of the model: bends of different radii differ in length.
const JOINING: f64 = 1.0;
/// The time in seconds up to which a car brakes for a body that will come into its way.
const SOON: f64 = 1.5;
/// The time in seconds in which a car adjusts to the speed of the next bend, and its hardest braking for it in m/s².
const BEND: (f64, f64) = (0.5, 3.0);
/// A car that stops fewer metres beyond a line than this keeps the next car from passing the line.
const BEYOND_LINE: f64 = 8.0;

/// All data that a car may look at.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub map: &'a Map,
    pub cars: &'a [Car],
    pub occupancy: &'a Occupancy,
    pub claims: &'a Lists<Claim>,
}

/// The limits of how a car may drive on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ahead {
    /// The acceleration of the car in m/s² on a free road.
    free: f64,
    /// The acceleration of the car in m/s² that the driver model demands; `following` counts only the body ahead.
    pub acceleration: f64,
    pub following: f64,
    /// The greatest safe speed of the car after this step, in m/s.
    pub safe: f64,
    pub ask: Option<Ask>,
    /// The distance in metres from the car's front to the next place where it has to stop, except the line of `ask`.
    pub wall: f64,
    /// `true` if the known path of the car is too short for a decision.
    pub short: bool,
    /// The rear of the nearest body ahead once the body has stopped, relative to the car's middle.
    held_up: f64,
}

impl Ahead {
    /// Returns limits without effect, for a car that has left the network.
    pub fn nothing() -> Self {
        let (short, far) = (false, f64::INFINITY);
        Self { free: 0.0, acceleration: 0.0, following: 0.0, safe: far, ask: None, wall: far, short, held_up: far }
    }

    /// Takes account of a body that drives `gap` metres ahead.
    fn follow(&mut self, car: &Car, gap: f64, speed: f64, dt: f64) {
        let following = self.free - car.idm.interaction(car.speed, gap, speed);
        lower(&mut self.following, following);
        lower(&mut self.acceleration, following);
        lower(&mut self.safe, safe_speed(car.speed, gap, speed, car.braking, dt));
    }

    /// Lowers the limits so that the car stops within `distance` metres.
    pub fn stop(&mut self, car: &Car, distance: f64, dt: f64) {
        let stopping = self.free - car.idm.interaction(car.speed, distance + car.idm.gap, 0.0);
        lower(&mut self.acceleration, stopping);
        lower(&mut self.safe, safe_speed(car.speed, distance + 0.5, 0.0, car.braking, dt));
    }

    /// Takes account of a bend or of a speed limit, `distance` metres ahead.
    fn bend(&mut self, car: &Car, distance: f64, speed: f64) {
        let left = (distance - car.speed * BEND.0).max(0.0);
        let square = speed * speed + 2.0 * car.deceleration() * left;
        // Most bends are too far away to matter. This test needs no square root. Its margin is far above all rounding.
        let reached = car.speed + self.acceleration * BEND.0 + 1e-6;
        if reached < 0.0 || square > reached * reached {
            return;
        }
        let allowed = square.sqrt();
        lower(&mut self.acceleration, ((allowed - car.speed) / BEND.0).max(-BEND.1.min(car.braking)));
    }
}

/// Lowers a limit to a number if the number is less. A NaN changes nothing.
fn lower(limit: &mut f64, to: f64) {
    if to < *limit {
        *limit = to;
    }
}

impl View<'_> {
    /// Finds the limits that everything ahead sets for a car, except the next line that it needs permission to pass.
    pub fn look_ahead(&self, index: usize, dt: f64, ahead: &mut Ahead) {
        let car = &self.cars[index];
        let free = car.idm.free(car.speed, car.desired);
        *ahead = Ahead { free, acceleration: free, following: free, ..Ahead::nothing() };
        self.walk(index, dt, ahead);
        if let Some(ask) = &mut ahead.ask {
            ask.first = ahead.held_up > ask.distance + car.half + BEYOND_LINE;
        }
    }

    fn walk(&self, index: usize, dt: f64, ahead: &mut Ahead) {
        let car = &self.cars[index];
        if let Some(from) = car.change.and_then(|change| change.from) {
            let s = self.map.across(car.s, car.lane, from);
            let met = self.next_body(index, self.occupancy.ahead_on_old_lane(index), -s, dt, ahead);
            if let Some(next) = self.map.road_after(from).filter(|_| !met) {
                self.next_body(index, self.occupancy.on(next), self.map.length(from) - s, dt, ahead);
            }
        }
        let horizon = car.horizon();
        let mut base = -car.s;
        let mut alone = true;
        let path: &[LaneId] = &car.path;
        for (k, &id) in path.iter().enumerate() {
            let lane = self.map.lane(id);
            let bend = lane.speed * car.grip;
            if bend < car.desired {
                ahead.bend(car, base.max(0.0), bend);
            }
            for limit in lane.limits.iter().filter(|limit| limit.speed < car.desired && base + limit.to > 0.0) {
                ahead.bend(car, (base + limit.from).max(0.0), limit.speed);
            }
            if !lane.rivals.is_empty() {
                let claim = car.claim(id, base);
                let distance = base + lane.line - car.half;
                if distance > 0.0 || claim.is_none() {
                    let held = claim.is_some();
                    if ahead.ask.is_none() {
                        ahead.ask = Some(Ask { index: k, base, distance, held, first: true });
                    } else if !held {
                        // The line after the next: the car asks for leave once it has passed the next line.
                        if distance < car.asking_distance() {
                            ahead.stop(car, distance, dt);
                        }
                        ahead.wall = distance;
                        return;
                    }
                }
                if let Some(claim) = claim {
                    self.yield_to_earlier(index, claim, lane, base, dt, ahead);
                }
            }
            self.sticking_out(index, lane, base, dt, ahead);
            if alone {
                let bodies = if k == 0 { self.occupancy.ahead_of(index) } else { self.occupancy.on(id) };
                alone = !self.next_body(index, bodies, base, dt, ahead);
            }
            match path.get(k + 1) {
                Some(next) if lane.is_beside(*next) => {
                    let distance = base + lane.length - 1.0 - car.half;
                    ahead.stop(car, distance, dt);
                    ahead.wall = distance;
                    return;
                }
                None if car.complete && car.end.is_finite() => {
                    let distance = base + car.end;
                    ahead.stop(car, distance, dt);
                    ahead.wall = distance;
                    return;
                }
                _ => base += lane.length,
            }
            if base > horizon {
                return;
            }
        }
        ahead.short = !car.complete;
    }

    /// Takes account of the first of `bodies` that is in the way. Returns `true` if there is such a body.
    fn next_body(&self, index: usize, bodies: &[Body], base: f64, dt: f64, ahead: &mut Ahead) -> bool {
        let car = &self.cars[index];
        for body in bodies {
            let gap = base + body.rear - car.half;
            match body.who {
                Who::Zebra => {
                    // A body that is on the crossing already leaves it.
                    if !car.heedless && gap > -0.5 {
                        ahead.stop(car, gap, dt);
                        lower(&mut ahead.held_up, base + body.rear);
                    }
                }
                Who::Foreign { soon } => {
                    if !car.heedless && soon <= SOON {
                        ahead.follow(car, gap, body.speed, dt);
                        lower(&mut ahead.held_up, base + body.rear);
                        return true;
                    }
                }
                Who::Car(other) | Who::Leaving(other) => {
                    if other as usize != index {
                        ahead.follow(car, gap, body.speed, dt);
                        lower(&mut ahead.held_up, base + body.rear + self.cars[other as usize].wall);
                        return true;
                    }
                }
            }
        }
        false
    }

    /// Takes account of cars that turned off at the beginning of a lane of the path and still stick out into it.
    fn sticking_out(&self, index: usize, lane: &Facts, base: f64, dt: f64, ahead: &mut Ahead) {
        let car = &self.cars[index];
        for fork in &lane.forks {
            if -base - car.half > fork.apart.0 {
                continue;
            }
            let next = self.occupancy.on(fork.lane).iter().find(|body| match body.who {
                Who::Car(other) => body.middle() > -base || (body.middle() == -base && (other as usize) < index),
                _ => false,
            });
            let Some(body) = next.filter(|body| body.rear < fork.apart.1) else { continue };
            ahead.follow(car, base + body.rear - car.half, body.speed, dt);
            if body.car().is_some_and(|other| body.rear + self.cars[other].wall < fork.apart.1) {
                ahead.held_up = f64::NEG_INFINITY;
            }
        }
    }

    /// Takes account of cars that may cross or join a lane before this car.
    fn yield_to_earlier(&self, index: usize, claim: &Claim, lane: &Facts, base: f64, dt: f64, ahead: &mut Ahead) {
        let car = &self.cars[index];
        for rival in &lane.rivals {
            for (other, theirs) in self.claims.on(rival.lane) {
                let rear = self.cars[other].rear_on(theirs);
                if other == index || theirs.turn >= claim.turn || rear > rival.other.1 {
                    continue;
                }
                let to_zone = base + rival.from - BEFORE_ZONE - car.half;
                if rival.merges {
                    let gap = self.joining_gap(base + lane.length - car.half, rival, rear);
                    if gap > to_zone {
                        ahead.follow(car, gap, self.cars[other].speed, dt);
                    } else {
                        ahead.stop(car, to_zone, dt);
                    }
                } else if to_zone > -BEFORE_ZONE {
                    ahead.stop(car, to_zone.max(0.0), dt);
                }
            }
        }
    }

    /// Returns the gap in metres between two cars after both cars have joined the same lane. `end` is the distance to
    /// the end of this car's lane, `rear` the place of the other car's rear along its own lane.
    pub fn joining_gap(&self, end: f64, rival: &Rival, rear: f64) -> f64 {
        end - (self.map.length(rival.lane) - rear) - JOINING
    }
}
