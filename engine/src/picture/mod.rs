//! Pictures of worlds and of runs, from above.
//!
//! Three things can be drawn: a road network ([`RoadPicture`]), a world as it begins, with the ways that are planned in
//! it ([`world`]), and what was seen of a run ([`MotionRecord`]), all at once ([`MotionRecord::story`]) or moment by moment
//! ([`MotionRecord::film`]). What is drawn is a [`Drawing`], a list of marks that is written as SVG here, and rasterised by
//! whoever wants pixels.
//!
//! A picture shows the ground where the actors are and go rather than all of a long road, so that a car is never a mere
//! dot as long as that can be avoided.

mod animation;
mod body;
mod drawing;
mod ground;
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
