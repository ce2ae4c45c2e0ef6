//! The forces of a brush that pulls or brakes while it also slips to the side (combined slip), to which the tests compare
//! the cut of the single-track model.
//!
//! A car of the single-track model has no turning wheels: the pedals ask for a force along the wheel, and the motion of
//! the car says how far the tyre slips to the side. The brush model gives the missing slip along the wheel and the
//! remaining side force. In the brush model (Pacejka, "Tire and Vehicle Dynamics", 2012, section 3.2.3), all slip is
//! relative to the speed of the tread, the force is opposite to the slip, and its size depends on the size of the slip
//! alone:
//!
//! ```text
//! s_x = t,  s_y = tan(alpha) (1 + t) for brakes, tan(alpha) (1 - t) for the engine
//! F = F(s) (s_x, s_y) / s,  s = |(s_x, s_y)|,  F(s) = mu N (1 - (1 - theta)³),  theta = C s / (3 mu)
//! ```
//!
//! `t` solves `F(s) t / s = F_x`. Brakes that ask for more than a locked wheel gives (`cos(alpha) mu N`) lock the wheel,
//! which slides along its velocity.

use super::super::tyre::Tyre;
use nalgebra::Vector2;
use proptest::prelude::*;

/// The number of Newton's steps after which the slip is accurate to rounding.
const STEPS: usize = 20;

impl Tyre {
    /// Returns the forces in newtons along and across the wheel at a side slip (the tangent of the slip angle), if the
    /// pedals ask for the force `asked` along the wheel; below 0, the brakes ask. The third number is the rate at which
    /// the force across falls as the side slip grows, at the same force along the wheel.
    pub fn combined(&self, asked: f64, slip: f64) -> (Vector2<f64>, f64) {
        if asked == 0.0 || self.limit == 0.0 {
            let (side, slope) = self.side_force(slip);
            return (Vector2::new(0.0, -side), slope);
        }
        let share = (asked.abs() / self.limit).min(1.0);
        let (along, across, slope) = self.shares(share, slip.abs(), if asked < 0.0 { 1.0 } else { -1.0 });
        (self.limit * Vector2::new(along.copysign(asked), -across.copysign(slip)), self.limit * slope)
    }

    /// Returns the force along the wheel, the force across the wheel and the slope as shares of the greatest force.
    /// `tangent` is the size of the side slip, and `grows` is 1 for brakes and -1 for the engine.
    fn shares(&self, share: f64, tangent: f64, grows: f64) -> (f64, f64, f64) {
        let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
        if grows > 0.0 && share >= cosine {
            return (cosine, tangent * cosine, cosine * cosine * cosine);
        }
        // The slip along the wheel at which a tyre that slides everywhere has this share of its force along the wheel.
        let across = (1.0 - share * share).max(0.0).sqrt();
        let sliding = share * tangent / (across - grows * share * tangent);
        let stiffness = self.stiffness;
        if across == 0.0 || stiffness * sliding >= share {
            return (share, across, 0.0);
        }
        // Both are below the solution, and Newton's steps come nearer from below.
        let mut t = sliding.max(share / (3.0 * stiffness));
        for _ in 0..STEPS {
            let side = tangent * (1.0 + grows * t);
            let size = (t * t + side * side).sqrt();
            let theta = (stiffness * size).min(1.0);
            let part = 3.0 - (3.0 - theta) * theta;
            let bend = (2.0 * theta - 3.0) * stiffness / size;
            let rate = part + bend * t * (t + side * tangent * grows);
            let next = t + (share / stiffness - part * t) / rate;
            if (next - t).abs() <= f64::EPSILON * next {
                break;
            }
            t = next;
        }
        let side = tangent * (1.0 + grows * t);
        let size = (t * t + side * side).sqrt();
        let theta = (stiffness * size).min(1.0);
        let part = 3.0 - (3.0 - theta) * theta;
        // The secant of the force and its derivative by the size of the slip, divided by the size.
        let secant = stiffness * part;
        let bend = stiffness * stiffness * (2.0 * theta - 3.0) / size;
        let wider = 1.0 + grows * t;
        let along = -bend * t * side * wider / (secant + bend * t * (t + side * tangent * grows));
        let across = wider + grows * tangent * along;
        let slope = secant * across + bend * side * (t * along + side * across);
        (share, secant * side, slope.max(0.0))
    }
}

const LOAD: f64 = 4000.0;

/// The forces of a brush with a given slip along and across, bristle by bristle: each sticks to the road until its
/// force exceeds the friction under it. The pressure is a parabola, and the patch is 2 long.
fn brush(stiffness: f64, friction: f64, slip: Vector2<f64>) -> Vector2<f64> {
    let bristles = 20_000;
    // All bristles together have the force `stiffness * LOAD * slip` if none slides: the integral of the distance
    // from the leading edge is 2.
    let by_deflection = 0.5 * stiffness * LOAD;
    let mut force = Vector2::zeros();
    for i in 0..bristles {
        let width = 2.0 / f64::from(bristles);
        let from_edge = (f64::from(i) + 0.5) * width;
        let place = 1.0 - from_edge;
        let pressure = 0.75 * LOAD * (1.0 - place * place);
        let sticking = by_deflection * from_edge * slip;
        let most = friction * pressure;
        let held = if sticking.norm() <= most { sticking } else { sticking * (most / sticking.norm()) };
        force -= held * width;
    }
    force
}

/// The slip of the brush: along the wheel as a share of the tread's speed, above 0 for brakes, and to the side.
fn slip(along: f64, tangent: f64) -> Vector2<f64> {
    Vector2::new(along, tangent * (1.0 + along))
}

#[test]
fn without_a_pedal_the_force_is_that_of_pure_side_slip() {
    let tyre = Tyre::new(20.0, 0.8, LOAD);
    for tangent in [-0.2, -0.01, 0.0, 0.03, 0.5] {
        let (force, slope) = tyre.combined(0.0, tangent);
        let (side, expected) = tyre.side_force(tangent);
        assert_eq!((force, slope), (Vector2::new(0.0, -side), expected));
    }
}

#[test]
fn brakes_that_ask_for_too_much_lock_the_wheel_and_an_engine_that_does_spins_it() {
    let tyre = Tyre::new(20.0, 0.8, LOAD);
    let tangent = 0.75;
    let (force, _) = tyre.combined(-2.0 * tyre.limit, tangent);
    assert!((force - tyre.limit * Vector2::new(-0.8, -0.6)).norm() < 1e-9, "against the velocity: {force}");
    let (force, _) = tyre.combined(2.0 * tyre.limit, tangent);
    assert!((force - tyre.limit * Vector2::new(1.0, 0.0)).norm() < 1e-9, "along the wheel: {force}");
    assert_eq!(Tyre::new(20.0, 0.0, LOAD).combined(-100.0, 0.1).0, Vector2::zeros(), "no friction, no force");
}

proptest! {
    #[test]
    fn the_force_is_that_of_a_brush_bristle_by_bristle(
        along in prop_oneof![-0.4..-0.001_f64, 0.001..2.0_f64], tangent in -0.4..0.4_f64,
        stiffness in 8.0..30.0_f64, friction in 0.2..1.1_f64
    ) {
        let tyre = Tyre::new(stiffness, friction, LOAD);
        let expected = brush(stiffness, friction, slip(along, tangent));
        let (force, _) = tyre.combined(expected.x, tangent);
        prop_assert!((force - expected).norm() < 1e-3 * tyre.limit, "{} {}", force, expected);
    }

    #[test]
    fn the_slope_is_the_derivative_at_the_same_force_along(
        share in -0.95..0.95_f64, tangent in -0.3..0.3_f64, friction in 0.2..1.1_f64
    ) {
        let tyre = Tyre::new(21.92, friction, LOAD);
        let across = |tangent: f64| -tyre.combined(share * tyre.limit, tangent).0.y;
        let step = 1e-6;
        let difference = (across(tangent + step) - across(tangent - step)) / (2.0 * step);
        // The slope jumps where the whole tyre begins to slide.
        let (below, above) = (tyre.combined(share * tyre.limit, tangent - step).1, tyre.combined(share * tyre.limit, tangent + step).1);
        let (low, high) = (below.min(above), below.max(above));
        let tolerance = 1e-3 * tyre.limit * 22.0;
        prop_assert!((low - tolerance..=high + tolerance).contains(&difference), "{difference}: {low} {high}");
    }
}
