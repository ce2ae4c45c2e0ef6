//! The road of a scenario: a road element with a surface, and where its lanes and sidewalks are.

use super::{Line, Place, Pose, Problems, Scenario};
use crate::road::{Curve, Profile, RoadSegment, lane_pose, sidewalk_pose};
use crate::stream::Stream;

/// Friction coefficient of dry asphalt.
const DRY_ASPHALT: f64 = 0.8;

/// A road with a surface of its own, not placed yet.
#[derive(Debug, Clone)]
pub struct Paved {
    road: RoadSegment,
    friction: Stream<f64>,
}

/// What a run needs of a placed road.
#[derive(Debug)]
pub(crate) struct RoadSetup {
    pub friction: Stream<f64>,
}

/// A placed road: where its lanes and sidewalks are.
#[derive(Debug, Clone)]
pub struct Road {
    centre: Curve,
    profile: Profile,
    problems: Problems,
}

/// A side of a road, seen along it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Where y is positive: beside the lanes of the opposite direction.
    Left,
    /// Where y is negative: beside lane 1.
    Right,
}

impl RoadSegment {
    /// The friction coefficient between tyre and road; that of dry asphalt where nothing is said.
    pub fn friction(self, friction: impl Into<Stream<f64>>) -> Paved {
        Paved { road: self, friction: friction.into() }
    }
}

impl Place for RoadSegment {
    type Handle = Road;

    fn place(self, scenario: &mut Scenario) -> Road {
        self.friction(DRY_ASPHALT).place(scenario)
    }
}

impl Place for Paved {
    type Handle = Road;

    fn place(self, scenario: &mut Scenario) -> Road {
        if let Some(problem) = self.road.problem() {
            scenario.problem(format!("a road {problem}"));
        }
        scenario.roads.push(RoadSetup { friction: self.friction });
        Road { centre: self.road.centre_line(), profile: self.road.profile, problems: scenario.problems.clone() }
    }
}

impl Road {
    /// The middle of a lane, `at` metres along the road, facing the way of its traffic. Lane 1 is the one
    /// beside the centre line that leads along the road, 2 the next to its right; -1, -2, ... lead back.
    pub fn on_lane(&self, lane: i32, at: f64) -> Pose {
        let each_way = self.profile.each_way();
        if lane == 0 || lane.abs() > each_way {
            self.problem(format!("lane {lane} is asked for, the road has 1 to {each_way} and -1 to -{each_way}"));
        }
        lane_pose(&self.centre, &self.profile, lane, self.along(at))
    }

    /// The middle of a sidewalk, `at` metres along the road, facing the road.
    pub fn on_sidewalk(&self, side: Side, at: f64) -> Pose {
        sidewalk_pose(&self.centre, &self.profile, side, self.along(at))
    }

    /// The line straight across the road, `at` metres along it.
    pub fn crossing(&self, at: f64) -> Line {
        let here = self.centre.at(self.along(at));
        Line { name: format!("crossing({at})"), point: here.position, direction: here.forward() }
    }

    fn along(&self, at: f64) -> f64 {
        let length = self.centre.length();
        if !(0.0..=length).contains(&at) {
            self.problem(format!("a place {at} m along the road is asked for, the road is {length} m long"));
        }
        at
    }

    fn problem(&self, message: String) {
        self.problems.borrow_mut().push(message);
    }
}
