//! The roads of a scenario: a single road or a whole network, and the places of their lanes and sidewalks.

use super::{Place, Scenario};
use crate::flaw::Flaws;
use crate::line::Line;
use crate::road::{self, Composite, Path, Paved, RoadError, RoadNetwork, RoadSegment};
use crate::stream::Stream;
use nalgebra::Vector2;
use paracosm_road::{Pose, Side};
use std::sync::Arc;

/// A placed road, which gives the places of its lanes and sidewalks.
#[derive(Debug, Clone)]
pub struct Road {
    streets: Streets,
    element: String,
}

/// A placed network of roads, which gives the places of lanes and sidewalks. Roads have the names of their elements.
///
/// A question about a road or lane that does not exist is a mistake, which is reported when the world is built.
#[derive(Debug, Clone)]
pub struct Streets {
    /// The network; `None` if the network cannot be built.
    network: Option<Arc<RoadNetwork>>,
    flaws: Flaws,
}

impl Place for RoadSegment {
    type Handle = Road;

    fn place(self, scenario: &mut Scenario) -> Road {
        let streets = scenario.place(Composite::from(self));
        let element = streets.network.as_ref().and_then(|network| network.elements().next().map(str::to_owned));
        Road { streets, element: element.unwrap_or_default() }
    }
}

impl<F: Into<Stream<f64>>> Place for Paved<F> {
    type Handle = Road;

    fn place(self, scenario: &mut Scenario) -> Road {
        scenario.say_friction(self.friction.into());
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

/// A network that is the same in every test is best built once, in a `LazyLock`, and shared by all runs.
impl Place for Arc<RoadNetwork> {
    type Handle = Streets;

    fn place(self, scenario: &mut Scenario) -> Streets {
        Streets::new(Some(self), scenario)
    }
}

impl Road {
    /// Returns the pose in the middle of a lane, `at` metres along the road, in the direction of traffic. Lane 1 is
    /// beside the centre line and leads along the road, lane 2 is to its right, and so on; lanes -1, -2, ... lead back.
    pub fn on_lane(&self, lane: i32, at: f64) -> Pose {
        self.streets.on_lane(&self.element, lane, at)
    }

    /// Returns the pose in the middle of a sidewalk, `at` metres along the road, facing the road.
    pub fn on_sidewalk(&self, side: Side, at: f64) -> Pose {
        self.streets.on_sidewalk(&self.element, side, at)
    }

    /// Returns the line straight across the road, `at` metres along the road.
    pub fn crossing(&self, at: f64) -> Line {
        self.streets.crossing(&self.element, at)
    }

    /// Returns the path along the middle of a whole lane, in the direction of traffic.
    pub fn path(&self, lane: i32) -> Path {
        self.streets.path(&self.element, lane)
    }

    /// Returns the network of which the road is the only element.
    pub fn streets(&self) -> &Streets {
        &self.streets
    }
}

impl Streets {
    fn new(network: Option<Arc<RoadNetwork>>, scenario: &mut Scenario) -> Self {
        scenario.networks.push(network.clone());
        Self { network, flaws: scenario.flaws.clone() }
    }

    /// Returns the road network; `None` if the network cannot be built, which the scenario reports.
    pub fn network(&self) -> Option<&Arc<RoadNetwork>> {
        self.network.as_ref()
    }

    /// Returns the pose in the middle of a lane, `at` metres along a road, like [`Road::on_lane`].
    pub fn on_lane(&self, road: &str, lane: i32, at: f64) -> Pose {
        self.ask(|network| network.on_lane(road, lane, at)).unwrap_or(NOWHERE)
    }

    /// Returns the pose in the middle of a sidewalk of a road, `at` metres along the road, facing the road.
    pub fn on_sidewalk(&self, road: &str, side: Side, at: f64) -> Pose {
        self.ask(|network| network.on_sidewalk(road, side, at)).unwrap_or(NOWHERE)
    }

    /// Returns the line straight across a road, `at` metres along the road.
    pub fn crossing(&self, road: &str, at: f64) -> Line {
        let here = self.ask(|network| network.on_centre_line(road, at)).unwrap_or(NOWHERE);
        Line { name: format!("crossing({at})"), point: here.position, direction: here.forward() }
    }

    /// Returns the path along the middle of a whole lane of a road, in the direction of traffic.
    pub fn path(&self, road: &str, lane: i32) -> Path {
        self.ask(|network| Ok(network.path(&[network.lane_of(road, lane)?]))).unwrap_or_else(nowhere)
    }

    /// Returns the place on a lane, `at` metres along a road, as the start of a car of the [traffic](crate::traffic).
    pub fn place_on(&self, road: &str, lane: i32, at: f64) -> Option<road::RoutePosition> {
        self.ask(|network| place_on(network, (road, lane, at)))
    }

    /// Returns the shortest path between two places without a change of lanes. A place is a road, a lane, and metres
    /// along the road.
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

/// The pose that is returned after a mistake, which is reported.
const NOWHERE: Pose = Pose { position: Vector2::new(0.0, 0.0), heading: 0.0 };

fn nowhere() -> Path {
    Path::straight(Vector2::zeros(), Vector2::x())
}

fn place_name((road, lane, at): (&str, i32, f64)) -> String {
    format!("lane {lane} of `{road}`, {at} m along it")
}
