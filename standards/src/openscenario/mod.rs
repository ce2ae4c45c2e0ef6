//! ASAM OpenSCENARIO XML 1.0 to 1.3: scenarios of files as programs.

mod action;
mod catalogs;
mod clock;
mod clothoid;
mod condition;
mod constraints;
mod demand;
mod distribution;
mod elements;
mod entity;
mod export;
mod kind;
mod linked;
mod local;
mod measure;
mod names;
mod nurbs;
mod parameters;
mod place;
mod play;
mod polyline;
mod position;
mod profile;
mod program;
mod project;
mod route;
mod rule;
mod scope;
mod state;
mod story;
mod transition;
mod variable;

pub use elements::elements;
pub use export::{EgoAs, Export};
pub use parameters::EGO;
pub use program::Xosc;
