//! Motion along a straight line, exact within a step.
//!
//! The acceleration is constant within a step and ends at standstill. The stopping distance is v²/(2 a) for any step.

/// The motion of a car along a straight line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// The speed of the car in m/s, never below 0.
    pub speed: f64,
    /// The acceleration in m/s² over the last step, which is the change of speed divided by the step's duration.
    pub acceleration: f64,
    /// The distance that the car has covered so far, in metres.
    pub travelled: f64,
}

impl Motion {
    /// Returns the motion of the car after `dt` seconds with a constant acceleration. Braking ends at standstill.
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
