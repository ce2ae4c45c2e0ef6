//! The objects that come with the engine, except the ego vehicle: people on foot, objects that move along a path, and
//! things that stand beside the road.

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
