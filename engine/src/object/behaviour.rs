//! The behaviours of objects, independent of their kind.

use super::body::Body;
use super::{Geometric, Physical};
use paracosm_road::Pose;
use std::fmt;

/// The behaviour of an object.
pub(crate) enum Behaviour {
    Geometric(Box<dyn Geometric>),
    /// An object that the physics moves, with its mass in kg.
    Physical(f64, Box<dyn Physical>),
}

impl fmt::Debug for Behaviour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Behaviour::Geometric(_) => f.write_str("geometric"),
            Behaviour::Physical(mass, _) => write!(f, "physical, {mass} kg"),
        }
    }
}

/// The data of a placed object that a run needs.
#[derive(Debug)]
pub(crate) struct ObjectSetup {
    pub name: String,
    pub bodies: Vec<(Body, Pose)>,
    pub behaviour: Behaviour,
}
