//! The driver `cc`: the competent and careful human driver of UN Regulation No. 157, Annex 4, Appendix 3.
//!
//! The driver goes through three phases.
//!
//! 1. *Perception.* The driver notices a risk. If another road user comes over from the side, there is a risk once the
//!    other is in the car's path and the time to collision is at most 2 s. If the other is in the lane from the first
//!    sight on, there is a risk at once: a leader that brakes, or a body that a leader uncovers by leaving the lane.
//! 2. *Decision.* 0.75 s pass until the brakes act. Meanwhile the foot is off the pedal and the car loses 0.4 m/s².
//! 3. *Reaction.* The deceleration rises by 12.65 m/s³ (in 0.6 s) to 0.774 g and stays there until the danger is over.
//!
//! The times, 0.774 g and the jerk are numbers of the regulation. The 0.4 m/s², and the moments at which there is a
//! risk, are those of the model as the Joint Research Centre of the European Commission has published it (`JRC-FSM`,
//! version 01b05c2). The regulation has more conditions, which are settings here:
//!
//! - The other counts once its middle is more than 0.375 m from the middle of its own lane, as far as cars wander: set
//!   `lane_width`. The other has left its wandering zone if its middle is nearer than a lane's width less 0.375 m and
//!   comes nearer. With the default of 0 the driver waits until the other is in the path.
//! - The driver takes 0.4 s to evaluate the risk of somebody who comes over: set `evaluation`.
//! - Only a leader that brakes with 5 m/s² or more counts as braking: set `leader_deceleration`. The published model
//!   reacts to any deceleration. A car that slows down by no more than 0.4 m/s² has only let go of the pedal.
//!
//! Our reading: The model tells the cases apart by the other's way across the lane, and not by a scenario. A body that is
//! outside the path when first seen, and comes in, comes from the side until its sideways motion has ended. After that it
//! is a leader. A body that comes over and brakes in the path is a leader, too. `horizon` limits what "at once" means: a
//! collision that is more than 10 s ahead is no risk yet, also if the other goes on braking. In the published encounters
//! nothing depends on this limit. The conditions of step 1 must hold at the same moment; after that the driver does not
//! change its mind. The danger is over when the other is no longer ahead and in the way, or the gap no longer shrinks and
//! the other does not brake. The 0.85 g in the table's row for vehicles that overlap wholly belong to an emergency brake
//! (UN R152) and are left out.

use super::super::{Descriptor, Setting, setting};
use super::adapter::Reference;
use super::held::Held;
use crate::kinematic::{BrakingModel, Situation};
use crate::vehicle::GRAVITY;

/// The competent and careful human driver of UN R157; lengths in metres, times in seconds, accelerations in m/s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cc {
    /// The width of the lanes in metres; 0 if the driver waits until the other is in the path.
    pub lane_width: f64,
    /// The greatest distance in metres that cars wander from the middle of their lane.
    pub wandering: f64,
    /// The time in seconds that the driver takes to evaluate the risk of somebody who comes over.
    pub evaluation: f64,
    /// The greatest time to collision with somebody who comes over that is a risk, in seconds.
    pub ttc: f64,
    /// The greatest time to collision with somebody in the lane that is a risk, in seconds.
    pub horizon: f64,
    /// The least deceleration of the other road user that counts as braking, in m/s².
    pub leader_deceleration: f64,
    /// The time in seconds from the decision to brake until the brakes act.
    pub reaction: f64,
    /// The car's deceleration in m/s² from the decision to brake until the brakes act.
    pub release: f64,
    /// The full deceleration of the car, in m/s².
    pub deceleration: f64,
    /// The rate at which the deceleration rises, in m/s³.
    pub jerk: f64,
    seen: bool,
    in_lane: bool,
    perceived: Held,
    braking: Held,
    alarmed: bool,
    brake: f64,
}

const STANDARD: Cc = Cc {
    lane_width: 0.0,
    wandering: 0.375,
    evaluation: 0.0,
    ttc: 2.0,
    horizon: 10.0,
    leader_deceleration: 0.4,
    reaction: 0.75,
    release: 0.4,
    deceleration: 0.774 * GRAVITY,
    jerk: 12.65,
    seen: false,
    in_lane: false,
    perceived: Held::NEVER,
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
            horizon: settings.get("horizon"),
            leader_deceleration: settings.get("leader_deceleration"),
            reaction: settings.get("reaction"),
            release: settings.get("release"),
            deceleration: settings.get("deceleration"),
            jerk: settings.get("jerk"),
            ..STANDARD
        })
    },
};

const SETTINGS: [Setting; 10] = [
    setting(
        "lane_width",
        STANDARD.lane_width,
        "m",
        (0.0, 10.0),
        "width of the lanes; 0: waits until the other is in the path",
    ),
    setting("wandering", STANDARD.wandering, "m", (0.0, 10.0), "how far cars wander in their lane"),
    setting("evaluation", STANDARD.evaluation, "s", (0.0, 5.0), "time to evaluate somebody who comes over"),
    setting(
        "ttc",
        STANDARD.ttc,
        "s",
        (0.0, 30.0),
        "time to collision at or below which somebody who comes over is a risk",
    ),
    setting(
        "horizon",
        STANDARD.horizon,
        "s",
        (0.0, 1000.0),
        "time to collision at or below which somebody in the lane is a risk",
    ),
    setting(
        "leader_deceleration",
        STANDARD.leader_deceleration,
        "m/s^2",
        (0.0, 20.0),
        "deceleration of the other road user that counts as braking",
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

impl Cc {
    /// Returns the seconds until a collision at the present speeds, if the other goes on braking as it does.
    fn time_to_collision(&self, s: &Situation) -> f64 {
        let deceleration = if self.brakes(s) { -s.other_acceleration } else { 0.0 };
        // The solution of `gap = closing t + deceleration t² / 2` that holds without deceleration, too.
        let closing = s.closing();
        let sum = closing + (closing * closing + 2.0 * deceleration * s.gap).sqrt();
        if s.is_ahead() && sum > 0.0 { 2.0 * s.gap / sum } else { f64::INFINITY }
    }

    fn brakes(&self, s: &Situation) -> bool {
        s.other_acceleration < 0.0 && s.other_acceleration <= -self.leader_deceleration
    }
}

impl BrakingModel for Cc {
    fn brake(&mut self, s: &Situation, dt: f64) -> f64 {
        // Somebody who comes over belongs to the lane once the sideways motion has ended there.
        let first_sight = !std::mem::replace(&mut self.seen, true);
        self.in_lane = s.overlaps() && (self.in_lane || first_sight || s.approach <= 0.0);
        let comes_over = s.approach > 0.0 && s.lateral < self.lane_width - self.wandering;
        let in_the_way = s.is_ahead() && (comes_over || s.overlaps());
        let perceived = self.perceived.lasts(in_the_way, self.evaluation, dt) || self.in_lane;
        let limit = if self.in_lane || self.brakes(s) { self.horizon } else { self.ttc };
        let risk = perceived && self.time_to_collision(s) <= limit;
        let danger = in_the_way && (s.closing() > 0.0 || self.brakes(s));
        self.alarmed = danger && (self.alarmed || risk);
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
