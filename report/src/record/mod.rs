//! Camera recordings: what the cameras on the ego vehicle see in a test, as films and as labelled data sets.
//!
//! A test is run, and a [`Film`] keeps the state of the world at each exposure of its cameras; a [`Projector`] draws
//! these moments afterwards, many at once. The driver does not see these images, so nothing is lost by drawing them
//! later, and a batch can be as large with one test as with many. Everything, including the noise of the sensors,
//! depends only on the values of the test and on the cameras' seed. So every test has its own noise and loses its own
//! images.

mod clip;
mod coco;
mod dataset;
mod film;
mod footage;
pub(crate) mod image;
mod mask;
pub(crate) mod missing;
mod projector;
#[cfg(test)]
pub mod tests;
mod video;

pub use clip::Clip;
pub use dataset::{Dataset, Kept, Recorded};
pub use film::{Film, Shot};
pub use footage::{cameras_of, mp4};
pub use paracosm_render::Rendering;
pub use projector::{Developed, Inside, Projector};
