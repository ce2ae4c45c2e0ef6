//! Decides whether the car may enter an intersection or a roundabout, by gap acceptance.
//!
//! The map says where the way of the car is in [conflict](crate::road::LaneConflict) with other lanes. Conflicts with no
//! room for the car between them form a [passage](super::passage), which the car enters only as a whole. The car stops
//! before a passage unless
//!
//! 1. there is room for the car behind it;
//! 2. at every conflict in which the car gives way, nobody comes on the other lane, or on the lanes that lead to it,
//!    within the critical gap and before the car has left; or the other has gone by when the car arrives;
//! 3. at every other conflict, nobody comes who can no longer stop.
//!
//! Where four roads cross, each of four cars can have another at its right, and on a busy road no gap may be as long as
//! the driver wants. So the driver has patience for some time only. Then it sets out before others who stand, expects
//! others to go on as they do, and accepts every gap that suffices for its way. As soon as it rolls, it is patient again
//! until it can no longer stop. So it inches forward, and others who find it in their way let it go. Within a passage,
//! the car stops only for others who are there before it.

use super::super::Settings;
use super::passage::{Conflict, Passage, passages};
use crate::observation::{Briefing, Navigation, Observation, Other};
use crate::traffic::Idm;
use paracosm_road::Pose;

/// The metres before a conflict where the car stops.
const BEFORE: f64 = 1.0;
/// The free metres that the car wants to have behind a passage.
const BEHIND: f64 = 2.0;
/// The acceleration in m/s² with which others may come.
const OTHERS: f64 = 1.0;
/// The deceleration in m/s² with which the car still stops before a passage, and the deceleration that the driver
/// expects of others who give way.
const FIRM: f64 = 5.0;
const EXPECTED: f64 = 3.0;
/// The speed in m/s below which a road user stands, and the speed below which it may be setting out.
const STANDING: f64 = 0.3;
const SETTING_OUT: f64 = 3.0;
/// The acceleration in m/s² above which a road user takes up speed.
const SPEEDING_UP: f64 = 0.3;
/// The spare seconds between two road users who pass a conflict one after the other.
const AFTER: f64 = 0.5;

/// A road user other than the car.
#[derive(Debug, Clone, Copy)]
struct RoadUser {
    pose: Pose,
    half_length: f64,
    speed: f64,
    acceleration: f64,
}

/// A road user who comes to a conflict.
#[derive(Debug, Clone, Copy)]
struct Coming {
    /// The metres until the road user's front reaches the conflict, and until its rear has left it.
    to_conflict: f64,
    to_exit: f64,
    speed: f64,
    acceleration: f64,
}

/// The motion of the car on its way if it goes on.
#[derive(Debug, Clone, Copy)]
struct Motion {
    /// The places of the front and the rear in metres along the way.
    front: f64,
    rear: f64,
    speed: f64,
    /// The acceleration in m/s² and the greatest speed in m/s.
    acceleration: f64,
    fastest: f64,
    /// `true` if the driver has lost its patience.
    impatient: bool,
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
    others: Vec<RoadUser>,
    /// The time of the last question, and the speed of each body at that time, by the number of the body.
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
            others: Vec::new(),
            last: 0.0,
            speeds: Vec::new(),
        }
    }

    pub fn reset(&mut self, briefing: &Briefing, idm: &Idm, lateral: f64) {
        self.half_length = 0.5 * briefing.vehicle.length;
        self.set_speed = briefing.cruise_speed;
        self.acceleration = idm.acceleration;
        self.navigation.clone_from(&briefing.navigation);
        let known = self.navigation.as_ref();
        let room = briefing.vehicle.length + BEFORE + BEHIND;
        self.passages = known.map_or(Vec::new(), |navigation| passages(navigation, room, lateral));
        self.at = known.map_or(0.0, |navigation| navigation.start);
        self.standing_since = None;
        self.last = 0.0;
        self.speeds.clear();
    }

    /// Returns the metres from the car's front to the place where the car has to stop; `None` if it need not stop.
    /// `room` is the distance from the car's front in metres at which the next road user ahead can come to rest.
    pub fn stop(&mut self, observation: &Observation, bodies: &[Other], room: f64) -> Option<f64> {
        let navigation = self.navigation.as_ref()?;
        let pose = navigation.way.at(navigation.start).then(&observation.odometry);
        self.at = navigation.way.nearest(pose.position, self.at);
        self.see(&pose, observation.time, bodies);
        let (speed, now) = (observation.speed, observation.time);
        self.standing_since = if speed < STANDING { self.standing_since.or(Some(now)) } else { None };
        let motion = Motion {
            front: self.at + self.half_length,
            rear: self.at - self.half_length,
            speed,
            acceleration: self.acceleration,
            fastest: self.set_speed,
            impatient: self.standing_since.is_some_and(|since| now - since > self.patience),
        };
        // The way in which the car comes to rest, with some reserve.
        let reach = motion.front + 2.0 * speed + speed * speed / EXPECTED + 5.0;
        let near = self.passages.iter().filter(|passage| passage.to > motion.rear && passage.from < reach);
        near.filter_map(|passage| self.stop_before(passage, &motion, room)).reduce(f64::min)
    }

    /// Notes the motion of the others. Their accelerations follow from their speeds at the last question.
    fn see(&mut self, pose: &Pose, now: f64, bodies: &[Other]) {
        let dt = now - self.last;
        let count = bodies.iter().map(|body| body.id + 1).max().unwrap_or(0);
        self.speeds.resize(count.max(self.speeds.len()), None);
        self.others.clear();
        for body in bodies {
            let speed = body.velocity.norm();
            let before = self.speeds[body.id].replace(speed).filter(|_| dt > 0.0);
            self.others.push(RoadUser {
                pose: pose.then(&Pose { position: body.position, heading: body.heading }),
                half_length: body.outline.half_extent().x,
                speed,
                acceleration: before.map_or(0.0, |before| (speed - before) / dt),
            });
        }
        self.last = now;
    }

    /// Returns the metres to the place before a passage, or in it, where the car has to stop.
    fn stop_before(&self, passage: &Passage, motion: &Motion, room: f64) -> Option<f64> {
        let motion = Motion { fastest: motion.fastest.min(passage.speed), ..*motion };
        let line = passage.from - BEFORE - motion.front;
        let can_stop = line + 0.5 * BEFORE > 0.5 * motion.speed * motion.speed / FIRM;
        if can_stop {
            let needed = passage.to - motion.front + 2.0 * self.half_length + BEHIND;
            let yields = passage.conflicts.iter().any(|conflict| conflict.gives_way);
            let free = |conflict: &Conflict| self.coming(conflict).all(|other| self.lets_go(conflict, &motion, &other));
            let go = (!yields || room >= needed) && passage.conflicts.iter().all(free);
            return (!go).then_some(line.max(0.0));
        }
        let ahead = passage.conflicts.iter().filter(|conflict| conflict.from > motion.front);
        let blocked = ahead.filter(|conflict| self.coming(conflict).any(|other| motion.meets(conflict, &other)));
        blocked.map(|conflict| (conflict.from - 0.5 * BEFORE - motion.front).max(0.0)).reduce(f64::min)
    }

    /// Returns the road users who come to a conflict or are in it.
    fn coming(&self, conflict: &Conflict) -> impl Iterator<Item = Coming> {
        let coming = self.navigation.iter().flat_map(|Navigation { network, .. }| {
            self.others.iter().filter_map(|other| {
                let place = conflict.place(&other.pose, network)?;
                Some(Coming {
                    to_conflict: conflict.theirs.0 - place - other.half_length,
                    to_exit: conflict.theirs.1 - place + other.half_length,
                    speed: other.speed,
                    acceleration: other.acceleration,
                })
            })
        });
        coming.filter(|coming| coming.to_exit > 0.0)
    }

    /// Returns `true` if another road user does not keep the car from entering a conflict.
    fn lets_go(&self, conflict: &Conflict, motion: &Motion, other: &Coming) -> bool {
        if motion.follows(conflict, other) {
            return true;
        }
        if !conflict.gives_way {
            let sets_out = other.acceleration > SPEEDING_UP && other.speed < SETTING_OUT;
            let waits = other.to_conflict > 0.5 * other.speed * other.speed / EXPECTED && !sets_out;
            return waits || !motion.meets(conflict, other);
        }
        let leaves = motion.time(conflict.to - motion.rear) + self.spare;
        if motion.impatient {
            let stands = other.speed < STANDING && other.acceleration < SPEEDING_UP && other.to_conflict > 0.0;
            return stands || other.arrives(other.acceleration.min(OTHERS)) > leaves;
        }
        let enters = motion.time(conflict.from - motion.front);
        other.arrives(other.acceleration.max(OTHERS)) > leaves.max(enters + self.critical_gap)
    }
}

impl Coming {
    /// Returns the seconds until the road user reaches the conflict with an acceleration; infinite if it stops before.
    fn arrives(&self, acceleration: f64) -> f64 {
        let (way, speed) = (self.to_conflict, self.speed);
        let square = speed * speed + 2.0 * acceleration * way;
        match way {
            way if way <= 0.0 => 0.0,
            _ if square <= 0.0 => f64::INFINITY,
            way => 2.0 * way / (speed + square.sqrt()),
        }
    }
}

impl Motion {
    /// Returns the seconds until the car has gone some metres.
    fn time(&self, way: f64) -> f64 {
        let (speed, acceleration) = (self.speed.min(self.fastest), self.acceleration);
        let gathering = (self.fastest * self.fastest - speed * speed) / (2.0 * acceleration);
        if way <= 0.0 {
            0.0
        } else if way < gathering {
            ((speed * speed + 2.0 * acceleration * way).sqrt() - speed) / acceleration
        } else {
            (self.fastest - speed) / acceleration + (way - gathering) / self.fastest
        }
    }

    /// Returns `true` if another road user will have gone by, or will be ahead, when the car comes to a conflict.
    fn follows(&self, conflict: &Conflict, other: &Coming) -> bool {
        let enters = self.time(conflict.from - self.front);
        match conflict.joins {
            Some((end, other_end)) => {
                // The metres from the other's rear to the end of its lane, and from the car's front to that of its own.
                let rear = other.to_exit + other_end - conflict.theirs.1 - other.speed * enters;
                rear + BEHIND < end - conflict.from.max(self.front)
            }
            None => other.speed > 0.0 && other.to_exit / other.speed + AFTER < enters,
        }
    }

    /// Returns `true` if another road user, at its present speed, comes to a conflict before the car has left it.
    fn meets(&self, conflict: &Conflict, other: &Coming) -> bool {
        let leaves = self.time(conflict.to - self.rear) + AFTER;
        let stays = other.speed < STANDING && other.to_conflict > 0.0;
        !stays && other.arrives(0.0) < leaves && !self.follows(conflict, other)
    }
}
