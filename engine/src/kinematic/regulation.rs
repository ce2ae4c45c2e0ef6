//! The encounters for which UN Regulation No. 157 (Annex 4, Appendix 3) says when a careful driver avoids a collision.
//!
//! The ranges of the cut-in are those of the public variations of the regulation's scenarios: ego vehicle 20 to 60
//! km/h, relative speed -50 to -10 km/h, gap 0 to 60 m, lateral speed 0.5 to 3 m/s. The regulation does not give the
//! sizes of lanes and cars: here, lanes are [`LANE_WIDTH`] wide, and both cars are as large as the engine's own.

use super::course::{Course, Size};
use super::encounter::Encounter;
use crate::vehicle::Vehicle;

/// The width of a lane in the encounters, in metres.
pub const LANE_WIDTH: f64 = 3.5;

/// The distance in metres that a car's middle may be off the middle of its lane while the car keeps the lane.
const WANDERING: f64 = 0.375;

/// The time in seconds after which an encounter is over: more than the 21.6 s that 60 m take at 10 km/h.
const DURATION: f64 = 30.0;

const CAR: Size = Size { length: Vehicle::BMW_320I.length, width: Vehicle::BMW_320I.width };

const KM_H: f64 = 1.0 / 3.6;

/// An encounter in which a car cuts in from the next lane in front of the ego vehicle and drives on at constant speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutIn {
    /// The speed of the ego vehicle, in m/s.
    pub speed: f64,
    /// The speed of the other car along the lane, in m/s.
    pub other_speed: f64,
    /// The gap in metres from the ego vehicle's front to the other car's rear when the other car begins to move over.
    pub gap: f64,
    /// The lateral speed of the other car, in m/s.
    pub lateral_speed: f64,
}

impl CutIn {
    /// Makes a cut-in from four numbers in [0, 1], which are scaled to the ranges of speed, relative speed (0 for the
    /// greatest difference), gap and lateral speed. `None` if the other car would have to drive backwards.
    pub fn from_unit(point: [f64; 4]) -> Option<Self> {
        let within = |x: f64, low: f64, high: f64| low + x * (high - low);
        let speed = within(point[0], 20.0, 60.0) * KM_H;
        let other_speed = speed + within(point[1], -50.0, -10.0) * KM_H;
        let gap = within(point[2], 0.0, 60.0);
        let lateral_speed = within(point[3], 0.5, 3.0);
        (other_speed >= 0.0).then_some(Self { speed, other_speed, gap, lateral_speed })
    }

    /// Returns the encounter of this cut-in, which begins when the other car begins to move over from the left.
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

/// An encounter in which the car ahead leaves the lane (it cuts out) and uncovers a car that stands in the lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutOut {
    /// The speed of the ego vehicle and of the car ahead, in m/s.
    pub speed: f64,
    /// The distance between the ego vehicle and the car ahead, in metres.
    pub gap: f64,
    /// The distance in metres from the front of the car ahead to the standing car when the lane change begins.
    pub distance: f64,
    /// The lateral speed of the car ahead, in m/s.
    pub lateral_speed: f64,
}

impl CutOut {
    /// Returns the encounter of this cut-out, which begins when the car ahead begins to move over. The standing car is
    /// visible as soon as the car ahead has left the zone in which cars wander.
    ///
    /// # Panics
    /// The lateral speed is not positive.
    pub fn encounter(&self) -> Encounter {
        assert!(self.lateral_speed > 0.0, "the lateral speed of a car that cuts out has to be above 0");
        let leader = Course { target: LANE_WIDTH, lateral_speed: self.lateral_speed, ..ahead(self.gap, self.speed) };
        let standing = Course {
            visible_from: WANDERING / self.lateral_speed,
            ..ahead(self.gap + CAR.length + self.distance, 0.0)
        };
        encounter(self.speed, vec![leader, standing])
    }
}

/// An encounter in which the car ahead brakes to standstill.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeaderBrakes {
    /// The speed of the ego vehicle and of the car ahead at the beginning, in m/s.
    pub speed: f64,
    /// The distance between the ego vehicle and the car ahead, in metres.
    pub gap: f64,
    /// The deceleration of the car ahead, in m/s².
    pub deceleration: f64,
}

impl LeaderBrakes {
    /// Returns the encounter with the braking car, which begins when the car ahead begins to brake.
    pub fn encounter(&self) -> Encounter {
        encounter(self.speed, vec![Course { deceleration: self.deceleration, ..ahead(self.gap, self.speed) }])
    }
}

fn encounter(speed: f64, others: Vec<Course>) -> Encounter {
    Encounter { speed, size: CAR, others, duration: DURATION }
}

/// Returns the course of a car in the same lane at constant speed.
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
