//! How fast to follow: the intelligent driver model (Treiber, Hennecke, Helbing 2000), and below it a speed at which
//! one can always stop, so that no choice of its parameters runs into what is ahead.

use crate::vehicle::GRAVITY;

/// The hardest braking in m/s², of every car: what tyres give on a dry road.
const HARDEST: f64 = 8.0;
/// What a car can brake with on any ice, in m/s²: with less it would never come to a stop.
const ON_ICE: f64 = 0.1;
/// Metres that are never driven into on purpose.
const RESERVE: f64 = 0.5;

/// The parameters of the intelligent driver model, those of a driver in a town where nothing else is said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Idm {
    /// The greatest acceleration, a in the paper, in m/s².
    pub acceleration: f64,
    /// The comfortable deceleration, b in the paper, in m/s².
    pub deceleration: f64,
    /// The time headway T in s.
    pub headway: f64,
    /// The gap s0 at standstill in metres.
    pub gap: f64,
    /// The exponent δ of the free acceleration.
    pub exponent: f64,
}

impl Default for Idm {
    fn default() -> Self {
        Self { acceleration: 1.5, deceleration: 2.0, headway: 1.5, gap: 2.0, exponent: 4.0 }
    }
}

impl Idm {
    /// The acceleration in m/s² on a free road at a speed, when `desired` is wanted. Who is too fast brakes at most
    /// comfortably.
    pub fn free(&self, speed: f64, desired: f64) -> f64 {
        if desired <= 0.0 {
            return if speed > 0.0 { -self.deceleration } else { 0.0 };
        }
        let share = speed / desired;
        let power = if self.exponent == 4.0 { share * share * share * share } else { libm::pow(share, self.exponent) };
        (self.acceleration * (1.0 - power)).max(-self.deceleration)
    }

    /// The acceleration in m/s² behind something that moves at `ahead` m/s, `gap` metres away from bumper to bumper.
    pub fn following(&self, speed: f64, desired: f64, gap: f64, ahead: f64) -> f64 {
        let share = self.desired_gap(speed, ahead) / gap.max(0.1);
        self.free(speed, desired) - self.acceleration * share * share
    }

    /// The gap s* in metres that is aimed at.
    fn desired_gap(&self, speed: f64, ahead: f64) -> f64 {
        let braking = 2.0 * (self.acceleration * self.deceleration).sqrt();
        self.gap + (speed * self.headway + speed * (speed - ahead) / braking).max(0.0)
    }
}

/// The hardest braking in m/s² on a road with this friction coefficient.
pub(super) fn hardest_braking(friction: f64) -> f64 {
    (friction * GRAVITY).clamp(ON_ICE, HARDEST)
}

/// The greatest speed after a step of `dt` at which one does not run into what is `gap` metres ahead, should it brake
/// as hard as it can, and oneself from the next step on (after Gipps 1981). With v' that speed, V its own and B what
/// both can brake with, v'² / 2B + (v + v') dt / 2 = gap + V² / 2B.
pub(super) fn safe_speed(speed: f64, gap: f64, ahead: f64, braking: f64, dt: f64) -> f64 {
    let ahead = ahead.max(0.0);
    let half = 0.5 * braking * dt;
    let square = half * half + 2.0 * braking * (gap - RESERVE - 0.5 * speed * dt) + ahead * ahead;
    if square > 0.0 { (square.sqrt() - half).max(0.0) } else { 0.0 }
}
