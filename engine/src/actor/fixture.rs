//! What stands beside the road or on it and never moves.

use crate::geometry::Pose;
use crate::object::{Body, Class, Geometric};
use crate::scenario::{Place, Scenario};

/// A thing that stands still, not placed yet: a house, a tree, a sign, a parked car.
#[derive(Debug, Clone)]
pub struct Fixture {
    name: String,
    body: Body,
    at: Pose,
}

struct Still(Pose);

impl Fixture {
    /// A body that stands at `at`; `name` is what it is called when something is wrong with it.
    pub fn new(name: &str, body: Body, at: Pose) -> Self {
        Self { name: name.to_owned(), body, at }
    }

    /// A house of two storeys, 10 m by 8 m, that faces along the pose.
    pub fn house(at: Pose) -> Self {
        Self::new("house", Body::block(Class::Building, 10.0, 8.0, 7.0), at)
    }

    /// A tree, of which the trunk is in the way.
    pub fn tree(at: Pose) -> Self {
        Self::new("tree", Body::disc(Class::Tree, 0.3, 6.0), at)
    }

    /// A traffic sign on its post.
    pub fn sign(at: Pose) -> Self {
        Self::new("sign", Body::disc(Class::Sign, 0.05, 2.5), at)
    }

    /// A car that nobody drives.
    pub fn parked_car(at: Pose) -> Self {
        Self::new("parked-car", Body::car(), at)
    }
}

impl Place for Fixture {
    /// Nothing: there is nothing to read of it.
    type Handle = ();

    fn place(self, scenario: &mut Scenario) {
        let mut draft = scenario.object(&self.name);
        draft.body(self.body, self.at);
        draft.geometric(Still(self.at));
    }
}

impl Geometric for Still {
    fn poses(&self, poses: &mut [Option<Pose>]) {
        poses[0] = Some(self.0);
    }
}
