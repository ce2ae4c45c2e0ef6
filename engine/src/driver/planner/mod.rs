//! The driver `planner`: it takes junctions and roundabouts, follows others at a headway, and stops for road users in
//! its way. It is told the ground truth and the map of the roads. It shows which tests of a scenario a careful driver
//! passes.
//!
//! Each reason to slow down gives an acceleration, and the least of them applies:
//!
//! - the set speed and the road users in the way, by the intelligent driver model ([`Idm`]; Treiber, Hennecke, Helbing,
//!   "Congested traffic states in empirical observations and microscopic simulations", Phys. Rev. E 62, 2000);
//! - bends, which the car takes at a comfortable lateral acceleration;
//! - road users who come into the way, if both keep their velocities ([`crossing`]);
//! - conflicts with other lanes, by gap acceptance ([`junction`]).
//!
//! The driver ignores a body until the line from the car's front to the body's middle has been free of large bodies
//! once, as the reference drivers do.
//!
//! The sources of the numbers:
//!
//! | setting | source |
//! | --- | --- |
//! | acceleration 2 m/s² | the most that ISO 15622 lets an adaptive cruise control use at high speed |
//! | deceleration 2 m/s², headway 1.5 s, gap 2 m | the values of traffic cars; Treiber et al. 2000 give 1.67 m/s², 1.6 s and 2 m for a motorway |
//! | lateral 2 m/s² | chosen: the limit that `cruise` has, too |
//! | braking 9 m/s² | the tyres of a car hold some 0.9 g on dry asphalt |
//! | critical_gap 5 s | Highway Capacity Manual, 6th edition, chapter 22: a critical headway of 4.98 s at a roundabout with one lane; at a stop sign it is 6.2 to 7.1 s from standstill (chapter 20) |
//! | spare 1.5 s | chosen: the car has left the conflict so long before the other arrives |
//! | patience 4 s | chosen: half the time after which traffic cars lose their patience |
//! | horizon 3 s, margin 0.3 m | chosen as for the reference drivers, which look for those who come over within 3 s |

mod crossing;
mod junction;
mod passage;
#[cfg(test)]
mod tests;

use super::cruise::{Cruise, PERIOD};
use super::perception::hidden;
use super::{Descriptor, Driver, Fault, Setting, Settings, setting};
use crate::observation::{Briefing, Control, Observation, Other, Way};
use crate::traffic::Idm;
use crossing::{Crossing, Room};
use junction::Junctions;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "planner",
    about: "takes junctions and roundabouts, keeps its headway and stops for others; is told the ground truth and the map",
    settings: &SETTINGS,
    make: |settings| Box::new(Planner::new(settings)),
};

const SETTINGS: [Setting; 11] = [
    setting("acceleration", 2.0, "m/s^2", (0.1, 10.0), "acceleration from standstill on a free road"),
    setting("deceleration", 2.0, "m/s^2", (0.1, 10.0), "comfortable deceleration"),
    setting("headway", 1.5, "s", (0.0, 10.0), "time headway to a road user ahead"),
    setting("gap", 2.0, "m", (0.5, 20.0), "gap to a road user ahead when both stand"),
    setting("lateral", 2.0, "m/s^2", (0.1, 10.0), "lateral acceleration in bends"),
    setting("braking", 9.0, "m/s^2", (1.0, 20.0), "greatest deceleration that the driver asks for"),
    setting("critical_gap", 5.0, "s", (0.0, 20.0), "least time until the next road user with the right of way arrives"),
    setting("spare", 1.5, "s", (0.0, 10.0), "time before that arrival at which the car has left the conflict"),
    setting(
        "patience",
        4.0,
        "s",
        (0.0, 60.0),
        "waiting time after which the driver no longer lets standing cars go first",
    ),
    setting("horizon", 3.0, "s", (0.0, 10.0), "time for which the driver predicts who comes into its way"),
    setting("margin", 0.3, "m", (0.0, 5.0), "room that the driver wants beside the car"),
];

/// The time in seconds in which the car takes up the speed of a bend.
const BEND: f64 = 0.5;

struct Planner {
    cruise: Cruise,
    set_speed: f64,
    idm: Idm,
    lateral: f64,
    braking: f64,
    half_length: f64,
    crossing: Crossing,
    junctions: Junctions,
    /// `true` for each body that the driver has seen.
    seen: Vec<bool>,
    /// The present states of these bodies.
    bodies: Vec<Other>,
}

impl Planner {
    fn new(settings: &Settings) -> Self {
        Self {
            cruise: Cruise::default(),
            set_speed: 0.0,
            idm: Idm {
                acceleration: settings.get("acceleration"),
                deceleration: settings.get("deceleration"),
                headway: settings.get("headway"),
                gap: settings.get("gap"),
                ..Idm::default()
            },
            lateral: settings.get("lateral"),
            braking: settings.get("braking"),
            half_length: 0.0,
            crossing: Crossing::new(settings),
            junctions: Junctions::new(settings),
            seen: Vec::new(),
            bodies: Vec::new(),
        }
    }

    /// Takes in the bodies that the driver can see, or has seen before.
    fn look(&mut self, observation: &Observation) {
        let bodies = observation.others.iter().map(|other| other.id + 1).max().unwrap_or(0);
        self.seen.resize(bodies.max(self.seen.len()), false);
        self.bodies.clear();
        for other in &observation.others {
            let seen = &mut self.seen[other.id];
            *seen = *seen || !hidden(other, observation, self.half_length);
            self.bodies.extend(seen.then_some(*other));
        }
    }

    /// Returns the acceleration in m/s² with which the car reaches every bend at its comfortable speed.
    fn for_bends(&self, observation: &Observation) -> f64 {
        let speed = observation.speed;
        let bends = observation.way.ahead.iter().enumerate().filter(|(_, point)| point.curvature != 0.0);
        let slower = bends.map(|(i, point)| {
            let allowed = (self.lateral / point.curvature.abs()).sqrt();
            let way = (Way::SPACING * i as f64 - BEND * speed).max(0.0);
            let allowed = (allowed * allowed + 2.0 * self.idm.deceleration * way).sqrt();
            (allowed - speed) / BEND
        });
        slower.fold(f64::INFINITY, f64::min).max(-self.braking)
    }
}

impl Driver for Planner {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.set_speed = briefing.cruise_speed;
        self.cruise.reset(briefing)?;
        self.half_length = 0.5 * briefing.vehicle.length;
        self.seen.clear();
        self.crossing.reset(briefing);
        self.junctions.reset(briefing, &self.idm, self.lateral);
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let free = self.idm.free(observation.speed, self.set_speed);
        self.look(observation);
        let mut acceleration = free.min(self.for_bends(observation));
        let mut least = f64::INFINITY;
        for Room { gap, speed } in self.crossing.rooms(observation, &self.bodies) {
            let following = self.idm.following(observation.speed, self.set_speed, gap, speed);
            acceleration = acceleration.min(following);
            // A body that brakes as hard as it can still needs this way.
            least = least.min(gap + 0.5 * speed.max(0.0) * speed / self.braking);
        }
        if let Some(gap) = self.junctions.stop(observation, &self.bodies, least) {
            let stopping = self.idm.following(observation.speed, self.set_speed, gap + self.idm.gap, 0.0);
            acceleration = acceleration.min(stopping);
        }
        Ok(self.cruise.control(acceleration.max(-self.braking), observation))
    }
}
