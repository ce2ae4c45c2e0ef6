//! Who drives first where lanes cross and join.
//!
//! A car passes the line before such a lane only with a claim on it. It asks for one when it comes near, gets it if
//!
//! 1. nobody waits before it, and there is room for all of it behind the intersection, so that it never stands in one,
//! 2. those who have claims already are away before it is there, or can be followed,
//! 3. nobody asks whom it has to let go first,
//!
//! and loses it again if, while it can still stop, the first ceases to hold. Claims are numbered as they are given, and
//! on the way a car stops before whatever zone an earlier one has not left yet: cars wait for earlier ones only, so
//! that no circle of them waits for itself. The rule of the road decides among those who ask. Where four cars each have
//! another at their right, or the main road is never free, it would not do: who has asked for [`PATIENCE`] seconds goes
//! before all who have not, in the order in which they began to ask, by their indices at last.
//!
//! In a roundabout with one lane around it a car may wait between two arms, and claims the way from one to the next; it
//! goes round whether or not there is room, for there always is while only those enter who have some, and so nobody
//! counts on its being away soon. Where there are more lanes around it cars would wait in each other's way: there the
//! whole way through is claimed at once.
//!
//! That is the reservation of tiles of Dresner and Stone (2008), without an agent at the intersection.

use super::Traffic;
use super::ahead::View;
use super::lists::Lists;
use super::map::Rival;
use super::occupancy::Who;
use super::state::{Ask, Car, Claim};
use crate::road::{LaneId, LaneKind};
use std::cmp::Ordering;

/// Seconds after which one no longer lets others go first.
const PATIENCE: f64 = 8.0;
/// Seconds before a car asks in which those who have to let it go first do so already.
const FOREWARNED: f64 = 3.0;
/// Seconds after which a car without a goal turns elsewhere, because there is no room where it wants to go.
const ELSEWHERE: f64 = 15.0;
/// Deceleration in m/s² at which cars still stop where they lose leave to drive on.
const FIRM: f64 = 3.0;
/// Metres behind the car ahead that count as taken with it.
const ROOM: f64 = 1.5;
/// Acceleration in m/s² that others are trusted to have where they leave a zone.
const TRUSTED: f64 = 1.0;

/// The lanes of an intersection that a car drives over between two places where it may stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Passage {
    /// The last of them, by its index in the path.
    pub last: usize,
    /// Whether there is room behind it.
    pub sure: bool,
}

/// A car that asks for leave, and could make use of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asker {
    car: usize,
    ask: Ask,
    passage: Passage,
    /// Since when it asks.
    since: f64,
    impatient: bool,
    /// Whether it does not ask yet, and only is to be let go first.
    far: bool,
    granted: bool,
}

impl Asker {
    /// Who is served first.
    fn order(&self, other: &Self) -> Ordering {
        other.impatient.cmp(&self.impatient).then(self.since.total_cmp(&other.since)).then(self.car.cmp(&other.car))
    }

    /// Whether it lets another one go first, whose lane is a rival of its own.
    fn lets_go(&self, other: &Self, rival: &Rival) -> bool {
        let (gives_way, given_way) = (rival.gives_way && !rival.given_way, rival.given_way && !rival.gives_way);
        match (self.impatient, other.impatient) {
            _ if other.far => gives_way && !self.impatient,
            (false, false) if gives_way || given_way => gives_way,
            (true, false) => false,
            (false, true) => true,
            _ => other.order(self).is_lt(),
        }
    }
}

impl Traffic {
    /// Lets cars pass their lines, or makes them stop there.
    pub(super) fn give_leave(&mut self, dt: f64) {
        self.askers.clear();
        self.asking.clear();
        for index in 0..self.cars.len() {
            match self.ahead[index].ask {
                Some(ask) if ask.held => self.confirm(index, ask),
                Some(ask) => self.ask(index, ask, dt),
                None => self.cars[index].ticket = None,
            }
        }
        self.askers.sort_unstable_by(Asker::order);
        for (number, asker) in self.askers.iter().enumerate() {
            for lane in self.cars[asker.car].path.range(asker.ask.index..=asker.passage.last) {
                self.asking.add(*lane, asker.car, number);
            }
        }
        for number in 0..self.askers.len() {
            let asker = self.askers[number];
            if !asker.far && self.view().may_go(&asker, &self.askers, &self.asking) {
                self.askers[number].granted = true;
                self.grant(&asker);
            }
        }
        for (car, ahead) in self.cars.iter_mut().zip(&mut self.ahead) {
            if let Some(ask) = ahead.ask.filter(|ask| !ask.held) {
                if ask.distance <= car.asking_distance() {
                    ahead.stop(car, ask.distance, dt);
                }
                ahead.wall = ahead.wall.min(ask.distance);
            }
            car.wall = ahead.wall;
        }
    }

    /// Takes leave back that a car cannot make use of, while it can still stop.
    fn confirm(&mut self, index: usize, ask: Ask) {
        let Car { speed, braking, .. } = self.cars[index];
        let stops = ask.distance > 0.5 + speed * speed / (2.0 * FIRM.min(braking));
        let useless = stops && (!ask.first || self.view().passage(index, &ask).is_none());
        // The claims stay listed until the end of this step, which does no harm.
        if useless && self.cars[index].give_back(&ask) {
            self.ahead[index].ask = Some(Ask { held: false, ..ask });
        }
    }

    /// Notes that a car asks, if it is near.
    fn ask(&mut self, index: usize, ask: Ask, dt: f64) {
        let car = &self.cars[index];
        let near = car.asking_distance();
        if ask.distance > near + car.speed * FOREWARNED {
            return;
        }
        let passage = self.view().passage(index, &ask).filter(|_| ask.first);
        let far = ask.distance > near;
        let car = &mut self.cars[index];
        let lane = car.path[ask.index];
        let since = car.ticket.filter(|(asked, _)| *asked == lane).map_or(self.time, |(_, since)| since);
        if !far {
            car.ticket = Some((lane, since));
        }
        if let Some(passage) = passage {
            let impatient = !far && self.time - since > PATIENCE;
            self.askers.push(Asker { car: index, ask, passage, since, impatient, far, granted: false });
            return;
        }
        let waits = |time: f64| ((time - since) / ELSEWHERE).floor();
        if ask.first && ask.index > 0 && car.itinerary.is_free() && waits(self.time) > waits(self.time - dt).max(0.0) {
            car.path.truncate(ask.index);
            car.complete = false;
            car.extend_path(&self.map);
            car.ticket = Some((car.path[ask.index], since));
        }
    }

    /// Gives a car the claims that it asks for.
    fn grant(&mut self, asker: &Asker) {
        let car = &mut self.cars[asker.car];
        let entry = car.travelled + asker.ask.base;
        let mut start = entry;
        for k in asker.ask.index..=asker.passage.last {
            let claim = Claim { lane: car.path[k], start, entry, turn: self.turns, sure: asker.passage.sure };
            start += self.map.length(claim.lane);
            car.claims.push(claim);
            self.claims.add(claim.lane, asker.car, claim);
        }
        self.turns += 1;
        self.ahead[asker.car].ask = Some(Ask { held: true, ..asker.ask });
    }
}

impl View<'_> {
    /// What a car has to claim so that it can stop behind it without being in the way; none if it would not get there.
    pub fn passage(&self, index: usize, ask: &Ask) -> Option<Passage> {
        let car = &self.cars[index];
        let length = 2.0 * car.half;
        let mut last = ask.index;
        // How far ahead what is claimed ends, and the lane that is looked at begins.
        let mut end = ask.base + self.map.length(car.path[last]);
        let mut base = end;
        let mut lanes = car.path.iter().enumerate().skip(ask.index + 1);
        while base - end < length + ROOM {
            let Some((k, &lane)) = lanes.next() else {
                // The path is too short yet to tell, or the route ends here.
                if car.complete { break } else { return None }
            };
            let cramped = !self.map.rivals(lane).is_empty() && base + self.map.line(lane) - end < length + ROOM;
            if cramped || self.map.is_through(lane) {
                last = k;
                end = base + self.map.length(lane);
            }
            base += self.map.length(lane);
        }
        let sure = self.has_room(index, ask, (last, end));
        // Traffic goes round a roundabout whether or not it is full: only who enters asks for room.
        let goes_round = self.map.network.lane(car.path[last]).kind == LaneKind::RingAtArm;
        (sure || goes_round).then_some(Passage { last, sure })
    }

    /// Whether there will be room for a car behind the lane `last` of its path, which ends `end` metres ahead.
    fn has_room(&self, index: usize, ask: &Ask, (last, end): (usize, f64)) -> bool {
        let car = &self.cars[index];
        let (first, last) = (car.path[ask.index], car.path[last]);
        let mut needed = 2.0 * car.half + ROOM;
        for rival in self.map.rivals(last).iter().filter(|rival| rival.merges) {
            for (other, claim) in self.claims.on(rival.lane) {
                if other != index && self.cars[other].rear_on(claim) < self.map.length(rival.lane) {
                    needed += 2.0 * self.cars[other].half + ROOM;
                }
            }
        }
        let mut base = -car.s;
        for (k, &lane) in car.path.iter().enumerate() {
            let bodies = if k == 0 { self.occupancy.ahead_of(index) } else { self.occupancy.on(lane) };
            for body in bodies {
                let rear = base + body.rear;
                match body.who {
                    Who::Zebra | Who::Foreign { .. } if car.heedless => {}
                    // Whoever stands on the way; nearer ones keep the car from asking at all.
                    Who::Zebra | Who::Foreign { .. } => {
                        if base + body.front > ask.distance {
                            return rear - end >= needed;
                        }
                    }
                    Who::Car(other) | Who::Leaving(other) => {
                        let other = &self.cars[other as usize];
                        if base + body.middle() >= end {
                            // Even at its hardest braking it leaves that much more room.
                            let stopping = 0.5 * body.speed * body.speed / car.braking;
                            return rear + stopping - end >= needed;
                        }
                        if k >= ask.index || other.claims.iter().any(|claim| claim.lane == first) {
                            if !other.is_sure() || rear + other.wall < end {
                                return false;
                            }
                            needed += 2.0 * other.half + ROOM;
                        }
                    }
                }
            }
            if base < end && k >= ask.index && !self.is_parted(index, lane, base) {
                return false;
            }
            base += self.map.length(lane);
            if base > end + needed {
                break;
            }
        }
        true
    }

    /// Whether all who turned off at the beginning of a lane, `base` metres ahead, are sure to be out of its way.
    fn is_parted(&self, index: usize, lane: LaneId, base: f64) -> bool {
        self.map.forks(lane).iter().all(|fork| {
            let bodies = self.occupancy.on(fork.lane).iter();
            let mut sticking_out = bodies.filter(|body| body.middle() > -base && body.rear < fork.apart.1);
            sticking_out.all(|body| body.car().is_none_or(|other| other == index || self.cars[other].is_sure()))
        })
    }

    /// Whether a car may have the claim that it asks for.
    pub fn may_go(&self, asker: &Asker, askers: &[Asker], asking: &Lists<usize>) -> bool {
        let car = &self.cars[asker.car];
        let mut base = asker.ask.base;
        for &lane in car.path.range(asker.ask.index..=asker.passage.last) {
            let length = self.map.length(lane);
            for rival in self.map.rivals(lane) {
                for (other, claim) in self.claims.on(rival.lane) {
                    let rear = self.cars[other].rear_on(claim);
                    if other == asker.car || rear > rival.other.1 {
                        continue;
                    }
                    let speed = self.cars[other].speed;
                    let fits = if rival.merges {
                        let gap = self.joining_gap(base + length - car.half, rival, rear);
                        gap > 0.0 && car.idm.following(car.speed, car.desired, gap, speed) > -car.deceleration()
                    } else {
                        let arrival = time(base + rival.from - car.half, car.soon(), car.idm.acceleration);
                        let way = rival.other.1 - rear;
                        let pace = self.cars[other].desired.min(self.map.speed(rival.lane) * car.grip).max(1.0);
                        claim.sure && arrival > time(way, speed, TRUSTED.min(car.braking)).max(way / pace)
                    };
                    if !fits {
                        return false;
                    }
                }
                for (_, &other) in asking.on(rival.lane) {
                    let other = &askers[other];
                    if other.car == asker.car || other.granted {
                        continue;
                    }
                    if asker.lets_go(other, rival) {
                        return false;
                    }
                }
            }
            base += length;
        }
        true
    }
}

/// Seconds until so many metres are driven with a constant acceleration.
fn time(way: f64, speed: f64, acceleration: f64) -> f64 {
    if way <= 0.0 { 0.0 } else { ((speed * speed + 2.0 * acceleration * way).sqrt() - speed) / acceleration }
}
