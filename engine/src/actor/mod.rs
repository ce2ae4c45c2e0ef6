//! The objects that come with the engine: the car under test, people on foot, whatever moves along a path, and what
//! stands beside the road.

mod ego;
mod fixture;
mod fleet;
mod mover;
mod pedestrian;
mod quantity;
mod right_of_way;
mod roadside;

pub use ego::{AutonomousVehicle, Car};
pub use fixture::Fixture;
pub use fleet::{EnvironmentCars, Fleet};
pub use mover::{Actor, Mover};
pub use pedestrian::{Pedestrian, Walk, Walker};
pub use roadside::Roadside;

pub(crate) use ego::{Ego, EgoSetup};
