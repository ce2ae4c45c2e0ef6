//! Decides whether the car may enter an intersection or a roundabout, by gap acceptance.
//!
//! The map says where the way of the car is in [conflict](crate::road::LaneConflict) with other lanes. Conflicts with no
//! room for the car between them form a passage, which the car enters only as a whole. The car stops before a passage
//! unless
//!
//! 1. there is room for the car behind it;
//! 2. at every conflict in which the car gives way, nobody comes on the other lane, or on the lanes that lead to it,
//!    within the critical gap and before the car has left; or the other has gone by when the car arrives;
//! 3. at every other conflict, nobody comes who can no longer stop.
//!
//! Where four roads cross, each of four cars can have another at its right. So the driver goes before others who stand
//! once it has waited for some time. Within a passage, the car stops only for others who are there before it.

use super::super::Settings;
use crate::geometry::Pose;
use crate::observation::{Briefing, Navigation, Observation};
use crate::road::{LaneId, RoadNetwork};
use crate::traffic::Idm;

/// The metres before a conflict where the car stops.
const BEFORE: f64 = 1.0;
/// The free metres that the car wants to have behind a passage.
const BEHIND: f64 = 2.0;
/// The metres for which lanes are followed back from a conflict.
const LOOKS_BACK: f64 = 90.0;
/// The acceleration in m/s² with which others may come.
const OTHERS: f64 = 1.0;
/// The deceleration in m/s² with which the car still stops if it loses its right to go, and the deceleration that the
/// driver expects of others who give way.
const FIRM: f64 = 5.0;
const EXPECTED: f64 = 3.0;
/// The speed in m/s below which a car stands.
const STANDING: f64 = 0.3;
/// The seconds after which the other has left the conflict before the car arrives.
const AFTER: f64 = 0.5;

/// A conflict of the car's way with another lane; `from` and `to` are places in metres along the way.
#[derive(Debug)]
struct Conflict {
    from: f64,
    to: f64,
    gives_way: bool,
    /// The stretch of the other lane that is in conflict, in metres along that lane.
    theirs: (f64, f64),
    /// The ends of both lanes, on the way and on the other lane, if they lead to the same lane.
    joins: Option<(f64, f64)>,
    /// The other lane and the lanes that lead to it, each with the metres from its beginning to that of the other lane.
    lanes: Vec<(LaneId, f64)>,
}

/// Conflicts that the car passes without a stop.
#[derive(Debug)]
struct Passage {
    conflicts: Vec<Conflict>,
    /// The places in metres along the way at which the passage begins and ends.
    from: f64,
    to: f64,
    /// The comfortable speed in m/s.
    speed: f64,
}

/// A road user on a lane that leads to a conflict.
#[derive(Debug, Clone, Copy)]
struct Coming {
    /// The metres until the road user's front reaches the conflict, and until its rear has left it.
    to_conflict: f64,
    to_exit: f64,
    speed: f64,
    acceleration: f64,
}

/// The motion of the car on its way.
#[derive(Debug, Clone, Copy)]
struct Motion {
    /// The places of the front and the rear in metres along the way.
    front: f64,
    rear: f64,
    speed: f64,
    /// The acceleration in m/s² and the greatest speed in m/s of a car that goes on.
    acceleration: f64,
    fastest: f64,
}

impl Motion {
    /// Returns the seconds until the car, if it goes on, has gone some metres.
    fn time(&self, way: f64) -> f64 {
        if way <= 0.0 {
            return 0.0;
        }
        let (v, a, fastest) = (self.speed.min(self.fastest), self.acceleration, self.fastest);
        let gathering = (fastest * fastest - v * v) / (2.0 * a);
        if way < gathering {
            ((v * v + 2.0 * a * way).sqrt() - v) / a
        } else {
            (fastest - v) / a + (way - gathering) / fastest.max(0.1)
        }
    }
}

/// The part of the driver that takes junctions.
#[derive(Debug)]
pub(super) struct Junctions {
    critical_gap: f64,
    spare: f64,
    patience: f64,
    navigation: Option<Navigation>,
    passages: Vec<Passage>,
    half_length: f64,
    set_speed: f64,
    acceleration: f64,
    /// The place of the car in metres along the way.
    at: f64,
    /// The time since which the car has been standing, in seconds.
    standing_since: Option<f64>,
    /// The time of the last question, and the speed at it of each body.
    last: f64,
    speeds: Vec<Option<f64>>,
}

impl Junctions {
    pub fn new(settings: &Settings) -> Self {
        Self {
            critical_gap: settings.get("critical_gap"),
            spare: settings.get("spare"),
            patience: settings.get("patience"),
            navigation: None,
            passages: Vec::new(),
            half_length: 0.0,
            set_speed: 0.0,
            acceleration: 0.0,
            at: 0.0,
            standing_since: None,
            last: 0.0,
            speeds: Vec::new(),
        }
    }

    pub fn reset(&mut self, briefing: &Briefing, idm: &Idm, lateral: f64) {
        self.half_length = 0.5 * briefing.vehicle.length;
        self.set_speed = briefing.cruise_speed;
        self.acceleration = idm.acceleration;
        self.navigation.clone_from(&briefing.navigation);
        self.at = briefing.navigation.as_ref().map_or(0.0, |navigation| navigation.start);
        let room = briefing.vehicle.length + BEFORE + BEHIND;
        self.passages = briefing.navigation.as_ref().map_or(Vec::new(), |known| passages(known, room, lateral));
        self.standing_since = None;
        self.last = 0.0;
        self.speeds.clear();
    }

    /// Returns the metres from the car's front to the place where the car has to stop; `None` if it need not stop.
    /// `room` is the distance from the car's front in metres at which the next road user ahead can come to rest.
    pub fn stop(&mut self, observation: &Observation, room: f64) -> Option<f64> {
        let navigation = self.navigation.as_ref()?;
        let pose = navigation.way.at(navigation.start).then(&observation.odometry);
        self.at = navigation.way.nearest(pose.position, self.at);
        let (speed, now) = (observation.speed, observation.time);
        self.standing_since = if speed < STANDING { self.standing_since.or(Some(now)) } else { None };
        let motion = Motion {
            front: self.at + self.half_length,
            rear: self.at - self.half_length,
            speed,
            acceleration: self.acceleration,
            fastest: self.set_speed,
        };
        let waited = self.standing_since.is_some_and(|since| now - since > self.patience);
        // The way in which the car comes to rest, with some reserve.
        let reach = motion.front + 2.0 * speed + speed * speed / EXPECTED + 5.0;
        let near = self.passages.iter().filter(|passage| passage.to > motion.rear && passage.from < reach);
        let stops = near.filter_map(|passage| self.stop_before(passage, &motion, &pose, observation, waited, room));
        let stop = stops.fold(f64::INFINITY, f64::min);
        self.remember(observation);
        (stop < f64::INFINITY).then_some(stop)
    }

    fn remember(&mut self, observation: &Observation) {
        let bodies = observation.others.iter().map(|other| other.id + 1).max().unwrap_or(0);
        self.speeds.resize(bodies.max(self.speeds.len()), None);
        for other in &observation.others {
            self.speeds[other.id] = Some(other.velocity.norm());
        }
        self.last = observation.time;
    }

    /// Returns the metres to the place before or in a passage where the car has to stop.
    fn stop_before(
        &self,
        passage: &Passage,
        motion: &Motion,
        pose: &Pose,
        observation: &Observation,
        waited: bool,
        room: f64,
    ) -> Option<f64> {
        let motion = Motion { fastest: motion.fastest.min(passage.speed), ..*motion };
        let line = passage.from - BEFORE - motion.front;
        let stops = line + 0.5 * BEFORE > 0.5 * motion.speed * motion.speed / FIRM;
        let coming = |conflict: &Conflict| self.coming(conflict, pose, observation);
        if stops {
            let needed = passage.to - motion.front + 2.0 * self.half_length + BEHIND;
            let yields = passage.conflicts.iter().any(|conflict| conflict.gives_way);
            let go = |conflict: &Conflict| {
                coming(conflict).iter().all(|other| self.lets_go(conflict, &motion, other, waited))
            };
            let go = (!yields || room >= needed) && passage.conflicts.iter().all(go);
            return (!go).then_some(line.max(0.0));
        }
        let ahead = passage.conflicts.iter().filter(|conflict| conflict.from > motion.front);
        let blocked = ahead.filter(|conflict| coming(conflict).iter().any(|other| meets(conflict, &motion, other)));
        blocked.map(|conflict| (conflict.from - 0.5 * BEFORE - motion.front).max(0.0)).reduce(f64::min)
    }

    /// Returns the road users who come to a conflict.
    fn coming(&self, conflict: &Conflict, pose: &Pose, observation: &Observation) -> Vec<Coming> {
        let Some(Navigation { network, .. }) = &self.navigation else { return Vec::new() };
        let dt = observation.time - self.last;
        let others = observation.others.iter().filter_map(|other| {
            let there = pose.then(&Pose { position: other.position, heading: other.heading });
            let place = conflict.lanes.iter().find_map(|(lane, before)| {
                Some(network.place_on_lane(*lane, &there)? - before)
            })?;
            let (reach, speed) = (other.outline.half_extent().x, other.velocity.norm());
            let before = self.speeds.get(other.id).copied().flatten().filter(|_| dt > 0.0);
            let coming = Coming {
                to_conflict: conflict.theirs.0 - place - reach,
                to_exit: conflict.theirs.1 - place + reach,
                speed,
                acceleration: before.map_or(0.0, |before| (speed - before) / dt),
            };
            (coming.to_exit > 0.0).then_some(coming)
        });
        others.collect()
    }

    /// Returns `true` if another road user does not keep the car from entering a conflict.
    fn lets_go(&self, conflict: &Conflict, motion: &Motion, other: &Coming, waited: bool) -> bool {
        let Coming { to_conflict, speed, acceleration, .. } = *other;
        if has_gone(conflict, motion, other) {
            return true;
        }
        let (enters, leaves) = (motion.time(conflict.from - motion.front), motion.time(conflict.to - motion.rear));
        if conflict.gives_way {
            let stands = speed < STANDING && acceleration < STANDING && to_conflict > 0.0;
            let arrives = if to_conflict <= 0.0 {
                0.0
            } else {
                ((speed * speed + 2.0 * OTHERS * to_conflict).sqrt() - speed) / OTHERS
            };
            return waited && stands || arrives > (leaves + self.spare).max(enters + self.critical_gap);
        }
        let starts = acceleration > STANDING && speed < 3.0;
        let waits = to_conflict > 0.5 * speed * speed / EXPECTED && !starts;
        waits || !meets(conflict, motion, other)
    }
}

/// Returns `true` if the other road user will have gone by, or will be ahead, when the car comes to a conflict.
fn has_gone(conflict: &Conflict, motion: &Motion, other: &Coming) -> bool {
    let enters = motion.time(conflict.from - motion.front);
    match conflict.joins {
        Some((end, other_end)) => {
            // The metres from the other's rear to the end of its lane, and from the car's front to the end of its own.
            let rear = other.to_exit + other_end - conflict.theirs.1 - other.speed * enters;
            rear + BEHIND < end - conflict.from.max(motion.front)
        }
        None => other.speed > 0.0 && other.to_exit / other.speed + AFTER < enters,
    }
}

/// Returns `true` if the other road user, at its present speed, comes to a conflict before the car has left it.
fn meets(conflict: &Conflict, motion: &Motion, other: &Coming) -> bool {
    let leaves = motion.time(conflict.to - motion.rear) + AFTER;
    let arrives = if other.to_conflict <= 0.0 {
        0.0
    } else if other.speed < STANDING {
        f64::INFINITY
    } else {
        other.to_conflict / other.speed
    };
    arrives < leaves && !has_gone(conflict, motion, other)
}

/// Finds the passages on a way. Conflicts with less than `room` metres between them belong to the same passage.
fn passages(navigation: &Navigation, room: f64, lateral: f64) -> Vec<Passage> {
    let Navigation { network, way, .. } = navigation;
    let mut conflicts = Vec::new();
    for (begin, id) in way.lane_pieces() {
        let lane = network.lane(id);
        // The way may begin in the middle of its first lane.
        let offset = begin - network.project_onto(id, way.at(begin).position).s;
        for conflict in &lane.conflicts {
            let there = network.lane(conflict.with);
            let Some(theirs) = there.conflicts.iter().find(|theirs| theirs.with == id) else { continue };
            let joins = lane.successors.iter().any(|next| there.successors.contains(next));
            conflicts.push(Conflict {
                from: offset + conflict.from,
                to: offset + conflict.to,
                gives_way: conflict.gives_way,
                theirs: (theirs.from, theirs.to),
                joins: joins.then(|| (offset + lane.length(), there.length())),
                lanes: leading_to(network, conflict.with, theirs.from),
            });
        }
    }
    conflicts.sort_by(|a, b| a.from.total_cmp(&b.from));
    let mut passages: Vec<Passage> = Vec::new();
    for conflict in conflicts {
        match passages.last_mut().filter(|last| conflict.from < last.to + room) {
            Some(last) => {
                last.to = last.to.max(conflict.to);
                last.conflicts.push(conflict);
            }
            None => {
                let (from, to) = (conflict.from, conflict.to);
                passages.push(Passage { conflicts: vec![conflict], from, to, speed: f64::INFINITY });
            }
        }
    }
    for passage in &mut passages {
        let metres = (passage.to - passage.from).ceil() as usize;
        let curvatures = (0..=metres).map(|i| way.curvature(passage.from + i as f64).abs());
        passage.speed = (lateral / curvatures.fold(0.0, f64::max)).sqrt();
    }
    passages
}

/// Returns a lane and the lanes that lead to it, each with the metres from its beginning to the beginning of the lane.
fn leading_to(network: &RoadNetwork, lane: LaneId, from: f64) -> Vec<(LaneId, f64)> {
    let mut lanes = vec![(lane, 0.0)];
    let mut next = 0;
    while next < lanes.len() {
        let (lane, before) = lanes[next];
        next += 1;
        if before + from < LOOKS_BACK {
            for &earlier in &network.lane(lane).predecessors {
                if lanes.iter().all(|(known, _)| *known != earlier) {
                    lanes.push((earlier, before + network.lane(earlier).length()));
                }
            }
        }
    }
    lanes
}
