//! The driver `reg157`: it does what UN Regulation No. 157 (5.2.5.2) asks of an automated lane keeping system, no more.
//!
//! A collision with a car that cuts in must be avoided if, when that car has come 0.3 m into the lane,
//! `TTC_LaneIntrusion > v_rel / (2 * 6 m/s²) + 0.35 s`. A system meets this exactly if it brakes with 6 m/s² from
//! 0.35 s after that moment on until it is no faster than the other: in `0.35 s` it uses up `0.35 v_rel` of the gap and
//! then `v_rel² / 12`. That system is the driver.
//!
//! Our reading: It reacts to every slower road user in the lane, however far ahead, since the condition names no other
//! reason to wait. The brakes act in full at once, since the condition leaves no time for them to build up. It does its
//! best also if the regulation asks nothing of it (a movement that was visible for less than 0.72 s). The intrusion is
//! that of the other's body, which stands for its front wheel.

use super::super::{Descriptor, Setting, setting};
use super::adapter::Reference;
use super::held::Held;
use crate::kinematic::{BrakingModel, LANE_WIDTH, Situation};

/// The least capable driver that UN R157 allows; lengths in metres, times in seconds, accelerations in m/s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reg157 {
    /// The width of the lanes in metres.
    pub lane_width: f64,
    /// The distance in metres by which the other road user must have come into the lane.
    pub intrusion: f64,
    /// The time in seconds from the intrusion until the brakes act.
    pub reaction: f64,
    /// The deceleration of the car, in m/s².
    pub deceleration: f64,
    intruded: Held,
}

const STANDARD: Reg157 =
    Reg157 { lane_width: LANE_WIDTH, intrusion: 0.3, reaction: 0.35, deceleration: 6.0, intruded: Held::NEVER };

pub(in super::super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "reg157",
    about: "brakes as late and as little as UN R157 allows, and is told the ground truth",
    settings: &SETTINGS,
    make: |settings| {
        Reference::boxed(Reg157 {
            lane_width: settings.get("lane_width"),
            intrusion: settings.get("intrusion"),
            reaction: settings.get("reaction"),
            deceleration: settings.get("deceleration"),
            ..STANDARD
        })
    },
};

const SETTINGS: [Setting; 4] = [
    setting("lane_width", STANDARD.lane_width, "m", (0.0, 10.0), "width of the lanes"),
    setting("intrusion", STANDARD.intrusion, "m", (0.0, 10.0), "distance that the other must have come into the lane"),
    setting("reaction", STANDARD.reaction, "s", (0.0, 5.0), "time from the intrusion until the brakes act"),
    setting("deceleration", STANDARD.deceleration, "m/s^2", (0.0, 20.0), "deceleration of the car"),
];

impl Default for Reg157 {
    fn default() -> Self {
        STANDARD
    }
}

impl BrakingModel for Reg157 {
    fn brake(&mut self, s: &Situation, dt: f64) -> f64 {
        let depth = 0.5 * (self.lane_width + s.other_width) - s.lateral;
        let intruded = s.is_ahead() && depth >= self.intrusion && s.closing() > 0.0;
        if self.intruded.lasts(intruded, self.reaction, dt) { self.deceleration } else { 0.0 }
    }
}
