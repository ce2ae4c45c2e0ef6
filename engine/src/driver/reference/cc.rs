//! The driver `cc`: the competent and careful human driver of UN Regulation No. 157, Annex 4, Appendix 3.
//!
//! The driver goes through three phases.
//!
//! 1. *Perception.* The driver notices that the other road user comes over once its middle is more than 0.375 m from
//!    the middle of its own lane, which is as far as cars wander. The driver takes 0.4 s to evaluate the risk. There is
//!    a risk if the time to collision is at most 2 s, or if the other brakes with 5 m/s² or more.
//! 2. *Decision.* 0.75 s pass until the brakes act. Meanwhile the foot is off the pedal and the car loses 0.4 m/s².
//! 3. *Reaction.* The deceleration rises by 12.65 m/s³ (in 0.6 s) to 0.774 g and stays there until the danger is over.
//!
//! Our reading: The other's own lane is the next lane. So the other has left its wandering zone if its middle is nearer
//! than a lane's width less 0.375 m and comes nearer, or if it is in the path already. Both conditions of step 1 must
//! hold at the same moment; after that the driver does not change its mind. The danger is over when the other is no
//! longer ahead and in the way, or the gap no longer shrinks and the other does not brake. The 0.85 g in the table's
//! row for vehicles that overlap wholly belong to an emergency brake (UN R152) and are left out.

use super::super::{Descriptor, Setting, setting};
use super::adapter::Reference;
use super::held::Held;
use crate::kinematic::{BrakingModel, LANE_WIDTH, Situation};
use crate::vehicle::GRAVITY;

/// The competent and careful human driver of UN R157; lengths in metres, times in seconds, accelerations in m/s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cc {
    /// The width of the lanes in metres.
    pub lane_width: f64,
    /// The greatest distance in metres that cars wander from the middle of their lane.
    pub wandering: f64,
    /// The time in seconds that the driver takes to evaluate the risk.
    pub evaluation: f64,
    /// The greatest time to collision that is a risk, in seconds.
    pub ttc: f64,
    /// The least deceleration of the other road user that is a risk at any time to collision, in m/s².
    pub leader_deceleration: f64,
    /// The time in seconds from the decision to brake until the brakes act.
    pub reaction: f64,
    /// The car's deceleration in m/s² from the decision to brake until the brakes act.
    pub release: f64,
    /// The full deceleration of the car, in m/s².
    pub deceleration: f64,
    /// The rate at which the deceleration rises, in m/s³.
    pub jerk: f64,
    seen: Held,
    braking: Held,
    alarmed: bool,
    brake: f64,
}

const STANDARD: Cc = Cc {
    lane_width: LANE_WIDTH,
    wandering: 0.375,
    evaluation: 0.4,
    ttc: 2.0,
    leader_deceleration: 5.0,
    reaction: 0.75,
    release: 0.4,
    deceleration: 0.774 * GRAVITY,
    jerk: 12.65,
    seen: Held::NEVER,
    braking: Held::NEVER,
    alarmed: false,
    brake: 0.0,
};

pub(in super::super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "cc",
    about: "brakes like the competent and careful human driver of UN R157, and is told the ground truth",
    settings: &SETTINGS,
    make: |settings| {
        Reference::boxed(Cc {
            lane_width: settings.get("lane_width"),
            wandering: settings.get("wandering"),
            evaluation: settings.get("evaluation"),
            ttc: settings.get("ttc"),
            leader_deceleration: settings.get("leader_deceleration"),
            reaction: settings.get("reaction"),
            release: settings.get("release"),
            deceleration: settings.get("deceleration"),
            jerk: settings.get("jerk"),
            ..STANDARD
        })
    },
};

const SETTINGS: [Setting; 9] = [
    setting("lane_width", STANDARD.lane_width, "m", (0.0, 10.0), "width of the lanes"),
    setting("wandering", STANDARD.wandering, "m", (0.0, 10.0), "how far cars wander in their lane"),
    setting("evaluation", STANDARD.evaluation, "s", (0.0, 5.0), "time to evaluate a risk"),
    setting("ttc", STANDARD.ttc, "s", (0.0, 30.0), "time to collision at or below which there is a risk"),
    setting(
        "leader_deceleration",
        STANDARD.leader_deceleration,
        "m/s^2",
        (0.0, 20.0),
        "deceleration of the other road user that is a risk",
    ),
    setting("reaction", STANDARD.reaction, "s", (0.0, 5.0), "time from the decision to brake until the brakes act"),
    setting("release", STANDARD.release, "m/s^2", (0.0, 20.0), "deceleration from the decision until the brakes act"),
    setting("deceleration", STANDARD.deceleration, "m/s^2", (0.0, 20.0), "full deceleration"),
    setting("jerk", STANDARD.jerk, "m/s^3", (1.0, 1000.0), "rate at which the deceleration rises"),
];

impl Default for Cc {
    fn default() -> Self {
        STANDARD
    }
}

impl BrakingModel for Cc {
    fn brake(&mut self, s: &Situation, dt: f64) -> f64 {
        let comes_over = s.approach > 0.0 && s.lateral < self.lane_width - self.wandering;
        let in_the_way = s.is_ahead() && (comes_over || s.overlaps());
        let evaluated = self.seen.lasts(in_the_way, self.evaluation, dt);
        let risk = s.time_to_collision() <= self.ttc || s.other_acceleration <= -self.leader_deceleration;
        let danger = in_the_way && (s.closing() > 0.0 || s.other_acceleration < 0.0);
        self.alarmed = danger && (self.alarmed || evaluated && risk);
        let wanted = match self.braking.lasts(self.alarmed, self.reaction, dt) {
            true => self.deceleration,
            false if self.alarmed => self.release,
            false => 0.0,
        };
        let change = self.jerk * dt;
        self.brake = wanted.clamp(self.brake - change, self.brake + change);
        self.brake
    }
}
