//! The entities of a scenario on their map, with the variables and the time: everything that actions change and conditions read.

use super::actor::Actor;
use crate::opendrive::Map;
use crate::openscenario::environment::Surroundings;
use crate::openscenario::variable::Variable;
use paracosm_engine::Lead;
use std::sync::Arc;

/// The entities of a scenario.
pub(in crate::openscenario) struct Cast {
    pub(super) map: Arc<Map>,
    pub actors: Vec<Actor>,
    pub(super) variables: Vec<Variable>,
    /// The index of the entity that the system under test drives.
    pub(super) ego: usize,
    pub lead: Lead,
    /// `true` where the controller of the ego vehicle is active: to the side, and along the way.
    pub(super) controlled: [bool; 2],
    /// The time of day and the weather.
    pub surroundings: Surroundings,
    /// The seconds since the run began.
    pub time: f64,
}
