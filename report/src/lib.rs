//! Knowledge to something to look at.

pub mod bench;
pub mod blame;
pub mod compare;
pub mod junit;
pub mod plot;
#[cfg(feature = "camera")]
pub mod record;
pub mod traceability;
mod trials;
pub mod write_up;

pub use blame::BlameTable;
pub use junit::{Junit, shell_word};
pub use plot::{Axis, FailureMap, HeatMap, Lines, Mark, Picture, Tints, drawing_png, film_gif};
pub use trials::TrialTable;
