//! The objects that come with the engine, the car under test apart: people on foot, whatever moves along a path, and
//! what stands beside the road.

mod fixture;
mod fleet;
mod mover;
mod pedestrian;
mod roadside;

pub use fixture::Fixture;
pub use fleet::{EnvironmentCars, Fleet};
pub use mover::{Actor, Mover};
pub use pedestrian::{Pedestrian, Walk, Walker};
pub use roadside::Roadside;
