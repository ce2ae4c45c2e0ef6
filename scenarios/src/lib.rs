//! The catalogue of scenario programs, by name.

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

use paracosm_engine::Program;
use paracosm_engine::object::Body;
use paracosm_engine::vehicle::Vehicle;

/// Every scenario there is.
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
    &highway_traffic::PROGRAM,
];

/// The width of a lane in metres.
const LANE: f64 = 3.5;

/// From the middle of the car under test to that of a car ahead, in metres, when their bumpers are `gap` metres apart.
fn middles(gap: f64) -> f64 {
    gap + 0.5 * Vehicle::BMW_320I.length + Body::car().outline.half_extent().x
}

/// The scenario of that name.
pub fn find(name: &str) -> Option<&'static Program> {
    ALL.iter().copied().find(|program| program.name() == name)
}
