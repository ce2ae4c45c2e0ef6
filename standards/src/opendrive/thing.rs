//! The objects and signals of a map as bodies of a world.
//!
//! Objects on a lane are in the way of everybody. All others are scenery: sensors see them, and a car can run into them.

use super::map::Map;
use paracosm_engine::object::Body;
use paracosm_engine::road::RoadNetwork;
use paracosm_engine::{Fixture, Place, Pose, Scenario};
use std::sync::Arc;

/// The distance in metres between two points of a body that are compared with the lanes, and the metres by which a body may reach
/// over the edge of a lane.
const STEP: f64 = 1.0;
const EDGE: f64 = 0.3;

/// The body of an object or a signal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Thing {
    pub body: Body,
    pub at: Pose,
    /// True if the body is on a lane.
    pub is_in_the_way: bool,
}

impl Thing {
    /// Returns the bodies of all objects and signals of a map, in the order of the file.
    pub fn all(map: &Map, network: &RoadNetwork) -> Arc<[Self]> {
        let parts = map.objects().flat_map(|object| object.parts.iter().map(move |part| (object, *part)));
        let things = parts.filter_map(|(object, (body, at))| {
            let is_in_the_way = is_on_lane(network, &body, &at);
            // A signal over a lane hangs, and a car drives below it.
            (!object.is_signal || !is_in_the_way).then_some(Self { body, at, is_in_the_way })
        });
        things.collect()
    }
}

impl Place for Thing {
    type Handle = ();

    fn place(self, s: &mut Scenario) {
        let fixture = Fixture::new(&self.body.class.to_string(), self.body, self.at).joined();
        s.place(if self.is_in_the_way { fixture } else { fixture.as_scenery() });
    }
}

/// Returns `true` if a body is on a lane.
fn is_on_lane(network: &RoadNetwork, body: &Body, at: &Pose) -> bool {
    let half = body.outline.half_extent();
    let (ahead, aside) = if half.x >= half.y { (at.forward(), half.y) } else { (at.left(), half.x) };
    let along = half.max() - aside;
    let steps = (2.0 * along / STEP).ceil();
    (0..=steps as usize).any(|i| {
        let share = if steps > 0.0 { 2.0 * i as f64 / steps - 1.0 } else { 0.0 };
        let place = network.project(at.position + ahead * (along * share));
        place.distance < 0.5 * network.lane(place.lane).width_at(place.s) + aside - EDGE
    })
}
