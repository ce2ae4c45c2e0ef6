//! Things that stand beside the road or on it and never move.

use crate::object::{Body, Class, Geometric};
use crate::scenario::{Place, Scenario};
use paracosm_road::Pose;

/// An object that stands still, such as a house, a tree, a sign, or a parked car. It is not placed yet.
#[derive(Debug, Clone)]
pub struct Fixture {
    name: String,
    body: Body,
    at: Pose,
    is_scenery: bool,
    is_joined: bool,
}

struct Still {
    at: Pose,
    is_joined: bool,
}

impl Fixture {
    /// Makes an object with a given body that stands at the pose `at`. Messages call it `name`.
    pub fn new(name: &str, body: Body, at: Pose) -> Self {
        Self { name: name.to_owned(), body, at, is_scenery: false, is_joined: false }
    }

    /// Lets the object overlap other objects of which this is said, as the walls of a house do.
    pub fn joined(self) -> Self {
        Self { is_joined: true, ..self }
    }

    /// Makes the object scenery: it exists for sensors, and for a car that runs into it. Drivers, traffic, clearances and
    /// other signals take no account of it.
    pub fn as_scenery(self) -> Self {
        Self { is_scenery: true, ..self }
    }

    /// Makes a house of two storeys, 10 m by 8 m, that faces in the direction of the pose.
    pub fn house(at: Pose) -> Self {
        Self::new("house", Body::block(Class::Building, 10.0, 8.0, 7.0), at)
    }

    /// Makes a tree that stands at a pose. Only its trunk is in the way.
    pub fn tree(at: Pose) -> Self {
        Self::new("tree", Body::disc(Class::Tree, 0.3, 6.0), at)
    }

    /// Makes a traffic sign on a post that stands at a pose.
    pub fn sign(at: Pose) -> Self {
        Self::new("sign", Body::disc(Class::Sign, 0.05, 2.5), at)
    }

    /// Makes a parked car without a driver that stands at a pose.
    pub fn parked_car(at: Pose) -> Self {
        Self::new("parked-car", Body::car(), at)
    }
}

impl Place for Fixture {
    /// The handle is empty, because a fixture has no outputs.
    type Handle = ();

    fn place(self, scenario: &mut Scenario) {
        let mut draft = scenario.object(&self.name);
        draft.body(self.body, self.at);
        draft.geometric(Still { at: self.at, is_joined: self.is_joined });
        if self.is_scenery {
            scenario.scenery.extend(scenario.objects.pop());
        }
    }
}

impl Geometric for Still {
    fn poses(&self, poses: &mut [Option<Pose>]) {
        poses[0] = Some(self.at);
    }

    fn is_joined(&self) -> bool {
        self.is_joined
    }
}
