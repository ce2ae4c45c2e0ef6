//! The room for a coordinate of a new point, and coordinates that are measured round a circle.

/// The share of the largest box, around its middle, in which points are placed.
const ROOM: f64 = 0.7;

/// The room for a coordinate. A room beside an end of the cube may go on beyond 1; [`wrap`] leads back.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    pub lower: f64,
    pub width: f64,
    /// `true` if the room goes all the way round, and so has no ends.
    round: bool,
}

impl Room {
    /// The room of a coordinate that may be anywhere. If holes are `periodic`, the room has no ends.
    pub fn anywhere(periodic: bool) -> Self {
        Self { lower: 0.0, width: 1.0, round: periodic }
    }

    /// The room in a hole with this side, whose ends are infinite if the side goes all the way round.
    pub fn within((lower, upper): (f64, f64)) -> Self {
        if upper == f64::INFINITY {
            return Self::anywhere(true);
        }
        let width = ROOM * (upper - lower);
        Self { lower: 0.5 * (lower + upper) - 0.5 * width, width, round: false }
    }

    /// The coordinate at this share of the room.
    pub fn at(self, share: f64) -> f64 {
        self.lower + self.width * share
    }

    /// Returns `true` if the coordinate is in the room.
    pub fn holds(self, x: f64) -> bool {
        self.round || (self.lower..self.lower + self.width).contains(&x)
    }

    /// Returns `true` if the room and a hole with this side overlap.
    pub fn meets(self, (lower, upper): (f64, f64)) -> bool {
        let apart = || wrap(lower - self.lower) >= self.width && wrap(self.lower - lower) >= upper - lower;
        self.round || upper == f64::INFINITY || !apart()
    }

    /// Leads a coordinate back into the room. It is mirrored at the end that it exceeds: if it were moved to the end,
    /// coordinates would collide.
    pub fn reflect(self, x: f64) -> f64 {
        let upper = self.lower + self.width;
        if self.round {
            wrap(x)
        } else if x < self.lower {
            2.0 * self.lower - x
        } else if x > upper {
            2.0 * upper - x
        } else {
            x
        }
    }
}

/// The place in `[0,1)` of a number in (-1, 2), whose whole part does not count.
pub(super) fn wrap(x: f64) -> f64 {
    let x = if x < 0.0 { x + 1.0 } else { x };
    // A negative number that is tiny has become 1.
    if x >= 1.0 { x - 1.0 } else { x }
}
