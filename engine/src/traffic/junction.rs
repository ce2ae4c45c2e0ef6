//! Decides which car drives first where lanes cross or join.
//!
//! A car may pass the line before such a lane only with a claim on it. A car that comes near asks for the claim, and
//! gets the claim if
//!
//! 1. no other car waits before it, and all of it has room behind the intersection, so that it never stands in one,
//! 2. cars that have claims already will be away before it arrives, or it can follow them,
//! 3. no car asks that it has to let go first.
//!
//! The car loses the claim again if condition 1 ceases to hold while it can still stop. Claims are numbered as they are
//! given. On its way, a car stops before each zone that a car with an earlier claim has not left: cars wait for earlier
//! ones only, so that no circle of cars waits for itself. The rule of the road decides among cars that ask. It does not
//! suffice if four cars each have another at their right, or if the main road is never free. So a car that has asked
//! for [`PATIENCE`] seconds goes before all that have not, in the order in which they began to ask, then by index.
//!
//! In a roundabout with one lane, a car may wait between two arms, and claims the stretch from one arm to the next. It
//! goes round whether or not there is room: there is always room, as long as cars enter only if they have some. So no
//! car counts on its being away soon. In a roundabout with more lanes, cars would wait in each other's way: there, a
//! car claims the whole way through at once.
//!
//! This is the reservation of tiles of Dresner and Stone (2008), without an agent at the intersection.

use super::Traffic;
use super::ahead::View;
use super::lists::Lists;
use super::map::{Facts, Rival};
use super::occupancy::Who;
use super::state::{Ask, Car, Claim};
use crate::road::{LaneId, LaneKind};
use std::cmp::Ordering;

/// The seconds after which a car no longer lets others go first.
const PATIENCE: f64 = 8.0;
/// The seconds before a car asks during which others already let it go first.
const FOREWARNED: f64 = 3.0;
/// The seconds after which a car without a goal takes another turn, because there is no room where it wants to go.
const ELSEWHERE: f64 = 15.0;
/// The deceleration in m/s² at which a car still stops if it loses leave to drive on.
const FIRM: f64 = 3.0;
/// The metres behind the car ahead that count as occupied by that car.
const ROOM: f64 = 1.5;
/// The acceleration in m/s² that a car expects of others that leave a zone.
const TRUSTED: f64 = 1.0;

/// The lanes of an intersection that a car drives over between two places where it may stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Passage {
    /// The index of the passage's last lane in the path of the car.
    pub last: usize,
    /// `true` if the car has room behind the end of the passage.
    pub sure: bool,
}

/// A car that asks for permission to pass a line and could use the permission.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asker {
    car: usize,
    ask: Ask,
    passage: Passage,
    /// The time at which the car began to ask, in seconds.
    since: f64,
    impatient: bool,
    /// `true` if the car does not ask yet, but others already let it go first.
    far: bool,
    granted: bool,
}

impl Asker {
    /// Returns the order in which two cars are served.
    fn order(&self, other: &Self) -> Ordering {
        other.impatient.cmp(&self.impatient).then(self.since.total_cmp(&other.since)).then(self.car.cmp(&other.car))
    }

    /// Returns `true` if this car lets `other` go first. `rival` is the conflict of the lanes of the two cars as this
    /// car sees the conflict.
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
    /// Lets cars pass their lines, or makes cars stop at their lines.
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
            for lane in &self.cars[asker.car].path[asker.ask.index..=asker.passage.last] {
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

    /// Takes leave back from a car that cannot use it, while the car can still stop.
    fn confirm(&mut self, index: usize, ask: Ask) {
        let Car { speed, braking, .. } = self.cars[index];
        let stops = ask.distance > 0.5 + speed * speed / (2.0 * FIRM.min(braking));
        let useless = stops && (!ask.first || self.view().passage(index, &ask).is_none());
        // The claims stay in the lists until the end of this step, which does no harm.
        if useless && self.cars[index].give_back(&ask) {
            self.ahead[index].ask = Some(Ask { held: false, ..ask });
        }
    }

    /// Notes that a car asks, if the car is near enough.
    fn ask(&mut self, index: usize, ask: Ask, dt: f64) {
        let car = &self.cars[index];
        let near = car.asking_distance();
        if ask.distance > near + car.speed * FOREWARNED {
            return;
        }
        let passage = if ask.first { self.view().passage(index, &ask) } else { None };
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
    /// Returns the lanes that a car has to claim in order to stop beyond the lanes without blocking other cars; `None`
    /// if the car would not get beyond the lanes.
    pub fn passage(&self, index: usize, ask: &Ask) -> Option<Passage> {
        let car = &self.cars[index];
        let length = 2.0 * car.half;
        let mut last = ask.index;
        // The distances to the end of the claimed lanes, and to the beginning of the lane that is examined.
        let mut end = ask.base + self.map.length(car.path[last]);
        let mut base = end;
        let mut lanes = car.path.iter().enumerate().skip(ask.index + 1);
        while base - end < length + ROOM {
            let Some((k, &lane)) = lanes.next() else {
                // The path is too short to decide, or the route ends here.
                if car.complete { break } else { return None }
            };
            let lane = self.map.lane(lane);
            let cramped = !lane.rivals.is_empty() && base + lane.line - end < length + ROOM;
            if cramped || lane.through {
                last = k;
                end = base + lane.length;
            }
            base += lane.length;
        }
        let sure = self.has_room(index, ask, (last, end));
        // Traffic goes round a roundabout even if it is full: only entering cars need room.
        let goes_round = self.map.lane(car.path[last]).kind == LaneKind::RingAtArm;
        (sure || goes_round).then_some(Passage { last, sure })
    }

    /// Returns `true` if there will be room for a car behind lane `last` of its path, which ends `end` metres ahead.
    fn has_room(&self, index: usize, ask: &Ask, (last, end): (usize, f64)) -> bool {
        let car = &self.cars[index];
        let path: &[LaneId] = &car.path;
        let (first, last) = (path[ask.index], path[last]);
        let mut needed = 2.0 * car.half + ROOM;
        for rival in self.map.lane(last).rivals.iter().filter(|rival| rival.merges) {
            for (other, claim) in self.claims.on(rival.lane) {
                if other != index && self.cars[other].rear_on(claim) < self.map.length(rival.lane) {
                    needed += 2.0 * self.cars[other].half + ROOM;
                }
            }
        }
        let mut base = -car.s;
        for (k, &id) in path.iter().enumerate() {
            let lane = self.map.lane(id);
            let bodies = if k == 0 { self.occupancy.ahead_of(index) } else { self.occupancy.on(id) };
            for body in bodies {
                let rear = base + body.rear;
                match body.who {
                    Who::Zebra | Who::Foreign { .. } if car.heedless => {}
                    // A body that stands on the way. Nearer bodies keep the car from asking at all.
                    Who::Zebra | Who::Foreign { .. } => {
                        if base + body.front > ask.distance {
                            return rear - end >= needed;
                        }
                    }
                    Who::Car(other) | Who::Leaving(other) => {
                        let other = &self.cars[other as usize];
                        if base + body.middle() >= end {
                            // Even if the other car brakes as hard as it can, it leaves that much more room.
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
            base += lane.length;
            if base > end + needed {
                break;
            }
        }
        true
    }

    /// Returns `true` if all cars that turned off at the start of a lane, `base` metres ahead, will surely move away.
    fn is_parted(&self, index: usize, lane: &Facts, base: f64) -> bool {
        lane.forks.iter().all(|fork| {
            let bodies = self.occupancy.on(fork.lane).iter();
            let mut sticking_out = bodies.filter(|body| body.middle() > -base && body.rear < fork.apart.1);
            sticking_out.all(|body| body.car().is_none_or(|other| other == index || self.cars[other].is_sure()))
        })
    }

    /// Returns `true` if a car may get the claim that it asks for.
    pub fn may_go(&self, asker: &Asker, askers: &[Asker], asking: &Lists<usize>) -> bool {
        let car = &self.cars[asker.car];
        let mut base = asker.ask.base;
        for &lane in &car.path[asker.ask.index..=asker.passage.last] {
            let lane = self.map.lane(lane);
            for rival in &lane.rivals {
                for (other, claim) in self.claims.on(rival.lane) {
                    let rear = self.cars[other].rear_on(claim);
                    if other == asker.car || rear > rival.other.1 {
                        continue;
                    }
                    let speed = self.cars[other].speed;
                    let fits = if rival.merges {
                        let gap = self.joining_gap(base + lane.length - car.half, rival, rear);
                        gap > 0.0 && car.idm.following(car.speed, car.desired, gap, speed) > -car.deceleration()
                    } else {
                        let arrival = time(base + rival.from - car.half, car.soon(), car.idm.acceleration);
                        let way = rival.other.1 - rear;
                        let pace = self.cars[other].desired.min(self.map.lane(rival.lane).speed * car.grip).max(1.0);
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
            base += lane.length;
        }
        true
    }
}

/// Returns the seconds that a distance takes with constant acceleration.
fn time(way: f64, speed: f64, acceleration: f64) -> f64 {
    if way <= 0.0 { 0.0 } else { ((speed * speed + 2.0 * acceleration * way).sqrt() - speed) / acceleration }
}
