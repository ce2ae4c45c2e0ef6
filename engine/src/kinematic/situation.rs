//! What a braking model is told: the truth about itself and one other road user, along and across the lane.

/// The car under test and one other road user at one moment. Lengths in metres, times in seconds; `along` is the
/// direction in which the car under test drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Situation {
    /// Speed of the car under test, m/s.
    pub speed: f64,
    /// Its acceleration over the last step, m/s².
    pub acceleration: f64,
    /// From its front bumper to the rear of the other; negative once the fronts have drawn level with that rear.
    pub gap: f64,
    /// Speed of the other along the lane, m/s; negative if it comes towards the car.
    pub other_speed: f64,
    /// Its acceleration along the lane over the last step, m/s².
    pub other_acceleration: f64,
    /// Distance across the lane between the middles of the two, not below 0.
    pub lateral: f64,
    /// How fast that distance shrinks, m/s; negative while it grows.
    pub approach: f64,
    /// Width of the car under test.
    pub width: f64,
    /// Width of the other.
    pub other_width: f64,
    /// Lengths of both together.
    pub lengths: f64,
}

impl Situation {
    /// How fast the gap shrinks, m/s.
    pub fn closing(&self) -> f64 {
        self.speed - self.other_speed
    }

    /// Whether the other is ahead: its rear has not been reached.
    pub fn is_ahead(&self) -> bool {
        self.gap >= 0.0
    }

    /// Room between the sides of the two; negative where their paths overlap.
    pub fn clearance(&self) -> f64 {
        self.lateral - 0.5 * (self.width + self.other_width)
    }

    /// Whether the other is in the path of the car under test, whole or in part.
    pub fn overlaps(&self) -> bool {
        self.clearance() < 0.0
    }

    /// Seconds until the gap is used up at the present speeds; infinite where it is not.
    pub fn time_to_collision(&self) -> f64 {
        if self.is_ahead() && self.closing() > 0.0 { self.gap / self.closing() } else { f64::INFINITY }
    }
}
