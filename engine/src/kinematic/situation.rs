//! The input of a braking model: the true state of the ego vehicle and another road user, along and across the lane.

/// The state of the ego vehicle and of one other road user at one moment. Lengths are in metres, times in seconds.
/// "Along" means in the direction in which the ego vehicle drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Situation {
    /// The speed of the ego vehicle, in m/s.
    pub speed: f64,
    /// The acceleration of the ego vehicle over the last step, in m/s².
    pub acceleration: f64,
    /// The distance from the ego vehicle's front to the other road user's rear; negative if the front is past the rear.
    pub gap: f64,
    /// The speed of the other road user along the lane, in m/s; negative for an oncoming road user.
    pub other_speed: f64,
    /// The acceleration of the other road user along the lane over the last step, in m/s².
    pub other_acceleration: f64,
    /// The distance in metres across the lane between the middles of both road users, not below 0.
    pub lateral: f64,
    /// The speed in m/s at which the lateral distance shrinks; negative while it grows.
    pub approach: f64,
    /// The width of the ego vehicle, in metres.
    pub width: f64,
    /// The width of the other road user, in metres.
    pub other_width: f64,
    /// The sum of the lengths of the ego vehicle and of the other road user, in metres.
    pub lengths: f64,
}

impl Situation {
    /// Returns the speed in m/s at which the gap to the other road user shrinks.
    pub fn closing(&self) -> f64 {
        self.speed - self.other_speed
    }

    /// Returns `true` if the ego vehicle's front has not passed the rear of the other road user.
    pub fn is_ahead(&self) -> bool {
        self.gap >= 0.0
    }

    /// Returns the lateral distance between the sides of the two road users; negative if the paths overlap.
    pub fn clearance(&self) -> f64 {
        self.lateral - 0.5 * (self.width + self.other_width)
    }

    /// Returns `true` if the other road user is in the ego vehicle's path, whole or in part.
    pub fn overlaps(&self) -> bool {
        self.clearance() < 0.0
    }

    /// Returns the time to collision in seconds at the present speeds; infinite if the gap does not shrink.
    pub fn time_to_collision(&self) -> f64 {
        if self.is_ahead() && self.closing() > 0.0 { self.gap / self.closing() } else { f64::INFINITY }
    }
}
