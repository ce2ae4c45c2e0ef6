//! A simple kinematic world: points with lengths and widths on a straight road, with ten steps per second.
//!
//! The performance models of UN Regulation No. 157 (Annex 4, Appendix 3) are defined in such a world, and the results
//! in the literature were computed in one. It has no tyres, no streams and no physics. The ego vehicle keeps the middle
//! of its lane, holds its speed and brakes when its [`BrakingModel`] says so. The others follow a [`Course`] that is
//! known from the beginning. An encounter takes microseconds, so that tens of thousands can be checked: could a careful
//! driver have avoided the collision?
//!
//! [`CutIn`], [`CutOut`] and [`LeaderBrakes`] are the three kinds of encounters of the regulation.
//!
//! ```
//! use paracosm_engine::driver::reference::{Cc, Ideal};
//! use paracosm_engine::kinematic::{CutIn, Unbraked};
//!
//! // Another car, 10 m/s slower, comes over from the next lane 40 m ahead.
//! let encounter = CutIn { speed: 15.0, other_speed: 5.0, gap: 40.0, lateral_speed: 1.5 }.encounter();
//! assert!(encounter.run(&Unbraked).collision.is_some());
//! assert!(encounter.run(&Cc::default()).collision.is_none());
//! assert!(Ideal::default().best(&encounter).1.collision.is_none());
//! ```

mod course;
mod encounter;
mod regulation;
mod situation;

pub use course::{Course, Size};
pub use encounter::{Collision, Encounter, Ended, Impact};
pub use regulation::{CutIn, CutOut, LANE_WIDTH, LeaderBrakes};
pub use situation::Situation;

/// The duration of a time step in seconds. The models of UN R157 run at 10 Hz.
pub const DT: f64 = 0.1;

/// A model of a driver who brakes because of another road user. It may have memory, for example the duration of a risk;
/// each encounter uses a fresh copy for each of the other road users.
pub trait BrakingModel: Clone + Send {
    /// Returns the deceleration for the next `dt` seconds in m/s², not below 0; 0 if the model sees no reason to brake.
    fn brake(&mut self, situation: &Situation, dt: f64) -> f64;
}

/// A model of a driver who never brakes. It shows the result without a reaction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Unbraked;

impl BrakingModel for Unbraked {
    fn brake(&mut self, _: &Situation, _: f64) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests;
