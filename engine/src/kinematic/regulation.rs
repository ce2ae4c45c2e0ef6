//! The encounters for which UN Regulation No. 157 (Annex 4, Appendix 3) says what a careful driver gets out of.
//!
//! The ranges of the cut-in are those of the public variations of the regulation's scenarios: car under test 20 to
//! 60 km/h, relative speed -50 to -10 km/h, gap 0 to 60 m, lateral speed 0.5 to 3 m/s. Lanes are [`LANE_WIDTH`] wide, and
//! both cars are as large as the engine's own; the regulation leaves both open, so that is our reading.

use super::course::{Course, Size};
use super::encounter::Encounter;
use crate::vehicle::Vehicle;

/// Width of a lane in metres.
pub const LANE_WIDTH: f64 = 3.5;

/// How far in metres the middle of a car wanders from the middle of its lane without meaning to leave it.
const WANDERING: f64 = 0.375;

/// Seconds after which an encounter is over: more than the 21.6 s in which 60 m are used up at 10 km/h.
const DURATION: f64 = 30.0;

const CAR: Size = Size { length: Vehicle::BMW_320I.length, width: Vehicle::BMW_320I.width };

const KM_H: f64 = 1.0 / 3.6;

/// A car in the next lane moves over into the lane of the car under test and drives on at constant speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutIn {
    /// Speed of the car under test, m/s.
    pub speed: f64,
    /// Speed of the other along the lane, m/s.
    pub other_speed: f64,
    /// Metres from the front of the car under test to the rear of the other when that begins to move over.
    pub gap: f64,
    /// How fast it moves over, m/s.
    pub lateral_speed: f64,
}

impl CutIn {
    /// The cut-in that these four numbers in [0, 1] stand for, each in its range: speed, relative speed (0 for the
    /// greatest difference), gap, lateral speed. `None` where the other would have to drive backwards.
    pub fn from_unit(point: [f64; 4]) -> Option<Self> {
        let within = |x: f64, low: f64, high: f64| low + x * (high - low);
        let speed = within(point[0], 20.0, 60.0) * KM_H;
        let other_speed = speed + within(point[1], -50.0, -10.0) * KM_H;
        let gap = within(point[2], 0.0, 60.0);
        let lateral_speed = within(point[3], 0.5, 3.0);
        (other_speed >= 0.0).then_some(Self { speed, other_speed, gap, lateral_speed })
    }

    /// The encounter, which begins as the other begins to move over, from the left.
    pub fn encounter(&self) -> Encounter {
        let other = Course {
            lateral: LANE_WIDTH,
            target: 0.0,
            lateral_speed: self.lateral_speed,
            ..ahead(self.gap, self.other_speed)
        };
        encounter(self.speed, vec![other])
    }
}

/// The car ahead changes lanes and uncovers one that stands in the lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutOut {
    /// Speed in m/s of the car under test and of the one ahead.
    pub speed: f64,
    /// Metres between the two.
    pub gap: f64,
    /// Metres from the front of the car ahead to the one that stands, when the car ahead begins to move over.
    pub distance: f64,
    /// How fast it moves over, m/s.
    pub lateral_speed: f64,
}

impl CutOut {
    /// The encounter, which begins as the car ahead begins to move over. Who stands there can be seen once the car ahead
    /// has left the zone in which cars wander.
    ///
    /// # Panics
    /// The lateral speed is not positive.
    pub fn encounter(&self) -> Encounter {
        assert!(self.lateral_speed > 0.0, "a car that cuts out moves sideways");
        let leader = Course { target: LANE_WIDTH, lateral_speed: self.lateral_speed, ..ahead(self.gap, self.speed) };
        let standing = Course {
            visible_from: WANDERING / self.lateral_speed,
            ..ahead(self.gap + CAR.length + self.distance, 0.0)
        };
        encounter(self.speed, vec![leader, standing])
    }
}

/// The car ahead brakes to standstill.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeaderBrakes {
    /// Speed in m/s of the car under test and of the one ahead.
    pub speed: f64,
    /// Metres between the two.
    pub gap: f64,
    /// How hard it brakes, m/s².
    pub deceleration: f64,
}

impl LeaderBrakes {
    /// The encounter, which begins as the car ahead begins to brake.
    pub fn encounter(&self) -> Encounter {
        encounter(self.speed, vec![Course { deceleration: self.deceleration, ..ahead(self.gap, self.speed) }])
    }
}

fn encounter(speed: f64, others: Vec<Course>) -> Encounter {
    Encounter { speed, size: CAR, others, duration: DURATION }
}

/// A car in the same lane that goes on as it does.
fn ahead(gap: f64, speed: f64) -> Course {
    Course {
        gap,
        speed,
        deceleration: 0.0,
        lateral: 0.0,
        target: 0.0,
        lateral_speed: 0.0,
        size: CAR,
        visible_from: 0.0,
    }
}
