//! Worlds as programs of Python: the same objects and the same graph of streams as in Rust. A function of Python builds the world of each test
//! once, and the run needs Python no more.

mod actors;
mod building;
mod called;
mod effect;
mod ego;
mod environment;
mod extent;
mod forward;
mod handle;
mod held;
mod monitor;
mod network;
mod operand;
mod operators;
mod parameter;
mod place;
mod program;
mod recipe;
mod road;
mod scenario;
mod stream;
mod streets;
mod temporal;
mod traffic;
mod wire;

pub use actors::{Actor, Fixture, Mover, Pedestrian, Roadside, Walk, Walker};
pub use effect::Effect;
pub use ego::{AutonomousVehicle, Car};
pub use environment::{Conditions, Environment};
pub use monitor::Monitor;
pub use network::{Composite, CrossIntersection, RoadNetwork, RoadSegment, Roundabout, TIntersection, grid_city};
pub use place::{Line, Path, Pose};
pub use program::{Program, catalogue, scenarios};
pub use road::Road;
pub use scenario::Scenario;
pub use stream::Stream;
pub use streets::Streets;
pub use temporal::{Temporal, always, eventually, historically, never, once, until};
pub use traffic::{EnvironmentCars, Fleet, TrafficCar};
