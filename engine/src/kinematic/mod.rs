//! The plain kinematic world: points with lengths and widths on a straight road, ten times a second.
//!
//! The performance models of UN Regulation No. 157 (Annex 4, Appendix 3) are defined in such a world, and what the
//! literature says of them was computed in one. It knows no tyres, no streams and no physics: the car under test keeps the
//! middle of its lane, holds its speed and brakes when its [`BrakingModel`] says so; the others follow a [`Course`] that
//! is known from the beginning. One encounter takes microseconds, so that tens of thousands can be asked which of them
//! a careful driver could have got out of.
//!
//! [`CutIn`], [`CutOut`] and [`LeaderBrakes`] are the three kinds of encounters of the regulation.
//!
//! ```
//! use paracosm_engine::driver::reference::{Cc, Ideal};
//! use paracosm_engine::kinematic::{CutIn, Unbraked};
//!
//! // Another car, 10 m/s slower, comes over from the next lane 25 m ahead.
//! let encounter = CutIn { speed: 15.0, other_speed: 5.0, gap: 25.0, lateral_speed: 1.0 }.encounter();
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

/// The time step in seconds: the models of UN R157 run at 10 Hz.
pub const DT: f64 = 0.1;

/// How a driver decides to brake for one other road user. It remembers what it has to, how long a risk has lasted for
/// instance; a fresh copy drives each encounter with each other road user.
pub trait BrakingModel: Clone + Send {
    /// The deceleration in m/s², not below 0, that it wants for the next `dt` seconds; 0 where it sees no reason to brake.
    fn brake(&mut self, situation: &Situation, dt: f64) -> f64;
}

/// Never brakes: what happens if the driver does nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Unbraked;

impl BrakingModel for Unbraked {
    fn brake(&mut self, _: &Situation, _: f64) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests;
