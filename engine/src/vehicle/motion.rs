//! Motion along a straight way, exact within a step.
//!
//! The acceleration is constant within a step, and standstill ends it: the stopping distance is v²/(2 a) whatever the
//! step.

/// How a car moves along its heading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// m/s, never below 0.
    pub speed: f64,
    /// m/s² over the last step: the change of speed by its duration.
    pub acceleration: f64,
    /// The way covered so far, in metres.
    pub travelled: f64,
}

impl Motion {
    /// The motion after `dt` seconds under a constant acceleration that a brake ends at standstill.
    pub fn after(self, acceleration: f64, dt: f64) -> Self {
        let speed = self.speed + acceleration * dt;
        let (speed, way) = if speed < 0.0 {
            (0.0, -0.5 * self.speed * self.speed / acceleration)
        } else {
            (speed, (self.speed + 0.5 * acceleration * dt) * dt)
        };
        Self { speed, acceleration: (speed - self.speed) / dt, travelled: self.travelled + way }
    }
}
