//! Worlds as programs, and one simulated run of such a world.
//!
//! A [`Program`] is a function that builds a world in a [`Scenario`]: it declares parameters, places a road, a
//! car and pedestrians, binds their inputs to [`stream`]s and states requirements. Run with no test it yields
//! its parameters ([`Program::declare`]); run with one it yields a [`Run`], a state machine that alternates
//! with the system under test, a [`driver::Driver`], until it is done and leaves an [`Outcome`].
//!
//! ```
//! use paracosm_engine::{AutonomousVehicle, Program, RoadSegment, Scenario};
//! use paracosm_engine::{driver, eventually, simulate, vehicle::Model};
//!
//! fn empty_road(s: &mut Scenario) {
//!     let speed = s.interval("speed", 5.0..=20.0).unit("m/s");
//!     let road = s.place(RoadSegment::new(300.0));
//!     let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(speed.value()));
//!     s.duration(10.0);
//!     s.require("progress", eventually(car.travelled().at_least(40.0))).unit("m").scale(10.0);
//! }
//!
//! let program = Program { name: "empty-road", about: "a car alone", build: empty_road };
//! let test = program.declare()?.nominal();
//! let mut driver = driver::find("cruise")?.build(&[])?;
//! let outcome = simulate(&program, &test, Model::SingleTrack, driver.as_mut());
//! assert_eq!(outcome.verdict, paracosm_oracles::Verdict::Pass);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Coordinates: x along the road, y to its left, z up, in metres; headings counter-clockwise from x in radians;
//! speeds in m/s, times in s.

mod actor;
pub mod driver;
pub mod kinematic;
mod monitor;
pub mod object;
mod observation;
mod outcome;
pub mod picture;
mod program;
pub mod road;
mod run;
mod scenario;
pub mod sensor;
pub mod stream;
pub mod traffic;
pub mod vehicle;
mod world;

pub use actor::{
    Actor, AutonomousVehicle, Car, EnvironmentCars, Fixture, Fleet, Mover, Pedestrian, Roadside, Walk, Walker,
};
pub use monitor::Monitor;
pub use observation::{Ahead, Briefing, Control, Observation, Other, Way};
pub use outcome::{Metric, Outcome, violation_metrics};
pub use paracosm_coverage::Shape;
pub use program::{Declaration, Declared, Program, ProgramError, Test};
pub use road::RoadSegment;
pub use run::{DEFAULT_DT, Run, Setup, Step, simulate, watch};
pub use scenario::{
    Conditions, Draft, Environment, Line, Param, Paved, Place, Pose, Road, Scenario, Side, Streets, Temporal, Weather,
    always, eventually, never,
};
pub use stream::{Forward, Stream};
