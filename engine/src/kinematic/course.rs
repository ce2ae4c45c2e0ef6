//! The motion of another road user: known from the beginning, in closed form, so that no errors accumulate.

/// The length and width of a road user, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// The length of the road user from bumper to bumper, in metres.
    pub length: f64,
    /// The width of the road user from side to side, in metres.
    pub width: f64,
}

/// The motion of another road user, relative to the front bumper of the ego vehicle at the start, in the middle of the
/// lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// The distance in metres from the ego vehicle's front to the road user's rear at the beginning.
    pub gap: f64,
    /// The speed of the road user along the lane at the beginning, in m/s.
    pub speed: f64,
    /// The deceleration from the beginning until the road user stands, in m/s², not below 0.
    pub deceleration: f64,
    /// The lateral position of the road user's middle at the beginning, in metres, positive to the left.
    pub lateral: f64,
    /// The lateral position to which the road user moves and at which it stays, in metres, positive to the left.
    pub target: f64,
    /// The lateral speed in m/s at which the road user moves to `target`.
    pub lateral_speed: f64,
    /// The length and width of the road user.
    pub size: Size,
    /// The time in seconds after which the driver of the ego vehicle can see the road user.
    pub visible_from: f64,
}

/// The state of a road user on its course at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// The position of the road user's rear, in metres along the lane.
    pub rear: f64,
    /// The speed of the road user along the lane, in m/s.
    pub speed: f64,
    /// The acceleration of the road user along the lane, in m/s².
    pub acceleration: f64,
    /// The distance of the road user from the middle of the lane in metres, not below 0.
    pub lateral: f64,
    /// The speed of the road user towards the middle of the lane, in m/s.
    pub approach: f64,
    /// `true` if the road user neither brakes nor moves sideways from now on.
    pub settled: bool,
}

impl Course {
    /// Returns the state of the road user after `time` seconds.
    pub(super) fn at(&self, time: f64) -> Place {
        // For a car that does not brake, an infinite time to stand would lead to 0 * infinity.
        let braking = self.deceleration > 0.0 && self.speed > self.deceleration * time;
        let (way, speed) = if braking {
            let speed = self.speed - self.deceleration * time;
            (0.5 * (self.speed + speed) * time, speed)
        } else if self.deceleration > 0.0 {
            (0.5 * self.speed * self.speed / self.deceleration, 0.0)
        } else {
            (self.speed * time, self.speed)
        };
        let way_across = self.target - self.lateral;
        let moving = self.lateral_speed * time < way_across.abs() && self.lateral_speed > 0.0;
        let lateral =
            if moving { self.lateral + self.lateral_speed.copysign(way_across) * time } else { self.resting() };
        // A motion towards the middle has the opposite sign of the lateral position.
        let approach = if moving { -self.lateral_speed.copysign(way_across) * 1.0_f64.copysign(lateral) } else { 0.0 };
        Place {
            rear: self.gap + way,
            speed,
            acceleration: if braking { -self.deceleration } else { 0.0 },
            lateral: lateral.abs(),
            approach,
            settled: !braking && !moving,
        }
    }

    /// Returns the lateral position where the road user stays.
    fn resting(&self) -> f64 {
        if self.lateral_speed > 0.0 { self.target } else { self.lateral }
    }
}
