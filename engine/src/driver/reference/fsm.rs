//! The driver `fsm`: fuzzy surrogate safety measures (Mattas et al. 2020; performance model 2 of UN R157 as amended).
//!
//! The driver reacts to another road user that is ahead and in the car's path, or that comes into the path and would
//! meet the car there. The second means that the gap shrinks both ways and that the room beside is used up at most
//! 0.1 s after the car could have passed: `clearance / v_lat < (gap + lengths) / (v - v_f) + 0.1`.
//!
//! Two measures between 0 (safe) and 1 (unsafe) rate the danger. Each interpolates between a safe and an unsafe
//! distance. tau is the reaction time, `c` and `b` are the car's comfortable and hardest braking, and `f` is the
//! hardest braking of the other road user:
//!
//! - *proactive* (PFS), from the gap less `d1`: the distance that is left if the other road user brakes hardest.
//!   `safe = v tau + v²/(2 c) - v_f²/(2 f) + d1`, `unsafe = v tau + v²/(2 b) - v_f²/(2 f)`.
//! - *critical* (CFS), from the gap: the distance that is left if the other road user goes on with its present motion.
//!   With `a' = max(a, -c)` and `w = v + a' tau`, the safe distance is `((v + w)/2 - v_f) tau + (w - v_f)²/(2 c)`, and
//!   the unsafe distance is the same with `b`. If `w <= v_f`, both are `(v - v_f)²/(2 |a'|)`.
//!
//! The driver brakes with `c + CFS (b - c)` if CFS > 0, else with `PFS c`, after tau and with limited jerk.
//!
//! Our reading: tau is the time for which there has been a reason to brake without a break. After it the present
//! measures count. A car no faster than the other road user need not brake. The two margins of 2 m are the two places
//! of `d1`.

use super::super::{Descriptor, Setting, setting};
use super::adapter::Reference;
use super::held::Held;
use crate::kinematic::{BrakingModel, Situation};

/// The driver that brakes by fuzzy surrogate safety measures; lengths in m, times in s, accelerations in m/s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fsm {
    /// The reaction time tau of the driver, in seconds.
    pub reaction: f64,
    /// The comfortable deceleration c of the car, in m/s².
    pub comfortable: f64,
    /// The hardest deceleration b of the car, in m/s².
    pub deceleration: f64,
    /// The hardest deceleration f of the other road user, in m/s².
    pub leader_deceleration: f64,
    /// The distance d1 in metres that is to be left between the car and the other road user when both stand.
    pub margin: f64,
    /// The rate at which the deceleration changes, in m/s³.
    pub jerk: f64,
    reason: Held,
    brake: f64,
}

const STANDARD: Fsm = Fsm {
    reaction: 0.75,
    comfortable: 4.0,
    deceleration: 6.0,
    leader_deceleration: 7.0,
    margin: 2.0,
    jerk: 12.65,
    reason: Held::NEVER,
    brake: 0.0,
};

/// The seconds by which the other road user may be late and still count.
const LATE: f64 = 0.1;

pub(in super::super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "fsm",
    about: "brakes by the fuzzy surrogate safety measures of UN R157, and is told the ground truth",
    settings: &SETTINGS,
    make: |settings| {
        Reference::boxed(Fsm {
            reaction: settings.get("reaction"),
            comfortable: settings.get("comfortable"),
            deceleration: settings.get("deceleration"),
            leader_deceleration: settings.get("leader_deceleration"),
            margin: settings.get("margin"),
            jerk: settings.get("jerk"),
            ..STANDARD
        })
    },
};

const SETTINGS: [Setting; 6] = [
    setting("reaction", STANDARD.reaction, "s", (0.0, 5.0), "reaction time"),
    setting("comfortable", STANDARD.comfortable, "m/s^2", (0.1, 20.0), "comfortable deceleration"),
    setting("deceleration", STANDARD.deceleration, "m/s^2", (0.1, 20.0), "hardest deceleration"),
    setting(
        "leader_deceleration",
        STANDARD.leader_deceleration,
        "m/s^2",
        (0.1, 20.0),
        "hardest deceleration of the other road user",
    ),
    setting("margin", STANDARD.margin, "m", (0.0, 20.0), "distance that is to be left when both stand"),
    setting("jerk", STANDARD.jerk, "m/s^3", (1.0, 1000.0), "rate at which the deceleration changes"),
];

impl Default for Fsm {
    fn default() -> Self {
        STANDARD
    }
}

/// Returns 1 up to the unsafe distance, 0 from the safe distance on, and a linear interpolation between the two
/// distances.
fn unsafety(distance: f64, unsafe_below: f64, safe_from: f64) -> f64 {
    if distance <= unsafe_below {
        1.0
    } else if distance >= safe_from {
        0.0
    } else {
        (safe_from - distance) / (safe_from - unsafe_below)
    }
}

impl Fsm {
    /// Returns the proactive measure PFS, from 0 (safe) to 1, for a gap in metres and speeds in m/s.
    pub fn proactive(&self, gap: f64, speed: f64, other_speed: f64) -> f64 {
        let front = other_speed.max(0.0);
        let standing = speed * self.reaction - front * front / (2.0 * self.leader_deceleration);
        let safe = standing + speed * speed / (2.0 * self.comfortable) + self.margin;
        let unsafe_ = standing + speed * speed / (2.0 * self.deceleration);
        unsafety(gap - self.margin, unsafe_, safe)
    }

    /// Returns the critical measure CFS, from 0 (safe) to 1, for a gap in m, speeds in m/s and an acceleration in m/s².
    pub fn critical(&self, gap: f64, speed: f64, acceleration: f64, other_speed: f64) -> f64 {
        if speed <= other_speed {
            return 0.0;
        }
        let tau = self.reaction;
        let acceleration = acceleration.max(-self.comfortable);
        let next = speed + acceleration * tau;
        let excess = next - other_speed;
        if excess > 0.0 {
            let meanwhile = (0.5 * (speed + next) - other_speed) * tau;
            let then = |deceleration: f64| meanwhile + excess * excess / (2.0 * deceleration);
            return unsafety(gap, then(self.deceleration), then(self.comfortable));
        }
        let closing = speed - other_speed;
        let needed = closing * closing / (2.0 * acceleration.abs());
        unsafety(gap, needed, needed)
    }

    /// Returns `true` if the other road user is in the car's way, or would be there before the car has passed.
    fn looks_at(&self, s: &Situation) -> bool {
        let passing = (s.gap + s.lengths) / s.closing();
        let meets = s.approach > 0.0 && s.clearance() / s.approach < passing + LATE;
        s.is_ahead() && s.closing() > 0.0 && (s.overlaps() || meets)
    }

    /// Returns the deceleration in m/s² that the proactive and the critical measure ask for.
    fn wanted(&self, s: &Situation) -> f64 {
        let critical = self.critical(s.gap, s.speed, s.acceleration, s.other_speed);
        if critical > 0.0 {
            self.comfortable + critical * (self.deceleration - self.comfortable)
        } else {
            self.proactive(s.gap, s.speed, s.other_speed) * self.comfortable
        }
    }
}

impl BrakingModel for Fsm {
    fn brake(&mut self, s: &Situation, dt: f64) -> f64 {
        let wanted = if self.looks_at(s) { self.wanted(s) } else { 0.0 };
        let acts = self.reason.lasts(wanted > 0.0, self.reaction, dt);
        let wanted = if acts { wanted } else { 0.0 };
        let change = self.jerk * dt;
        self.brake = wanted.clamp(self.brake - change, self.brake + change);
        self.brake
    }
}
