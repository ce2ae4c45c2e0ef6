//! Bodies that the driver sees too late, and tracks that it loses.

use crate::chance::unit;
use crate::flaw::{Flaw, SAME_TIME, flawed};
use crate::kind::Kind;
use nalgebra::Vector2;
use paracosm_engine::driver::hidden;
use paracosm_engine::object::Class;
use paracosm_engine::{Briefing, Observation, Other};
use std::collections::VecDeque;

/// The distance in metres up to which a body is in sight.
const IN_SIGHT: f64 = 150.0;
/// The speed in rad/s from which on the car turns.
const TURNING: f64 = 0.05;
/// The seconds after a change of its class in which a body has no history.
const NO_HISTORY: f64 = 0.5;

pub(crate) const LATE_DETECTION: Kind = Kind {
    name: "late-detection",
    about: "sees a body only after the body has been in sight without a break for as long as the size; \
            in sight is ahead, within 150 m and not hidden",
    unit: "s",
    sizes: &[0.2, 0.4, 0.7, 1.0, 1.5, 2.2, 3.0, 5.0],
    source: "fault model: confirmation of a track",
    make: |after, driver| flawed(driver, Late { after, front: 0.0, since: Vec::new() }),
};

struct Late {
    after: f64,
    /// The distance in metres from the middle of the car to its front.
    front: f64,
    /// The times since which bodies have been in sight, by the numbers of the bodies.
    since: Vec<Option<f64>>,
}

impl Flaw for Late {
    const SEES: bool = true;

    fn reset(&mut self, briefing: &Briefing) {
        self.front = 0.5 * briefing.vehicle.length;
        self.since.clear();
    }

    fn see(&mut self, seen: &mut Observation) {
        let count = seen.others.iter().map(|body| body.id + 1).max().unwrap_or(0);
        self.since.resize(count.max(self.since.len()), None);
        for body in &seen.others {
            let is_ahead = body.position.x > 0.0 && body.position.norm() <= IN_SIGHT;
            let in_sight = is_ahead && !hidden(body, seen, self.front);
            self.since[body.id] = in_sight.then(|| self.since[body.id].unwrap_or(seen.time));
        }
        let known = seen.time - self.after + SAME_TIME;
        seen.others.retain(|body| self.since[body.id].is_some_and(|since| since <= known));
    }
}

pub(crate) const LOST_IN_TURNS: Kind = Kind {
    name: "lost-in-turns",
    about: "sees no body while it turns faster than 0.05 rad/s, and after that for as long as the size",
    unit: "s",
    sizes: &[0.1, 0.3, 0.6, 1.0, 1.5, 2.5, 4.0],
    source: "fault model: tracks are not turned with the car",
    make: |after, driver| flawed(driver, Turns { after, last: None, blind_until: f64::NEG_INFINITY }),
};

struct Turns {
    after: f64,
    /// The time and the heading at the last question.
    last: Option<(f64, f64)>,
    blind_until: f64,
}

impl Flaw for Turns {
    const SEES: bool = true;

    fn reset(&mut self, _briefing: &Briefing) {
        (self.last, self.blind_until) = (None, f64::NEG_INFINITY);
    }

    fn see(&mut self, seen: &mut Observation) {
        let (time, heading) = (seen.time, seen.odometry.heading);
        if let Some((before, from)) = self.last.replace((time, heading)) {
            // A heading may jump by a full turn.
            let turned = libm::remainder(heading - from, std::f64::consts::TAU).abs();
            if turned > TURNING * (time - before) {
                self.blind_until = time + self.after;
            }
        }
        if time <= self.blind_until + SAME_TIME {
            seen.others.clear();
        }
    }
}

pub(crate) const RECLASSIFIED: Kind = Kind {
    name: "reclassified",
    about: "takes each body for an unknown thing that stands still, for 0.5 s, again and again; \
            the size is the time from one such change of class to the next",
    unit: "s",
    sizes: &[5.0, 3.0, 2.0, 1.5, 1.0, 0.7, 0.6, 0.5],
    source: "NTSB/HAR-19/03 (Tempe: the class of a pedestrian alternated, and each change dropped the tracking history)",
    make: |every, driver| flawed(driver, Reclassified { every }),
};

struct Reclassified {
    every: f64,
}

impl Flaw for Reclassified {
    const SEES: bool = true;

    fn see(&mut self, seen: &mut Observation) {
        let time = seen.time + SAME_TIME;
        for body in &mut seen.others {
            // The bodies change at different times.
            if libm::fmod(time + self.every * unit(0, body.id), self.every) < NO_HISTORY {
                (body.class, body.velocity) = (Class::Prop, Vector2::zeros());
            }
        }
    }
}

pub(crate) const STALE_WORLD: Kind = Kind {
    name: "stale-world",
    about: "sees the bodies where they were, as seen from the car at that time; the size is the age of the data",
    unit: "s",
    sizes: &[0.1, 0.2, 0.35, 0.5, 0.8, 1.2, 2.0, 3.0],
    source: "fault model: latency of a sensor that nobody compensates",
    make: |age, driver| flawed(driver, Stale { age, frames: VecDeque::new(), spare: Vec::new() }),
};

struct Stale {
    age: f64,
    /// The bodies of earlier steps with their times, the oldest first. The driver sees the first.
    frames: VecDeque<(f64, Vec<Other>)>,
    /// Lists that are no longer needed, kept for their memory.
    spare: Vec<Vec<Other>>,
}

impl Flaw for Stale {
    const SEES: bool = true;

    fn reset(&mut self, _briefing: &Briefing) {
        self.spare.extend(self.frames.drain(..).map(|(_, frame)| frame));
    }

    fn see(&mut self, seen: &mut Observation) {
        let mut frame = self.spare.pop().unwrap_or_default();
        frame.clone_from(&seen.others);
        self.frames.push_back((seen.time, frame));
        let known = seen.time - self.age + SAME_TIME;
        while self.frames.get(1).is_some_and(|(time, _)| *time <= known) {
            self.spare.extend(self.frames.pop_front().map(|(_, frame)| frame));
        }
        seen.others.clone_from(&self.frames[0].1);
    }
}
