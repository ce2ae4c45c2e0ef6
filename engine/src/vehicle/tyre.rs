//! The tyre of both models: the brush model (Pacejka, "Tire and Vehicle Dynamics", 2012, chapter 3) with a parabolic
//! pressure. Its bristles stick to the road until their force exceeds the friction.
//!
//! The force is `mu N (1 - (1 - theta)³)` with `theta = C s / (3 mu)`, where `s` is the slip and `C` the stiffness by
//! load. It is `mu N` as soon as the whole contact patch slides (`theta >= 1`).

use nalgebra::Vector2;

/// A tyre on the road, or all tyres of an axle together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Tyre {
    /// The greatest force of the tyre in newtons, which is `mu N`.
    pub limit: f64,
    /// The ratio of `theta` to the slip, which is `C / (3 mu)`.
    pub(super) stiffness: f64,
}

impl Tyre {
    /// Makes a tyre from its stiffness divided by its load, in 1/rad, and its load in newtons. No friction, no force.
    pub fn new(stiffness: f64, friction: f64, load: f64) -> Self {
        if friction > 0.0 {
            Self { limit: friction * load, stiffness: stiffness / (3.0 * friction) }
        } else {
            Self::default()
        }
    }

    /// Returns the side force in newtons at a slip (the tangent of the slip angle), and the force's derivative with
    /// respect to the slip. The force acts against the slip.
    pub fn side_force(&self, slip: f64) -> (f64, f64) {
        let sticking = (1.0 - self.stiffness * slip.abs()).max(0.0);
        let square = sticking * sticking;
        let force = self.limit * (1.0 - square * sticking);
        (force.copysign(slip), 3.0 * self.limit * self.stiffness * square)
    }

    /// Returns the force of the tyre divided by the slip, at a slip of a given size in any direction.
    pub fn secant(&self, slip: f64) -> f64 {
        let part = (self.stiffness * slip).min(1.0);
        // 1 - (1 - theta)³, divided by theta.
        let by_part = 3.0 - (3.0 - part) * part;
        if part < 1.0 { self.limit * self.stiffness * by_part } else { self.limit / slip }
    }

    /// Limits a force, in newtons along and across the wheel, to the friction circle.
    pub fn cut(&self, asked: Vector2<f64>) -> Vector2<f64> {
        let size = asked.norm();
        if size <= self.limit { asked } else { asked * (self.limit / size) }
    }

    /// Returns the slip ratio at which the tyre has a given force. The force of a brush is opposite to its slip.
    pub fn slip_ratio(&self, force: Vector2<f64>) -> f64 {
        let size = force.norm();
        if size == 0.0 {
            return 0.0;
        }
        let theta = 1.0 - libm::cbrt((1.0 - size / self.limit).max(0.0));
        let slip = theta / self.stiffness * force.x / size;
        // The slip of a brush is relative to the speed of its tread.
        if slip < 0.0 { slip / (1.0 - slip) } else { slip }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_force_begins_as_its_stiffness_says_and_ends_at_the_friction() {
        let tyre = Tyre::new(20.0, 0.8, 5000.0);
        let (force, slope) = tyre.side_force(1e-6);
        assert!((force / (20.0 * 5000.0 * 1e-6) - 1.0).abs() < 1e-4);
        assert!((slope / (20.0 * 5000.0) - 1.0).abs() < 1e-4);
        assert_eq!(tyre.side_force(-10.0), (-4000.0, 0.0));
    }

    #[test]
    fn on_ice_without_friction_there_is_no_force() {
        let tyre = Tyre::new(20.0, 0.0, 5000.0);
        assert_eq!(tyre.side_force(0.3).0, 0.0);
        assert_eq!(tyre.cut(Vector2::new(100.0, 0.0)), Vector2::zeros());
        assert_eq!(tyre.slip_ratio(Vector2::zeros()), 0.0);
    }

    proptest! {
        #[test]
        fn the_slope_is_the_derivative(slip in -0.2..0.2_f64) {
            let tyre = Tyre::new(20.0, 0.8, 5000.0);
            let step = 1e-6;
            let difference = (tyre.side_force(slip + step).0 - tyre.side_force(slip - step).0) / (2.0 * step);
            prop_assert!((difference - tyre.side_force(slip).1).abs() < 20.0);
        }

        #[test]
        fn the_slip_of_a_pure_force_is_the_one_that_makes_it(slip in 0.0..0.11_f64) {
            let tyre = Tyre::new(20.0, 0.8, 5000.0);
            let force = tyre.side_force(slip).0;
            prop_assert!((tyre.slip_ratio(Vector2::new(force, 0.0)) - slip).abs() < 1e-6);
            prop_assert!((tyre.slip_ratio(Vector2::new(-force, 0.0)) + slip / (1.0 + slip)).abs() < 1e-6);
        }
    }
}
