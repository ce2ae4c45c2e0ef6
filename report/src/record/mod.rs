//! Camera recordings: what cameras on the car under test see of a test, as films and as labelled data sets.
//!
//! A test is run, and a [`Film`] keeps the moments at which its cameras open their shutters; a [`Projector`] draws them
//! afterwards, many at once. The driver sees nothing of the pictures, so that nothing is lost by drawing them later, and a
//! batch is as large with one test as with many. Everything, the noise of sensors too, depends on the test alone: on its
//! values and the cameras' seed, so that every test has noise of its own and loses images of its own.

mod camera_file;
mod cameras;
mod clip;
mod coco;
mod dataset;
mod film;
mod image;
mod missing;
mod part;
mod projector;
#[cfg(test)]
pub mod tests;
mod varied;
mod video;

pub use cameras::{cameras_for_people, read_cameras, standard_cameras, standard_cameras_file};
pub use clip::Clip;
pub use dataset::{Dataset, Kept, Recorded};
pub use film::{Film, Shot, check_rates};
pub use paracosm_render::Rendering;
pub use projector::{Developed, Inside, Projector};
pub use varied::VariedCameras;
