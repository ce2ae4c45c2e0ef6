//! Pictures of worlds and of runs, from above.
//!
//! There are pictures of a road network ([`RoadPicture`]), of a world at the start of a run with the planned ways
//! ([`world`]), and of a recorded run ([`MotionRecord`]): in one picture ([`MotionRecord::story`]) or moment by moment
//! ([`MotionRecord::film`]). A picture is a [`Drawing`]: a list of marks that this module writes as SVG and that others
//! can rasterise.
//!
//! A picture shows the ground around the actors and their ways rather than all of a long road. So a car is more than a
//! dot wherever possible.

mod animation;
mod body;
mod drawing;
pub(crate) mod ground;
mod labels;
mod legend;
mod pages;
mod record;
mod road;
mod story;
mod svg;
mod view;
mod world;

pub use animation::{Animation, Frame};
pub use drawing::{Anchor, Colour, Contour, Drawing, Paint, PathSegment, PictureItem, Pixel};
pub use record::MotionRecord;
pub use road::RoadPicture;
pub use world::world;
