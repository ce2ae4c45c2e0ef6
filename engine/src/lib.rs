//! Worlds as programs, and simulated runs of such worlds.
//!
//! A [`Program`] is a function that builds a world in a [`Scenario`]. It declares parameters, places a road, a car and
//! pedestrians, binds their inputs to [`stream`]s and states requirements. Without a test the program yields its
//! parameters ([`Program::declare`]). With a test it yields a [`Run`]: a state machine that alternates with the system
//! under test, a [`driver::Driver`], until it is over and leaves an [`Outcome`].
//!
//! ```
//! use paracosm_engine::{AutonomousVehicle, Program, RoadSegment, Scenario};
//! use paracosm_engine::{driver, eventually, simulate, vehicle::VehicleModel};
//!
//! fn empty_road(s: &mut Scenario) {
//!     let speed = s.interval("speed", 5.0..=20.0).unit("m/s");
//!     let road = s.place(RoadSegment::new(300.0));
//!     let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(speed.value()));
//!     s.duration(10.0);
//!     s.require("progress", eventually(car.travelled().at_least(40.0))).unit("m").scale(10.0);
//! }
//!
//! let program = Program::new("empty-road", "a car alone", empty_road);
//! let test = program.declare()?.nominal();
//! let mut driver = driver::find("cruise")?.build(&[])?;
//! let outcome = simulate(&program, &test, VehicleModel::SingleTrack, driver.as_mut());
//! assert_eq!(outcome.verdict(), paracosm_oracles::Verdict::Pass);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Coordinates: x along the road, y to its left, z up, in metres; headings counter-clockwise from x in radians;
//! speeds in m/s, times in s.

mod actor;
mod chance;
mod contact;
pub mod driver;
mod flaw;
pub mod kinematic;
mod line;
mod monitor;
pub mod object;
mod observation;
mod outcome;
mod program;
mod run;
mod scenario;
pub mod sensor;
pub mod signal;
pub mod stream;
mod test;
pub mod traffic;
mod upset;
pub mod vehicle;
mod weather;
mod world;

pub use actor::{Actor, EnvironmentCars, Fixture, Fleet, Mover, Pedestrian, Roadside, Walk, Walker};
pub use contact::{Contact, ContactMotion, Face};
pub use flaw::{ObjectFlaw, WorldFlaw};
pub use line::Line;
pub use monitor::Monitor;
pub use observation::{Ahead, Briefing, Control, Navigation, Observation, Other, Way};
pub use outcome::{Breakdown, Ending, Invalid, Judgement, Measurements, Outcome, Violation};
pub use paracosm_road::{self as road, Pose, RoadSegment, Side};
pub use paracosm_space::Shape;
pub use program::{Declaration, FilesRead, Program, ProgramError, panic_message};
pub use run::{Motion, Run, Setup, Step, Track, simulate, watch};
pub use scenario::{
    AutonomousVehicle, Car, Conditions, Constraint, DEFAULT_DT, Environment, Lead, LedMotion, ObjectDraft, Param,
    Place, Reach, RequirementDraft, Road, Scenario, Streets, Temporal, always, eventually, never,
};
pub use stream::{Forward, Stream};
pub use test::{Declared, Test};
pub use upset::Upset;
pub use weather::Weather;
