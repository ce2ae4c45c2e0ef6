//! What an object does, whatever it is made of.

use super::body::Body;
use super::{Geometric, Physical};
use crate::geometry::Pose;
use std::fmt;

/// What an object does.
pub(crate) enum Behaviour {
    Geometric(Box<dyn Geometric>),
    /// With its mass in kg.
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

/// What a run needs of a placed object.
#[derive(Debug)]
pub(crate) struct ObjectSetup {
    pub name: String,
    pub bodies: Vec<(Body, Pose)>,
    pub behaviour: Behaviour,
}
