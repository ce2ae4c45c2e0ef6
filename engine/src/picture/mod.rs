//! Pictures of worlds and of runs, from above.
//!
//! Three things can be drawn: a road network ([`RoadPicture`]), a world as it begins, with the ways that are planned in
//! it ([`world`]), and what was seen of a run ([`Record`]), all at once ([`Record::story`]) or moment by moment
//! ([`Record::film`]). What is drawn is a [`Drawing`], a list of marks that is written as SVG here, and rasterised by
//! whoever wants pixels.
//!
//! A picture shows the ground where the actors are and go rather than all of a long road, so that a car is never a mere
//! dot as long as that can be avoided.

mod body;
mod drawing;
mod film;
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

pub use drawing::{Anchor, Colour, Contour, Drawing, Mark, Paint, Pixel, Segment};
pub use film::{Film, Frame};
pub use record::Record;
pub use road::RoadPicture;
pub use world::world;
