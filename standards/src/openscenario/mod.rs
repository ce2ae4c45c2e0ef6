//! ASAM OpenSCENARIO XML 1.0 to 1.3: scenarios of files as programs.

mod action;
mod catalogs;
mod condition;
mod elements;
mod entity;
mod parameters;
mod place;
mod play;
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
pub use program::Xosc;
