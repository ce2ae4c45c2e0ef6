//! The driver `rss`: Responsibility-Sensitive Safety (Shalev-Shwartz, Shammah, Shashua 2017).
//!
//! A situation is dangerous if neither the distance along the road nor the distance across it is safe, even if both
//! road users do their worst in the response time rho. Along the road, the ego vehicle speeds up with `a` during rho
//! and then brakes with at least `b_min`, while the other brakes with at most `b_max` at once:
//!
//! `d = v rho + a rho² / 2 + (v + rho a)² / (2 b_min) - v_f² / (2 b_max)`, or 0 if that is negative.
//!
//! Across the road, the other moves towards the car, speeds up sideways with `a_lat` during rho and then brakes sideways
//! with at least `b_lat`; the remaining distance must be at least mu. The proper response to danger is, after rho, to
//! brake until the distance is safe again.
//!
//! The numbers are those that the Joint Research Centre of the European Commission uses with UN R157's scenarios
//! (`JRC-FSM`, version 01b05c2): rho 0.75 s, a 3 m/s², `b_min` and `b_max` 6 m/s², mu 0.3 m, `a_lat` and `b_lat` 1 m/s².
//! The car brakes harder than the `b_min` on which the distance counts: with 0.774 g, reached with 12.65 m/s³. The car
//! itself does not speed up sideways; in the paper both road users do, and `own_lateral` sets this. Others use 0.2 m/s²
//! for the lateral accelerations and 0.8 m/s² for `b_lat`.
//!
//! Our reading: The ego vehicle keeps its speed during rho and never answers sideways. It has no speed across the road.
//! Another is ahead as long as its middle is ahead of the car's. Another that comes towards the car counts as standing
//! (the paper has its own rule for that).

use super::super::{Descriptor, Setting, setting};
use super::adapter::Reference;
use super::held::Held;
use crate::kinematic::{BrakingModel, Situation};
use crate::vehicle::GRAVITY;

/// The driver that keeps the safe distances of RSS; lengths in metres, times in seconds, accelerations in m/s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rss {
    /// The response time rho in seconds, in which no road user is expected to respond.
    pub response: f64,
    /// The acceleration a in m/s² with which the ego vehicle may speed up during the response time.
    pub acceleration: f64,
    /// The least deceleration `b_min` in m/s² of the car after the response time: the safe distance counts on it.
    pub least_deceleration: f64,
    /// The deceleration in m/s² with which the car brakes after the response time.
    pub deceleration: f64,
    /// The rate at which the deceleration changes, in m/s³.
    pub jerk: f64,
    /// The greatest deceleration `b_max` of the other road user, in m/s².
    pub leader_deceleration: f64,
    /// The lateral distance mu in metres that must remain between the car and the other road user.
    pub lateral_margin: f64,
    /// The lateral acceleration `a_lat` of the other road user during the response time, in m/s².
    pub lateral_acceleration: f64,
    /// The lateral acceleration of the car during the response time, in m/s².
    pub own_lateral: f64,
    /// The lateral deceleration `b_lat` of both road users after the response time, in m/s².
    pub lateral_deceleration: f64,
    danger: Held,
    brake: f64,
}

const STANDARD: Rss = Rss {
    response: 0.75,
    acceleration: 3.0,
    least_deceleration: 6.0,
    deceleration: 0.774 * GRAVITY,
    jerk: 12.65,
    leader_deceleration: 6.0,
    lateral_margin: 0.3,
    lateral_acceleration: 1.0,
    own_lateral: 0.0,
    lateral_deceleration: 1.0,
    danger: Held::NEVER,
    brake: 0.0,
};

pub(in super::super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "rss",
    about: "keeps the distances of Responsibility-Sensitive Safety, and is told the ground truth",
    settings: &SETTINGS,
    make: |settings| {
        Reference::boxed(Rss {
            response: settings.get("response"),
            acceleration: settings.get("acceleration"),
            least_deceleration: settings.get("least_deceleration"),
            deceleration: settings.get("deceleration"),
            jerk: settings.get("jerk"),
            leader_deceleration: settings.get("leader_deceleration"),
            lateral_margin: settings.get("lateral_margin"),
            lateral_acceleration: settings.get("lateral_acceleration"),
            own_lateral: settings.get("own_lateral"),
            lateral_deceleration: settings.get("lateral_deceleration"),
            ..STANDARD
        })
    },
};

const SETTINGS: [Setting; 10] = [
    setting("response", STANDARD.response, "s", (0.0, 5.0), "response time"),
    setting(
        "acceleration",
        STANDARD.acceleration,
        "m/s^2",
        (0.0, 20.0),
        "acceleration of the car during the response time",
    ),
    setting(
        "least_deceleration",
        STANDARD.least_deceleration,
        "m/s^2",
        (0.1, 20.0),
        "deceleration of the car on which the safe distance counts",
    ),
    setting(
        "deceleration",
        STANDARD.deceleration,
        "m/s^2",
        (0.1, 20.0),
        "deceleration of the car after the response time",
    ),
    setting("jerk", STANDARD.jerk, "m/s^3", (1.0, 1000.0), "rate at which the deceleration changes"),
    setting(
        "leader_deceleration",
        STANDARD.leader_deceleration,
        "m/s^2",
        (0.1, 20.0),
        "greatest deceleration of the other road user",
    ),
    setting("lateral_margin", STANDARD.lateral_margin, "m", (0.0, 10.0), "room that must remain beside the other"),
    setting(
        "lateral_acceleration",
        STANDARD.lateral_acceleration,
        "m/s^2",
        (0.0, 20.0),
        "lateral acceleration of the other road user during the response time",
    ),
    setting(
        "own_lateral",
        STANDARD.own_lateral,
        "m/s^2",
        (0.0, 20.0),
        "lateral acceleration of the car during the response time",
    ),
    setting(
        "lateral_deceleration",
        STANDARD.lateral_deceleration,
        "m/s^2",
        (0.1, 20.0),
        "lateral deceleration of either after the response time",
    ),
];

impl Default for Rss {
    fn default() -> Self {
        STANDARD
    }
}

impl Rss {
    /// Returns the safe distance in metres behind another road user, at the given speeds in m/s.
    pub fn longitudinal_distance(&self, speed: f64, other_speed: f64) -> f64 {
        let rho = self.response;
        let (fastest, front) = (speed + rho * self.acceleration, other_speed.max(0.0));
        let own =
            speed * rho + 0.5 * self.acceleration * rho * rho + fastest * fastest / (2.0 * self.least_deceleration);
        (own - front * front / (2.0 * self.leader_deceleration)).max(0.0)
    }

    /// Returns the safe lateral distance in metres to a road user that comes nearer by `approach` m/s sideways.
    pub fn lateral_distance(&self, approach: f64) -> f64 {
        // The way towards each other, from a given speed towards each other.
        let way = |speed: f64, acceleration: f64| {
            let fastest = speed + self.response * acceleration;
            let coming_to_rest = fastest * fastest.abs() / (2.0 * self.lateral_deceleration);
            0.5 * (speed + fastest) * self.response + coming_to_rest
        };
        self.lateral_margin + (way(0.0, self.own_lateral) + way(approach, self.lateral_acceleration)).max(0.0)
    }
}

impl BrakingModel for Rss {
    fn brake(&mut self, s: &Situation, dt: f64) -> f64 {
        let danger = s.gap > -0.5 * s.lengths
            && s.gap < self.longitudinal_distance(s.speed, s.other_speed)
            && s.clearance() < self.lateral_distance(s.approach);
        let wanted = if self.danger.lasts(danger, self.response, dt) { self.deceleration } else { 0.0 };
        let change = self.jerk * dt;
        self.brake = wanted.clamp(self.brake - change, self.brake + change);
        self.brake
    }
}
