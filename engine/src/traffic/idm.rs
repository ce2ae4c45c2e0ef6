//! The intelligent driver model (Treiber, Hennecke, Helbing 2000), which says how cars follow others, and a safe speed
//! at which a car can always stop. The safe speed ensures that no choice of parameters leads to a rear-end collision.

use crate::vehicle::GRAVITY;

/// The hardest braking of every car in m/s²: the limit of tyres on a dry road.
const HARDEST: f64 = 8.0;
/// The braking in m/s² that a car has on any ice. With less it would never come to a stop.
const ON_ICE: f64 = 0.1;
/// The metres before a body that a car never drives into on purpose.
const RESERVE: f64 = 0.5;

/// The parameters of the intelligent driver model. By default, they describe a driver in a town.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Idm {
    /// The greatest acceleration of the car, a in the paper, in m/s².
    pub acceleration: f64,
    /// The comfortable deceleration of the car, b in the paper, in m/s².
    pub deceleration: f64,
    /// The desired time headway to the car ahead, T in the paper, in s.
    pub headway: f64,
    /// The desired gap to the car ahead at standstill, s0 in the paper, in metres.
    pub gap: f64,
    /// The exponent of the acceleration on a free road, δ in the paper.
    pub exponent: f64,
}

impl Default for Idm {
    fn default() -> Self {
        Self { acceleration: 1.5, deceleration: 2.0, headway: 1.5, gap: 2.0, exponent: 4.0 }
    }
}

impl Idm {
    /// Returns the acceleration in m/s² of a car at the speed `speed` on a free road, with the desired speed `desired`.
    /// A car that is too fast brakes with at most the comfortable deceleration.
    pub fn free(&self, speed: f64, desired: f64) -> f64 {
        if desired <= 0.0 {
            return if speed > 0.0 { -self.deceleration } else { 0.0 };
        }
        let share = speed / desired;
        let power = if self.exponent == 4.0 { share * share * share * share } else { libm::pow(share, self.exponent) };
        (self.acceleration * (1.0 - power)).max(-self.deceleration)
    }

    /// Returns the acceleration in m/s² of a car `gap` metres (bumper to bumper) behind a body with the speed `ahead`.
    pub fn following(&self, speed: f64, desired: f64, gap: f64, ahead: f64) -> f64 {
        self.free(speed, desired) - self.interaction(speed, gap, ahead)
    }

    /// Returns the part of [`Idm::following`] that the body ahead takes off the acceleration on a free road, in m/s².
    pub(super) fn interaction(&self, speed: f64, gap: f64, ahead: f64) -> f64 {
        let share = self.desired_gap(speed, ahead) / gap.max(0.1);
        self.acceleration * share * share
    }

    /// Returns the desired gap s* in metres.
    fn desired_gap(&self, speed: f64, ahead: f64) -> f64 {
        let braking = 2.0 * (self.acceleration * self.deceleration).sqrt();
        self.gap + (speed * self.headway + speed * (speed - ahead) / braking).max(0.0)
    }
}

/// Returns the hardest braking in m/s² on a road with this friction coefficient.
pub(super) fn hardest_braking(friction: f64) -> f64 {
    (friction * GRAVITY).clamp(ON_ICE, HARDEST)
}

/// Returns the greatest speed after a step of `dt` at which a car does not run into a body `gap` metres ahead, even if
/// the body brakes as hard as it can, and the car from the next step on (after Gipps 1981). With v' that speed, v the
/// present speed, V the body's speed, B the hardest braking of both: v'² / 2B + (v + v') dt / 2 = gap + V² / 2B.
pub(super) fn safe_speed(speed: f64, gap: f64, ahead: f64, braking: f64, dt: f64) -> f64 {
    let ahead = ahead.max(0.0);
    let half = 0.5 * braking * dt;
    let square = half * half + 2.0 * braking * (gap - RESERVE - 0.5 * speed * dt) + ahead * ahead;
    if square > 0.0 { (square.sqrt() - half).max(0.0) } else { 0.0 }
}
