//! The driver `ideal`: no driver that only brakes could have avoided a collision that this driver has.
//!
//! In the kinematic world the driver knows the future. [`Ideal::best`] first tries not to brake and then every
//! [`Profile`] of a family, the gentlest first. It takes the first without a collision, or else the slowest collision.
//!
//! Two profiles would suffice to avoid one other road user whose time in the car's path is a single interval: not to
//! brake, and to brake fully from the first moment on. The reason: a car that brakes at most so hard and never takes up
//! speed is always between the positions that these two give. If it keeps behind the other in that interval, so does
//! the car that brakes fully. If it has passed the other, so has the car that does not brake. To change from behind to
//! past within the interval is the collision. So hard braking is wrong only if the car can get through before. With
//! several others the car may have to pass one and stop for the next; for this, some profiles begin later. The rest of
//! the family avoids no more: gentle braking spares those behind, and makes some unavoidable collisions slower.
//!
//! In a simulated car the driver knows the truth, but not the future. At each question, without delay, it expects that
//! the other goes on as it does and looks some seconds ahead. It wants some room on all sides, or none if there is none
//! to be had, and does what the best profile does first. It may collide with something that it did not foresee.

use super::super::{Descriptor, Setting, setting};
use super::adapter::Reference;
use crate::kinematic::{BrakingModel, Course, Encounter, Ended, Situation, Size};
use crate::vehicle::GRAVITY;

/// The driver that avoids every collision that a driver can avoid by braking alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ideal {
    /// The greatest deceleration in m/s², by default 1 g, the limit on a road of friction 1.
    pub deceleration: f64,
    /// The seconds that the driver looks ahead if the driver does not know the future.
    pub horizon: f64,
    /// The free room in metres that the driver wants on all sides if the driver does not know the future.
    pub margin: f64,
}

const STANDARD: Ideal = Ideal { deceleration: GRAVITY, horizon: 5.0, margin: 0.3 };

pub(in super::super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "ideal",
    about: "brakes without delay and only as hard as it must, and is told the ground truth",
    settings: &SETTINGS,
    make: |settings| {
        Reference::boxed(Ideal {
            deceleration: settings.get("deceleration"),
            horizon: settings.get("horizon"),
            margin: settings.get("margin"),
        })
    },
};

const SETTINGS: [Setting; 3] = [
    setting("deceleration", STANDARD.deceleration, "m/s^2", (0.1, 20.0), "greatest deceleration"),
    setting("horizon", STANDARD.horizon, "s", (0.1, 30.0), "time that the driver looks ahead"),
    setting("margin", STANDARD.margin, "m", (0.0, 5.0), "room that the driver wants on all sides"),
];

impl Default for Ideal {
    fn default() -> Self {
        STANDARD
    }
}

/// A plan to brake with a constant deceleration from a fixed moment on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile {
    /// The seconds from the start of the plan until the brakes act.
    pub onset: f64,
    /// The constant deceleration of the plan, in m/s².
    pub deceleration: f64,
    time: f64,
}

impl Profile {
    /// The plan not to brake at all.
    pub const NONE: Self = Self { onset: 0.0, deceleration: 0.0, time: 0.0 };
}

impl BrakingModel for Profile {
    fn brake(&mut self, _: &Situation, dt: f64) -> f64 {
        // Times are sums of steps.
        let acts = self.time >= self.onset - 1e-9;
        self.time += dt;
        if acts { self.deceleration } else { 0.0 }
    }
}

/// The decelerations of the family, as shares of the greatest.
const STRENGTHS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
/// The onsets of the family, in seconds.
const ONSETS: [f64; 7] = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0];

impl Ideal {
    /// Returns the profiles of the family, the gentlest first.
    fn profiles(&self) -> impl Iterator<Item = Profile> {
        let braking = STRENGTHS.into_iter().flat_map(|strength| ONSETS.map(|onset| (strength, onset)));
        let deceleration = self.deceleration;
        let braking =
            braking.map(move |(strength, onset)| Profile { onset, deceleration: strength * deceleration, time: 0.0 });
        std::iter::once(Profile::NONE).chain(braking)
    }

    /// Returns the gentlest profile without a collision (or with the slowest collision) and the encounter's result.
    pub fn best(&self, encounter: &Encounter) -> (Profile, Ended) {
        let mut best: Option<(Profile, Ended, f64)> = None;
        for profile in self.profiles() {
            let ended = encounter.run(&profile);
            let Some(collision) = ended.collision else {
                return (profile, ended);
            };
            if best.is_none_or(|(.., speed)| collision.speed < speed) {
                best = Some((profile, ended, collision.speed));
            }
        }
        let (profile, ended, _) = best.expect("not to brake is one of the profiles");
        (profile, ended)
    }

    /// Returns the expected encounter if the other road user, enlarged by the margin in metres, keeps its motion.
    fn expected(&self, s: &Situation, margin: f64) -> Encounter {
        let forward = s.other_speed.max(0.0);
        let other = Course {
            gap: s.gap - margin,
            speed: s.other_speed,
            deceleration: if forward > 0.0 { (-s.other_acceleration).max(0.0) } else { 0.0 },
            lateral: s.lateral,
            target: if s.approach > 0.0 { f64::NEG_INFINITY } else { f64::INFINITY },
            lateral_speed: s.approach.abs(),
            size: Size { length: s.lengths + 2.0 * margin, width: s.other_width + 2.0 * margin },
            visible_from: 0.0,
        };
        // The other has all of the length: only the sum of both lengths counts.
        let size = Size { length: 0.0, width: s.width };
        Encounter { speed: s.speed, size, others: vec![other], duration: self.horizon }
    }
}

impl BrakingModel for Ideal {
    fn brake(&mut self, s: &Situation, dt: f64) -> f64 {
        if !s.is_ahead() {
            return 0.0;
        }
        let (mut profile, ended) = self.best(&self.expected(s, self.margin));
        if ended.collision.is_some() {
            profile = self.best(&self.expected(s, 0.0)).0;
        }
        profile.brake(s, dt)
    }
}
