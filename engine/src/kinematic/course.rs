//! How another road user moves: known from the beginning, in closed form, so that no error adds up.

/// Length and width of a road user in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// Bumper to bumper.
    pub length: f64,
    /// Side to side.
    pub width: f64,
}

/// The motion of another road user, as seen from where the car under test begins: its front bumper, the middle of its
/// lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Metres to its rear at the beginning.
    pub gap: f64,
    /// Its speed along the lane at the beginning, m/s.
    pub speed: f64,
    /// How hard it brakes from the beginning until it stands, m/s², not below 0.
    pub deceleration: f64,
    /// Its lateral position at the beginning in metres: its middle, positive to the left.
    pub lateral: f64,
    /// The lateral position to which it moves and where it stays.
    pub target: f64,
    /// How fast it moves there, m/s.
    pub lateral_speed: f64,
    /// How large it is.
    pub size: Size,
    /// Seconds after which the driver of the car under test can see it.
    pub visible_from: f64,
}

/// A road user on its course at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Its rear, metres along the lane.
    pub rear: f64,
    /// m/s along the lane.
    pub speed: f64,
    /// m/s² along the lane.
    pub acceleration: f64,
    /// Metres from the middle of the lane, not below 0.
    pub lateral: f64,
    /// m/s towards the middle of the lane.
    pub approach: f64,
    /// Whether it will go on without braking and without moving sideways.
    pub settled: bool,
}

impl Course {
    /// Where it is after `time` seconds.
    pub(super) fn at(&self, time: f64) -> Place {
        // An infinite time to stand would make 0 * infinity of a car that does not brake.
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
        // Towards the middle is against the sign of the lateral position.
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

    /// The lateral position where it stays.
    fn resting(&self) -> f64 {
        if self.lateral_speed > 0.0 { self.target } else { self.lateral }
    }
}
