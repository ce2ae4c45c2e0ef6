//! A straight road with lanes for both directions and a sidewalk on each side.

use super::{Line, Place, Pose, Problems, Scenario};
use crate::stream::Stream;
use nalgebra::Vector2;

/// Width of a lane in metres: the usual of urban main roads.
const LANE_WIDTH: f64 = 3.5;
/// Width of a sidewalk in metres.
const SIDEWALK_WIDTH: f64 = 2.0;
/// Friction coefficient of dry asphalt.
const DRY_ASPHALT: f64 = 0.8;

/// A straight road from the origin along x, not placed yet.
#[derive(Debug, Clone)]
pub struct RoadSegment {
    length: f64,
    lanes: i32,
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
    length: f64,
    lanes: i32,
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
    /// A road of this length in metres, with two lanes and dry asphalt where nothing else is said.
    pub fn new(length: f64) -> Self {
        Self { length, lanes: 2, friction: Stream::constant(DRY_ASPHALT) }
    }

    /// The number of lanes of both directions together: an even one.
    pub fn lanes(mut self, lanes: i32) -> Self {
        self.lanes = lanes;
        self
    }

    /// The friction coefficient between tyre and road.
    pub fn friction(mut self, friction: impl Into<Stream<f64>>) -> Self {
        self.friction = friction.into();
        self
    }
}

impl Place for RoadSegment {
    type Handle = Road;

    fn place(self, scenario: &mut Scenario) -> Road {
        if !(self.length > 0.0 && self.length.is_finite()) {
            scenario.problem(format!("a road has length {}, expected a positive number of metres", self.length));
        }
        if self.lanes < 2 || self.lanes % 2 != 0 {
            scenario.problem(format!("a road has {} lanes, expected an even number from 2 on", self.lanes));
        }
        scenario.roads.push(RoadSetup { friction: self.friction });
        Road { length: self.length, lanes: self.lanes, problems: scenario.problems.clone() }
    }
}

impl Road {
    /// The middle of a lane, `at` metres along the road, facing the way of its traffic. Lane 1 is the one
    /// beside the centre line that leads along the road, 2 the next to its right; -1, -2, ... lead back.
    pub fn on_lane(&self, lane: i32, at: f64) -> Pose {
        let each_way = self.lanes / 2;
        if lane == 0 || lane.abs() > each_way {
            self.problem(format!("lane {lane} is asked for, the road has 1 to {each_way} and -1 to -{each_way}"));
        }
        let offset = (f64::from(lane.abs()) - 0.5) * LANE_WIDTH;
        let (y, heading) = if lane > 0 { (-offset, 0.0) } else { (offset, std::f64::consts::PI) };
        Pose { position: Vector2::new(self.along(at), y), heading }
    }

    /// The middle of a sidewalk, `at` metres along the road, facing the road.
    pub fn on_sidewalk(&self, side: Side, at: f64) -> Pose {
        let offset = 0.5 * f64::from(self.lanes) * LANE_WIDTH + 0.5 * SIDEWALK_WIDTH;
        let quarter_turn = std::f64::consts::FRAC_PI_2;
        let (y, heading) = match side {
            Side::Left => (offset, -quarter_turn),
            Side::Right => (-offset, quarter_turn),
        };
        Pose { position: Vector2::new(self.along(at), y), heading }
    }

    /// The line straight across the road, `at` metres along it.
    pub fn crossing(&self, at: f64) -> Line {
        Line { name: format!("crossing({at})"), point: Vector2::new(self.along(at), 0.0), direction: Vector2::x() }
    }

    fn along(&self, at: f64) -> f64 {
        if !(0.0..=self.length).contains(&at) {
            self.problem(format!("a place {at} m along the road is asked for, the road is {} m long", self.length));
        }
        at
    }

    fn problem(&self, message: String) {
        self.problems.borrow_mut().push(message);
    }
}
