//! Lists the quantities of the ego vehicle that not every trace records.

use super::{ANY, POSITIVE, ROAD_USERS, SignalAbout, of};
use std::f64::consts::FRAC_PI_2;

/// A quantity of the ego vehicle, or of the ego vehicle and its surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    LateralAcceleration,
    YawRate,
    Jerk,
    WheelSlip,
    SlipAngle,
    WheelsOnRoad,
    StandingTime,
    TimeToCollision,
    Headway,
    LaneMargin,
    RightOfWay,
    WayOffset,
    Remaining,
    /// The clearance from the bodies of the class at this index of [`ROAD_USERS`].
    Clearance(usize),
}

/// The quantities that do not belong to a class of road users.
const PLAIN: [Quantity; 13] = [
    Quantity::LateralAcceleration,
    Quantity::YawRate,
    Quantity::Jerk,
    Quantity::WheelSlip,
    Quantity::SlipAngle,
    Quantity::WheelsOnRoad,
    Quantity::StandingTime,
    Quantity::TimeToCollision,
    Quantity::Headway,
    Quantity::LaneMargin,
    Quantity::RightOfWay,
    Quantity::WayOffset,
    Quantity::Remaining,
];

impl Quantity {
    /// Returns all quantities.
    pub fn all() -> impl Iterator<Item = Self> {
        PLAIN.into_iter().chain((0..ROAD_USERS.len()).map(Self::Clearance))
    }

    /// Returns the name of the quantity as a signal.
    pub fn name(self) -> &'static str {
        self.described().0
    }

    /// Returns the description of the quantity as a signal.
    pub fn about(self) -> SignalAbout {
        self.described().1
    }

    fn described(self) -> (&'static str, SignalAbout) {
        match self {
            Quantity::LateralAcceleration => {
                ("car.lateral_acceleration", of("m/s²", "the acceleration to the left", ANY))
            }
            Quantity::YawRate => ("car.yaw_rate", of("rad/s", "the rate of turning, to the left", ANY)),
            Quantity::Jerk => {
                ("car.jerk", of("m/s³", "the change of the forward acceleration over the last tick", ANY))
            }
            Quantity::WheelSlip => (
                "car.wheel_slip",
                of(
                    "",
                    "the greatest absolute slip ratio of the wheels: 0 rolls, 1 is locked or spins in place",
                    POSITIVE,
                ),
            ),
            Quantity::SlipAngle => {
                ("car.slip_angle", of("rad", "the greatest absolute slip angle of the wheels", [0.0, FRAC_PI_2]))
            }
            Quantity::WheelsOnRoad => {
                ("car.wheels_on_road", of("", "the number of wheels that touch the road", [0.0, 4.0]))
            }
            Quantity::StandingTime => (
                "car.standing_time",
                of("s", "the time for which the car has been standing; 0 while it moves", POSITIVE),
            ),
            Quantity::TimeToCollision => (
                "car.time_to_collision",
                of(
                    "s",
                    "the least time to a collision with any body if nobody changes its velocity; infinite without one",
                    POSITIVE,
                ),
            ),
            Quantity::Headway => (
                "car.headway",
                of(
                    "s",
                    "the time to the present place of the nearest body straight ahead; infinite without one",
                    POSITIVE,
                ),
            ),
            Quantity::LaneMargin => (
                "car.lane_margin",
                of("m", "the free width of the lane on the narrower side of the car; negative beyond the edge", ANY),
            ),
            Quantity::RightOfWay => (
                "car.right_of_way",
                of(
                    "s",
                    "the time until somebody with the right of way comes to the car's place in an intersection; infinite if nobody comes",
                    POSITIVE,
                ),
            ),
            Quantity::WayOffset => (
                "car.way_offset",
                of("m", "the distance from the way that the car is to go, positive to the left", ANY),
            ),
            Quantity::Remaining => {
                ("car.remaining", of("m", "the rest of the way that the car is to go; infinite without an end", ANY))
            }
            Quantity::Clearance(index) => {
                let (_, name, about) = ROAD_USERS[index];
                (name, of("m", about, ANY))
            }
        }
    }
}
