//! The catalogue of scenarios: programs that build a world from a test, found by name.
//!
//! ```
//! let cut_in = paracosm_scenarios::find("cut-in").expect("the catalogue has it");
//! let declaration = cut_in.declare()?;
//! let names: Vec<_> = declaration.parameters.iter().map(|declared| declared.parameter.name.as_str()).collect();
//! assert!(names.contains(&"gap"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cut_in;
mod cut_out;
mod follow_leader;
mod grid_traffic;
mod highway_traffic;
mod ncap;
mod oncoming_distractor;
mod pedestrian_crossing;
mod roundabout_entry;
mod surroundings;
mod t_loop;

use paracosm_engine::object::{Body, VehicleKind};
use paracosm_engine::vehicle::Vehicle;
use paracosm_engine::{Program, Scenario};

/// All scenarios that this crate provides.
pub const ALL: &[&Program] = &[
    &pedestrian_crossing::PROGRAM,
    &follow_leader::PROGRAM,
    &oncoming_distractor::PROGRAM,
    &t_loop::PROGRAM,
    &grid_traffic::PROGRAM,
    &roundabout_entry::PROGRAM,
    &cut_in::PROGRAM,
    &cut_out::PROGRAM,
    &ncap::CPNA,
    &ncap::CPFA,
    &ncap::CPNCO,
    &ncap::CCR,
    &ncap::CCRB,
    &highway_traffic::PROGRAM,
];

/// The width of a lane in metres.
const LANE: f64 = 3.5;

/// Returns the distance in metres from the middle of the ego vehicle to the middle of a car ahead, whose bumpers are
/// `gap` metres apart.
fn middles(gap: f64) -> f64 {
    middles_to(&Body::car(), gap)
}

/// Returns the distance in metres from the middle of the ego vehicle to the middle of a body ahead, if `gap` metres lie
/// between the front of the ego vehicle and the body.
fn middles_to(body: &Body, gap: f64) -> f64 {
    gap + 0.5 * Vehicle::BMW_320I.length + body.outline.half_extent().x
}

/// Returns the kind of vehicle that the level of a parameter names.
///
/// # Panics
/// There is no such kind: the level of the scenario has a mistake in its name.
fn kind(name: &str) -> &'static VehicleKind {
    VehicleKind::ALL.iter().find(|kind| kind.name == name).expect("the level names a kind of vehicle")
}

/// Refuses a test in which a vehicle would move to the side faster than it drives, as the regulation's scenarios do. Both
/// speeds are in m/s.
fn checked_lateral(s: &mut Scenario, lateral: f64, speed: f64) {
    if lateral >= speed {
        s.refuse("the vehicle that changes lanes would move to the side faster than it drives");
    }
}

/// Returns the scenario with the given name; `None` if the catalogue has no such scenario.
pub fn find(name: &str) -> Option<&'static Program> {
    ALL.iter().copied().find(|program| program.name() == name)
}
