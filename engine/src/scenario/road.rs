//! The roads of a scenario: a single road or a whole network, and where its lanes and sidewalks are.

use super::{Place, Scenario};
use crate::flaw::Flaws;
use crate::geometry::{Line, Pose, Side};
use crate::road::{self, Composite, Path, RoadError, RoadNetwork, RoadSegment};
use crate::stream::Stream;
use nalgebra::Vector2;
use std::sync::Arc;

/// A road with a surface of its own, not placed yet.
#[derive(Debug, Clone)]
pub struct Paved {
    road: RoadSegment,
    friction: Stream<f64>,
}

/// A placed road: where its lanes and sidewalks are.
#[derive(Debug, Clone)]
pub struct Road {
    streets: Streets,
    element: String,
}

/// A placed network of roads: where the lanes and sidewalks of each are. Roads are called by the names of their elements.
///
/// Asking for what it does not have is a mistake that is reported when the world is built.
#[derive(Debug, Clone)]
pub struct Streets {
    /// None where the network cannot be as it is described.
    network: Option<Arc<RoadNetwork>>,
    flaws: Flaws,
}

impl RoadSegment {
    /// The friction coefficient between tyre and road: [`Environment::friction`](super::Environment::friction) for a
    /// world with one road.
    pub fn friction(self, friction: impl Into<Stream<f64>>) -> Paved {
        Paved { road: self, friction: friction.into() }
    }
}

impl Place for RoadSegment {
    type Handle = Road;

    fn place(self, scenario: &mut Scenario) -> Road {
        let streets = scenario.place(Composite::from(self));
        let element = streets.network.as_ref().and_then(|network| network.elements().next().map(str::to_owned));
        Road { streets, element: element.unwrap_or_default() }
    }
}

impl Place for Paved {
    type Handle = Road;

    fn place(self, scenario: &mut Scenario) -> Road {
        scenario.say_friction(self.friction);
        scenario.place(self.road)
    }
}

impl Place for Composite {
    type Handle = Streets;

    fn place(self, scenario: &mut Scenario) -> Streets {
        match self.build() {
            Ok(network) => scenario.place(network),
            Err(error) => {
                scenario.flaw(error.into());
                Streets::new(None, scenario)
            }
        }
    }
}

/// A network that no test changes is best built once, in a `LazyLock`, and shared by all runs.
impl Place for Arc<RoadNetwork> {
    type Handle = Streets;

    fn place(self, scenario: &mut Scenario) -> Streets {
        Streets::new(Some(self), scenario)
    }
}

impl Road {
    /// The middle of a lane, `at` metres along the road, facing the way of its traffic. Lane 1 is the one
    /// beside the centre line that leads along the road, 2 the next to its right; -1, -2, ... lead back.
    pub fn on_lane(&self, lane: i32, at: f64) -> Pose {
        self.streets.on_lane(&self.element, lane, at)
    }

    /// The middle of a sidewalk, `at` metres along the road, facing the road.
    pub fn on_sidewalk(&self, side: Side, at: f64) -> Pose {
        self.streets.on_sidewalk(&self.element, side, at)
    }

    /// The line straight across the road, `at` metres along it.
    pub fn crossing(&self, at: f64) -> Line {
        self.streets.crossing(&self.element, at)
    }

    /// The middle of a lane from end to end, the way of its traffic.
    pub fn path(&self, lane: i32) -> Path {
        self.streets.path(&self.element, lane)
    }

    /// The network that it is.
    pub fn streets(&self) -> &Streets {
        &self.streets
    }
}

impl Streets {
    fn new(network: Option<Arc<RoadNetwork>>, scenario: &mut Scenario) -> Self {
        scenario.networks.push(network.clone());
        Self { network, flaws: scenario.flaws.clone() }
    }

    /// The network itself; `None` where it cannot be as it is described, which is reported.
    pub fn network(&self) -> Option<&Arc<RoadNetwork>> {
        self.network.as_ref()
    }

    /// The middle of a lane of a road, `at` metres along the road, facing the way of its traffic: [`Road::on_lane`].
    pub fn on_lane(&self, road: &str, lane: i32, at: f64) -> Pose {
        self.ask(|network| network.on_lane(road, lane, at)).unwrap_or(NOWHERE)
    }

    /// The middle of a sidewalk of a road, `at` metres along the road, facing the road.
    pub fn on_sidewalk(&self, road: &str, side: Side, at: f64) -> Pose {
        self.ask(|network| network.on_sidewalk(road, side, at)).unwrap_or(NOWHERE)
    }

    /// The line straight across a road, `at` metres along it.
    pub fn crossing(&self, road: &str, at: f64) -> Line {
        let here = self.ask(|network| network.on_centre_line(road, at)).unwrap_or(NOWHERE);
        Line { name: format!("crossing({at})"), point: here.position, direction: here.forward() }
    }

    /// The middle of a lane of a road from end to end, the way of its traffic.
    pub fn path(&self, road: &str, lane: i32) -> Path {
        self.ask(|network| Ok(network.path(&[network.lane_of(road, lane)?]))).unwrap_or_else(nowhere)
    }

    /// The place on a lane of a road, `at` metres along the road: where cars of the [traffic](crate::traffic) start.
    pub fn place_on(&self, road: &str, lane: i32, at: f64) -> Option<road::RoutePosition> {
        self.ask(|network| place_on(network, (road, lane, at)))
    }

    /// The shortest way from one place to another without a change of lanes. Places are roads, lanes, and metres along
    /// the road.
    pub fn way(&self, from: (&str, i32, f64), to: (&str, i32, f64)) -> Path {
        self.ask(|network| {
            let route = network.route(place_on(network, from)?, place_on(network, to)?, f64::from(u16::MAX));
            let path = route.and_then(|route| network.path_along(&route));
            path.ok_or_else(|| RoadError::NoWay { from: place_name(from), to: place_name(to) })
        })
        .unwrap_or_else(nowhere)
    }

    fn ask<T>(&self, question: impl FnOnce(&RoadNetwork) -> Result<T, RoadError>) -> Option<T> {
        let answer = question(self.network.as_ref()?);
        answer.map_err(|error| self.flaws.borrow_mut().push(error.into())).ok()
    }
}

fn place_on(network: &RoadNetwork, (road, lane, at): (&str, i32, f64)) -> Result<road::RoutePosition, RoadError> {
    let position = network.on_lane(road, lane, at)?.position;
    Ok(network.project_onto(network.lane_of(road, lane)?, position).place())
}

/// Where everything is that a mistake leaves without a place.
const NOWHERE: Pose = Pose { position: Vector2::new(0.0, 0.0), heading: 0.0 };

fn nowhere() -> Path {
    Path::straight(Vector2::zeros(), Vector2::x())
}

fn place_name((road, lane, at): (&str, i32, f64)) -> String {
    format!("lane {lane} of `{road}`, {at} m along it")
}
