//! ASAM OpenSCENARIO XML 1.0 to 1.3: scenarios of files as programs.

mod action;
mod catalogs;
mod condition;
mod distribution;
mod elements;
mod entity;
mod export;
mod parameters;
mod place;
mod play;
mod polyline;
mod position;
mod program;
mod project;
mod scope;
mod state;
mod story;
mod transition;
mod variable;
mod way;

pub use elements::elements;
pub use export::{EgoAs, Export};
pub use program::{EGO, Xosc};
