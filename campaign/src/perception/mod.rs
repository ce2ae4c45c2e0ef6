//! Perception networks on trial: a simulated test is filmed, the perceiver answers its images, and the comparison with
//! the ground truth becomes signals of the trace.
//!
//! The perceiver does not drive, so its answers change nothing in the run. An image counts for all ticks until the next
//! image.

#[cfg(feature = "camera")]
mod exam;
#[cfg(feature = "camera")]
mod film;
#[cfg(feature = "camera")]
mod grades;
#[cfg(feature = "camera")]
mod marks;
#[cfg(all(test, feature = "camera"))]
mod tests;
#[cfg(feature = "camera")]
mod truth;

#[cfg(feature = "camera")]
pub(crate) use exam::Exam;
#[cfg(feature = "camera")]
pub(crate) use film::{Film, Notes, Taken};
#[cfg(feature = "camera")]
pub use truth::RoadUser;
#[cfg(feature = "camera")]
pub(crate) use truth::{mask, road_users};
